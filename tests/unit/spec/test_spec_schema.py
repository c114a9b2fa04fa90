import copy
import json

import pytest
from jsonschema import Draft202012Validator

from shotc.diag.codes import schema as schema_codes
from shotc.diag.codes import units as unit_codes
from shotc.source.yaml_tree import parse
from shotc.spec.load import load
from shotc.spec.schema import json_schema
from tests.support.few import few

CODES = (*schema_codes.CODES, *unit_codes.CODES)
# What shape alone does not tell: the order of a range's ends, and that there is something to film.
BEYOND_SHAPE = {"inverted-range", "no-shots"}


@pytest.fixture(scope="module")
def document(kinds):
    return json_schema(kinds)


@pytest.fixture(scope="module")
def accepts(document):
    validator = Draft202012Validator(document)
    return lambda tree: not any(validator.iter_errors(tree))


def tree_of(text):
    return parse(text.encode(), "m.yaml").root


def walk(tree, at=()):
    yield at, tree
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in inner:
        yield from walk(value, (*at, key))


def node(tree, path):
    for key in path:
        tree = tree[key]
    return tree


@pytest.mark.slow
def test_it_is_a_schema_of_the_dialect(document):
    Draft202012Validator.check_schema(document)
    assert document["$schema"].endswith("2020-12/schema")
    assert document["$id"] == "https://shotc.dev/schema/mission-1.json"
    assert json.loads(json.dumps(document)) == document


@pytest.mark.slow
def test_references_and_definitions_match(document):
    used = {
        value.removeprefix("#/$defs/") for _, value in walk(document) if str(value).startswith("#/$defs/")
    }
    assert used == set(document["$defs"])
    assert not any(key in {"$shared", "$of", "$model"} for path, _ in walk(document) for key in path)


@pytest.mark.slow
def test_every_key_is_described(document):
    for name, definition in (("mission", document), *document["$defs"].items()):
        for key, field in definition.get("properties", {}).items():
            # `kind` of a shot is described where the kinds are chosen from.
            assert field.get("description") or key in {"kind"}, (name, key)


def test_it_accepts_the_whole_language(accepts, whole_language):
    assert accepts(tree_of(whole_language))


@pytest.mark.parametrize("info", CODES, ids=lambda info: info.slug)
def test_it_judges_the_examples_of_codes_as_loading_does(info, accepts):
    assert accepts(tree_of(info.passing))
    assert accepts(tree_of(info.failing)) == (info.slug in BEYOND_SHAPE)


def pieces(tree):
    """The whole language in small missions: one entry of a section, or one shot, at a time."""
    base = {"shotc": 1, "mission": "piece", "shots": [tree["shots"][1]]}
    for shot in tree["shots"]:
        yield {**base, "shots": [shot]}
    for section in ("rules", "output"):
        yield {**base, section: tree[section]}
    for key, value in tree["world"].items():
        yield {**base, "world": {key: value}}
    for section in ("targets", "drones", "fleets"):
        for name, value in tree[section].items():
            yield {**base, section: {name: value}}


def places(piece):
    """The paths of a piece that are not of its frame, with their values."""
    fixed = [("shotc",), ("mission",), ("shots",)]
    own = [at for at, _ in walk(piece) if at and at not in fixed]
    shots_only = len(piece) == 3
    return [(at, node(piece, at)) for at in own if shots_only or at[0] != "shots"]


def verdicts(tree, accepts, kinds):
    return accepts(tree), load(json.dumps(tree).encode(), "m", None, kinds).mission is not None


@pytest.mark.slow
def test_leaving_out_any_key_is_judged_alike(accepts, kinds, whole_language):
    seen = set()
    for piece in pieces(tree_of(whole_language)):
        for path, _ in places(piece):
            if isinstance(path[-1], int):
                continue
            mutant = copy.deepcopy(piece)
            del node(mutant, path[:-1])[path[-1]]
            by_schema, by_load = verdicts(mutant, accepts, kinds)
            assert by_schema == by_load, path
            seen.add(by_load)
    assert seen == {True, False}


@pytest.mark.slow
def test_adding_a_key_anywhere_is_refused_by_both(accepts, kinds, whole_language):
    named = {"zones", "targets", "drones", "fleets"}
    for piece in pieces(tree_of(whole_language)):
        for path, value in places(piece):
            if isinstance(value, dict) and path[-1] not in named:
                mutant = copy.deepcopy(piece)
                node(mutant, path)["oddity"] = 1
                assert verdicts(mutant, accepts, kinds) == (False, False), path


JUNK = [None, True, [], {}, "7 parsecs", -7, 1e300, [[0]]]


@pytest.mark.long
@pytest.mark.parametrize("junk", few(JUNK, [None, {}, "7 parsecs", -7]), ids=repr)
def test_any_value_replaced_by_junk_is_judged_alike(junk, accepts, kinds, whole_language):
    for piece in pieces(tree_of(whole_language)):
        for path, _ in places(piece):
            mutant = copy.deepcopy(piece)
            node(mutant, path[:-1])[path[-1]] = junk
            by_schema, by_load = verdicts(mutant, accepts, kinds)
            # The ends of a range may turn out in the wrong order, which is beyond shape.
            assert by_schema == by_load or (by_schema and path[-2] in {"height", "size"}), path
