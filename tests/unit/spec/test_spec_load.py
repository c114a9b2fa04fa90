import copy
import json
import subprocess
import sys
from math import atan

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shotc.diag.codes import schema, units
from shotc.diag.registry import registry
from shotc.source.limits import MAX_FAULTS
from shotc.source.yaml_tree import parse
from shotc.spec.heights import STANDING
from shotc.spec.load import load

CODES = (*schema.CODES, *units.CODES)
CODE_OF = {info.slug: info.code for info in CODES}
BASE = schema.CODES[0].passing
JUNK = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=12),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)
SLOW = settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def paths(tree, at=()):
    """Every path of a tree, the root first."""
    yield at
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in inner:
        yield from paths(value, (*at, key))


def changed(tree, path, value):
    """A copy of the tree with another value at the path."""
    if not path:
        return value
    result = copy.deepcopy(tree)
    parent = result
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return result


def tree_of(text):
    return parse(text.encode(), "m.yaml").root


def place(diagnostic):
    span = diagnostic.labels[0].span
    return (span.line, span.column, span.end_column)


@pytest.mark.parametrize("info", CODES, ids=lambda info: info.slug)
def test_examples_of_codes_fail_and_pass(info, loads):
    assert [d.code for d in loads(info.failing).diagnostics] == [info.code]
    assert loads(info.failing).mission is None
    assert loads(info.passing).diagnostics == ()
    assert loads(info.passing).mission is not None


def test_slugs_are_distinct_and_explained():
    assert len(CODE_OF) == len(CODES)
    for info in CODES:
        assert len(info.explanation) > 80
        assert info.failing != info.passing


# What is written instead of a part of BASE, and the exact line, first and end column to be underlined.
PLACES = [
    ("missing-version", "shotc: 1\n", "", (1, 1, 1)),
    ("unknown-version", "shotc: 1", "shotc: 2", (1, 8, 9)),
    ("unknown-version", "shotc: 1", "shotc: true", (1, 8, 12)),
    ("unknown-version", "shotc: 1", 'shotc: "1"', (1, 8, 11)),
    ("unknown-field", "home:", "hom:", (10, 23, 26)),
    ("unknown-field", "rules:", "rulez:", (11, 1, 6)),
    ("missing-field", "radius: 4, ", "", (8, 3, 8)),
    ("missing-field", "mission: look\n", "", (1, 1, 1)),
    ("missing-field", "at: [0, 0, 12], ", "", (8, 3, 8)),
    ("conflicting-fields", "radius: 4", "radius: 4, track: {file: a.csv}", (8, 38, 43)),
    ("empty-value", "home: [0, -60, 0]", "home: ~", (10, 23, 27)),
    ("empty-value", "{composition: thirds, pace: calm}", "", (11, 1, 6)),
    ("wrong-type", "home: [0, -60, 0]", "home: 3", (10, 29, 30)),
    ("wrong-type", "look_at: tower", "look_at: true", (13, 85, 89)),
    ("wrong-length", "[0, -60, 0]", "[0]", (10, 29, 32)),
    ("unknown-value", "keep: out", "keep: outside", (6, 18, 25)),
    ("unknown-value", "pace: calm", "pace: lazy", (11, 36, 40)),
    ("unknown-value", "composition: thirds", "composition: third", (11, 22, 27)),
    ("unknown-kind", "kind: static", "kind: orbits", (13, 22, 28)),
    ("unsafe-name", "mission: look", "mission: ../look", (2, 10, 17)),
    ("unsafe-name", "  tower:", "  -tower:", (8, 3, 9)),
    ("unsafe-path", "wind: 3 m/s", "terrain: {file: /etc/passwd}", (4, 19, 30)),
    ("inverted-range", "height: [0, 12]", "height: [12, 0]", (6, 72, 79)),
    ("inverted-range", "height: [0, 12]", "height: [12, 12]", (6, 72, 80)),
    ("out-of-range", "radius: 4", "radius: 0", (8, 35, 36)),
    ("out-of-range", "pace: calm", "pace: 1.5", (11, 36, 39)),
    ("impossible-camera", "70 deg", "180 deg", (10, 57, 64)),
    ("impossible-camera", "hfov: 70 deg", "sensor: 13.2, focal_length: 8.8 mm", (10, 79, 85)),
    ("impossible-camera", '"16:9"', '"16:0"', (10, 73, 79)),
    ("no-shots", BASE[BASE.index("shots:") :], "", (1, 1, 1)),
    ("no-shots", BASE[BASE.index("shots:") :], "shots: []", (12, 1, 6)),
    ("not-a-mission", BASE, '{"format": "shotc-plan"}', (1, 1, 1)),
    ("unknown-unit", "3 m/s", "3 m/sec", (4, 9, 16)),
    ("wrong-dimension", "3 m/s", "3 s", (4, 9, 12)),
    ("wrong-dimension", "[0, -60, 0]", "[0, -60 s, 0]", (10, 33, 38)),
    ("bare-angle", "70 deg", "70", (10, 57, 59)),
    ("missing-unit", "3 m/s", '"3"', (4, 9, 12)),
    ("not-a-quantity", "3 m/s", "brisk", (4, 9, 14)),
    ("not-a-quantity", "radius: 4", "radius: {m: 4}", (8, 35, 41)),
    ("absurd-value", "3 m/s", ".nan", (4, 9, 13)),
    ("absurd-value", "3 m/s", "1e300", (4, 9, 14)),
    ("absurd-value", "[0, -60, 0]", "[0, -.inf, 0]", (10, 33, 38)),
]


@pytest.mark.parametrize(("slug", "right", "wrong", "where"), PLACES)
def test_faults_are_underlined_exactly(slug, right, wrong, where, loads):
    assert right in BASE
    found = loads(BASE.replace(right, wrong, 1)).diagnostics
    assert [(d.code, place(d)) for d in found] == [(CODE_OF[slug], where)]


def test_every_code_has_a_place_test():
    assert {slug for slug, *_ in PLACES} == set(CODE_OF)


def test_one_run_reports_every_fault(loads):
    text = """\
mission: a:b
world:
  wind: 3 s
  zones:
    tree: {keep: outt, cylinder: {center: [0], radius: 3, height: [12, 0]}}
    none: {keep: in}
targets:
  tower: {at: [0, 0, 12], track: {file: a.csv}, radius: -4}
drones:
  cam1: {model: x5000, camera: {hfov: 70}}
shots:
  - {id: a, kind: orbit, drone: cam1, target: tower, radius: 3, altitud: 5}
  - {id: b, kind: whirl, drone: cam1, pace: 3}
  - 7
  - {id: c, kind: keyframes, drone: cam1, keyframes: [{at: [0, 0], look_at: 3}, {heading: 1 deg}]}
"""
    expected = [
        (1, "missing-version"),
        (1, "unsafe-name"),
        (3, "wrong-dimension"),
        (5, "unknown-value"),
        (5, "wrong-length"),
        (5, "inverted-range"),
        (6, "missing-field"),
        (8, "missing-field"),
        (8, "conflicting-fields"),
        (8, "out-of-range"),
        (10, "unknown-value"),
        (10, "bare-angle"),
        (12, "unknown-field"),
        (13, "unknown-kind"),
        (13, "out-of-range"),
        (14, "wrong-type"),
        (15, "wrong-length"),
        (15, "wrong-type"),
        (15, "missing-field"),
        (15, "missing-field"),
    ]
    found = loads(text).diagnostics
    assert [(d.labels[0].span.line, registry()[d.code].slug) for d in found] == expected


def test_a_misspelt_key_is_one_fault_not_two(loads):
    found = loads(BASE.replace("radius: 4", "radios: 4")).diagnostics
    assert [(d.code, d.help) for d in found] == [(CODE_OF["unknown-field"], "did you mean `radius`?")]


def test_a_key_one_level_too_high_is_told_where_it_belongs(loads):
    found = loads(BASE.replace("home:", "hfov: 60 deg, home:")).diagnostics
    assert [(d.code, d.help) for d in found] == [(CODE_OF["unknown-field"], "`hfov` belongs under `camera`")]


def test_a_key_of_what_has_names_belongs_under_a_name(loads):
    found = loads(f"endurance: 10 min\n{BASE}").diagnostics
    help_ = "`endurance` belongs under a name in `drones`"
    assert [(d.code, d.help) for d in found] == [(CODE_OF["unknown-field"], help_)]


def test_conflicting_keys_are_both_shown(loads):
    (found,) = loads(BASE.replace("radius: 4", "radius: 4, track: {file: a.csv}")).diagnostics
    assert [label.span.column for label in found.labels] == [38, 11]
    assert found.help == "give `at` or `track` or `parts` or `building`"


def test_another_version_silences_everything_else(loads):
    found = loads(BASE.replace("shotc: 1", "shotc: 2").replace("home", "hom")).diagnostics
    assert [d.code for d in found] == [CODE_OF["unknown-version"]]


def test_faults_of_the_text_silence_the_rest(loads):
    result = loads(BASE.replace("home", "hom") + "\nshots: []\n")
    assert result.mission is None
    assert {d.code[0] for d in result.diagnostics} == {"Y"}


def test_missions_have_a_cap_on_reports(loads):
    shots = "\n".join(f"  - {{id: s{i}, kind: nothing-like-it}}" for i in range(150))
    found = loads(BASE[: BASE.index("shots:")] + "shots:\n" + shots).diagnostics
    assert len(found) == MAX_FAULTS
    assert found[-1].notes == ("200 more faults of this file are not shown",)


def test_the_whole_language_loads(loads, whole_language):
    loaded = loads(whole_language)
    assert loaded.diagnostics == ()
    spec = loaded.mission.spec
    assert [shot.kind for shot in spec.shots][:3] == ["keyframes", "static", "orbit"]
    assert spec.drones["cam1"].limits.yaw_rate == pytest.approx(1.0471975512)
    assert spec.drones["cam2"].camera.field_of_view == pytest.approx(2 * atan(6.6 / 9), abs=1e-9)
    assert spec.drones["cam2"].camera.aspect_ratio == pytest.approx(1.5)
    assert spec.drones["cam3"].home == (0.0, 0.0, STANDING)
    assert spec.shots[0].require.in_frame == 1.0
    assert spec.shots[0].keyframes[1].frame.points == ((-1 / 3, 0.0),)
    assert loaded.mission.origins.value(("shots", 1, "pitch")).span.line == 67


def test_models_are_frozen(loads):
    spec = loads(BASE).mission.spec
    with pytest.raises(ValueError, match="frozen"):
        spec.mission = "other"


def test_the_fingerprint_is_of_the_bytes(loads):
    one, same, other = loads(BASE), loads(BASE), loads(BASE + "\n# remark\n")
    assert one.mission.sha256 == same.mission.sha256 != other.mission.sha256


@pytest.mark.long
def test_each_wrong_value_gives_one_report_in_its_place(kinds, whole_language):
    tree = tree_of(whole_language)
    checked = 0
    for path in list(paths(tree))[2::2]:
        text = json.dumps(changed(tree, path, {"odd": [{}]}))
        document = parse(text.encode(), "m")
        found = load(text.encode(), "m", None, kinds).diagnostics
        assert found, path
        # A mapping where a mapping belongs is told by its keys; anything else by one report.
        if not isinstance(value_at(tree, path), dict) and not allows_mapping(path):
            assert [place(d)[1] for d in found] == [document.values[path].column], path
        checked += 1
    assert checked > 100


def value_at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def allows_mapping(path):
    """Positions, heights and timings may be mappings, judged by their keys; so may a missing `kind`."""
    names = {"at", "home", "origin", "center", "start", "viewpoint", "look_at", "timing", "points", "kind"}
    names |= {"separation", "frames", "altitude", "height"}
    point = len(path) > 1 and path[-1] == 2  # a height in a position may say what it counts from
    return point or path[-1] in names or (len(path) > 1 and path[-2] == "points") or path[:-1] == ("shots",)


@pytest.mark.slow
@given(JUNK)
@SLOW
def test_any_tree_is_judged_without_an_exception(kinds, tree):
    result = load(json.dumps(tree).encode(), "m", None, kinds)
    assert result.mission is None
    assert result.diagnostics


@pytest.mark.slow
@given(st.data())
@SLOW
def test_a_mutated_mission_is_judged_without_an_exception(kinds, whole_language, data):
    tree = tree_of(whole_language)
    for _ in range(data.draw(st.integers(1, 4))):
        path = data.draw(st.sampled_from(list(paths(tree))[1:]))
        tree = changed(tree, path, data.draw(JUNK))
    text = json.dumps(tree)
    result = load(text.encode(), "m", None, kinds)
    assert (result.mission is None) == bool(result.diagnostics)
    assert len(result.diagnostics) <= MAX_FAULTS
    places = [(d.code, d.labels[0].span, d.message) for d in result.diagnostics]
    assert len(places) == len(set(places))
    for diagnostic in result.diagnostics:
        assert diagnostic.code in registry()
        assert 1 <= diagnostic.labels[0].span.column <= len(text) + 1
        assert "\n" not in diagnostic.message
        assert not diagnostic.message.endswith(".")


@given(st.binary(max_size=200))
@SLOW
def test_any_bytes_are_judged_without_an_exception(kinds, data):
    assert load(data, "m", None, kinds).diagnostics


@pytest.mark.slow
def test_loading_needs_no_heavy_library():
    heavy = {"numpy", "scipy", "cvxpy", "clarabel", "toppra", "rerun", "matplotlib"}
    code = (
        "import sys, shotc.spec.load, shotc.spec.schema; print(*{m.partition('.')[0] for m in sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not heavy & set(done.stdout.split())


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("x500", "x" * 1_000_000),
        ("static", "x" * 1_000_000),
        ("mission: look", "mission: " + "x" * 1_000_000),
        ("3 m/s", "3 " + "x" * 1_000_000),
        ('"16:9"', '"' + "1" * 1_000_000 + ':1"'),
        ("3 m/s", "-" + "9" * 1_000_000),
    ],
    ids=["model", "kind", "name", "unit", "aspect", "number"],
)
def test_endless_words_give_short_messages(loads, right, wrong):
    (found,) = loads(BASE.replace(right, wrong)).diagnostics
    assert len(found.message + found.help) < 400


@pytest.mark.slow
def test_thousands_of_faults_in_one_mapping_are_judged_in_linear_time(loads):
    keys = "\n".join(f"oddity{i}: 1" for i in range(4000))
    found = loads(BASE + keys + "\n").diagnostics
    assert len(found) == MAX_FAULTS
    assert found[-1].notes == ("3900 more faults of this file are not shown",)
