"""The mutants: which changes are made, that each is a program, and whose tests they meet."""

from __future__ import annotations

import ast
import json
import shutil
import subprocess
from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest

from tests.experiments.mutants.__main__ import ROOT, draw, every, report
from tests.experiments.mutants.changes import mutants
from tests.experiments.mutants.coverage_map import CoverageMap, recorded
from tests.experiments.mutants.equivalents import EQUIVALENTS
from tests.experiments.mutants.memory import Memory
from tests.experiments.mutants.patched import NotPatchedError, patch
from tests.experiments.mutants.recording import IMPORT
from tests.experiments.mutants.trial import Bench, Trial

SOURCE = '''\
"""Text: 1 < 2."""
NEAR = 1e-6
HALF: float = 0.5


def least(values: list[int | None], of=3) -> float:
    """Return a + b."""
    if (len(values) < of) and values:
        log(f"{of + 1}")
        return -min(values)
    return sum(v for v in values if not v) * HALF
'''


def changes(text: str) -> list[str]:
    return [mutant.change for mutant in mutants("m.py", text)]


def test_code_is_changed_and_texts_and_types_are_not() -> None:
    assert changes(SOURCE) == [
        "1e-6  ->  0.001",
        "0.5  ->  1.5",
        "3  ->  4",
        "(len(values) < of) and values  ->  not ((len(values) < of) and values)",
        "<  ->  <=",
        "<  ->  >",
        "and  ->  or",
        'log(f"{of + 1}")  ->  pass',
        "-  ->  nothing",
        "min  ->  max",
        "not  ->  nothing",
        "*  ->  /",
    ]


def test_a_guard_against_division_by_zero_is_left_alone() -> None:
    assert changes("a / max(b, 1e-300)") == ["/  ->  *", "max  ->  min"]
    assert changes("a / max(b, 1e-9)") == ["/  ->  *", "max  ->  min"]
    found = changes("c(a, 1e-9) / max(b, 0.5)")
    assert found == ["1e-9  ->  1.0000000000000002e-06", "/  ->  *", "max  ->  min", "0.5  ->  1.5"]


def test_what_only_fails_at_faults_is_left_alone() -> None:
    assert changes("assert a < b\nzip(a, b, strict=True)\nsort(a, reverse=True)") == [
        "zip(a, b, strict=True)  ->  pass",
        "sort(a, reverse=True)  ->  pass",
        "True  ->  False",
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("a  is  not b", "a  is b"),
        ("(a)+(b)", "(a)-(b)"),
        ("f(a) not in (b,)", "f(a) in (b,)"),
        ("(a #<\n < b)", "(a #<\n > b)"),
        ("é < b", "é > b"),
        ("a ** b", "a * b"),
    ],
)
def test_an_operator_is_changed_where_it_stands(old: str, new: str) -> None:
    assert new in [mutant.applied(old) for mutant in mutants("m.py", old)]


def test_every_mutant_is_a_program_and_another_one() -> None:
    files = [ROOT / "shotc/geom/vec.py", ROOT / "shotc/geom/sampling.py"]
    for path in files:
        text = path.read_text(encoding="utf-8")
        before = ast.dump(ast.parse(text))
        for mutant in mutants(path.name, text):
            assert ast.dump(ast.parse(mutant.applied(text))) != before, mutant


def test_a_longer_draw_starts_with_a_shorter_one() -> None:
    found = every(["shotc/geom/vec.py", "shotc/geom/taper.py"])
    assert draw(found, 5, 1) == draw(found, 9, 1)[:5]
    assert draw(found, 9, 1) != draw(found, 9, 2)


def test_a_change_of_the_source_changes_the_draw_where_it_is_alone() -> None:
    one, other = every(["shotc/geom/vec.py"]), every(["shotc/geom/taper.py"])
    drawn = draw([*one, *other], 12, 0)
    assert [m for m in drawn if m in other[1:]] == [m for m in draw(other[1:], 12, 0) if m in drawn]


@pytest.mark.slow
def test_an_equivalent_mutant_is_one_that_there_is() -> None:
    there = every(sorted({e.path for e in EQUIVALENTS}))
    keys = {(mutant.key, nth) for mutant in there for nth in (None, mutant.nth)}
    assert [e for e in EQUIVALENTS if (e.key, e.nth) not in keys] == []
    assert all(Path(ROOT / e.path).is_file() and e.reason for e in EQUIVALENTS)


def test_who_asks_for_what_is_shared_runs_its_lines() -> None:
    text = "def f(a):\n    return a + 1\n"
    (added, _) = mutants("m.py", text)
    lines = {"m.py": {"1": [""], "2": ["t::a", "shared plan"], "9": ["t::d"]}}
    record = {
        "lines": lines,
        "asked": {"shared plan": ["t::b", "shared case"], "shared case": ["t::c"]},
        "seconds": {"t::a": 1.0, "t::b": 0.5, "t::c": 0.1, "t::d": 0.1},
        "shared": {"shared plan": 0.2, "shared case": 0.3},
        "failed": [],
    }
    covered = CoverageMap([record])
    assert covered.tests(added) == ["t::c", "t::b", "t::a"]
    assert covered.cost("t::c") == pytest.approx(0.6)
    assert covered.cost("t::c", {"shared plan"}) == pytest.approx(0.4)
    assert CoverageMap([record, {**record, "failed": ["t::b"]}]).tests(added) == ["t::c", "t::a"]
    imported = {**record, "lines": {"m.py": {"1": [""], "2": ["", "t::a"], "9": ["t::d"]}}}
    assert set(CoverageMap([imported]).tests(added)) == {"t::a", "t::d"}


def test_tests_beside_the_source_come_first_and_those_named_like_it_before_them() -> None:
    (added, _) = mutants("shotc/geom/surface/near.py", "def f(a):\n    return a + 1\n")
    tests = [
        f"tests/unit/{name}.py::test"
        for name in ("geom/surface/test_near", "geom/surface/test_far", "geom/test_all", "show/test_near")
    ]
    record = {
        "lines": {"shotc/geom/surface/near.py": {"2": tests[::-1]}},
        "asked": {},
        "seconds": dict(zip(tests, (0.4, 0.2, 0.2, 0.2), strict=True)),
        "shared": {},
        "failed": [],
    }
    assert CoverageMap([record]).tests(added) == tests


def test_equivalent_mutants_are_not_counted() -> None:
    (mutant,) = mutants("m.py", "a + b")
    ends = [("killed", 8), ("timeout", 1), ("survived", 1), ("equivalent", 5)]
    trials = [Trial(mutant, verdict, 1) for verdict, count in ends for _ in range(count)]
    text, share = report(trials)
    assert share == 0.9
    assert "survived   m.py:1:3  +  ->  -  in  a + b" in text


BODIES = """\
NEAR = 1


class Held:
    def of(self):
        return [v + 1 for v in (1, 2)]


def twice(a):
    return Held().of(), a * 2
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("v + 1", "v - 1", ([0, 1], 6)),
        ("a * 2", "a / 2", ([2, 3], 1.5)),
        ("v + 1", "v + 1.0", ([2.0, 3.0], 6)),
    ],
)
def test_a_fault_is_put_into_functions_that_are_loaded(old: str, new: str, expected: object) -> None:
    names: dict[str, Any] = {}
    exec(compile(BODIES, "m.py", "exec"), names)
    patch((names["twice"], names["Held"].of), "m.py", BODIES, BODIES.replace(old, new))
    assert repr(names["twice"](3)) == repr(expected)


@pytest.mark.parametrize(
    ("old", "new"), [("NEAR = 1", "NEAR = 2"), ("class Held", "class Hold"), ("a * 2", "a / 2")]
)
def test_a_fault_outside_loaded_functions_needs_a_fresh_process(old: str, new: str) -> None:
    names: dict[str, Any] = {}
    exec(compile(BODIES, "m.py", "exec"), names)
    with pytest.raises(NotPatchedError):
        patch((names["Held"].of,), "m.py", BODIES, BODIES.replace(old, new))


HELD = """\
NEAR = 1


def far(a):
    return a > NEAR


def other(a):
    return a - NEAR
"""

HELD_TESTS = """\
from tests.held import NEAR, far


def test_near():
    assert NEAR == 1


def test_far():
    assert far(2)


def test_broken():
    assert far(1)
"""


def held_root(folder: Path) -> Path:
    """A tree with nothing but the programme."""
    root = folder / "root"
    shutil.copytree(ROOT / "tests/experiments/mutants", root / "tests/experiments/mutants")
    for name in ("tests/__init__.py", "tests/experiments/__init__.py", "pyproject.toml"):
        (root / name).touch()
    return root


@pytest.mark.long
def test_a_mutant_meets_the_tests_of_its_line(tmp_path: Path) -> None:
    """In a fork or, outside functions, in a fresh process; a test that fails anyway tells nothing."""
    root = held_root(tmp_path)
    (root / "tests/held.py").write_text(HELD, encoding="utf-8")
    (root / "tests/test_held.py").write_text(HELD_TESTS, encoding="utf-8")
    subprocess.run(["git", "init", "-q"], cwd=root, check=True)
    tests = [f"tests/test_held.py::test_{name}" for name in ("broken", "far", "near")]
    lines = {"1": [IMPORT], "5": tests[:2], "9": tests[1:2], "12": tests[2:]}
    record = {
        "lines": {"tests/held.py": lines},
        "asked": {},
        "seconds": dict.fromkeys(tests, 0.1),
        "shared": {},
        "failed": [],
    }
    remembered = tmp_path / "memory.jsonl"
    bench = Bench(root, tmp_path / "copy", CoverageMap([record]), tests, remembered=remembered, longest=10.0)
    trials = [(m.change, bench.tried(m).verdict) for m in mutants("tests/held.py", HELD)]
    bench.close()
    assert trials == [("1  ->  2", "killed"), (">  ->  <", "killed"), ("-  ->  +", "survived")]
    assert (tmp_path / "copy/tests/held.py").read_text(encoding="utf-8") == HELD


def test_a_killer_is_remembered_and_a_survivor_while_no_text_changes(tmp_path: Path) -> None:
    (tmp_path / "shotc").mkdir()
    module, tested, other = (tmp_path / name for name in ("shotc/m.py", "test_m.py", "test_n.py"))
    for path in (module, tested, other):
        path.write_text("a + b", encoding="utf-8")
    one, two = mutants("shotc/m.py", "a + b\na - b")
    file = tmp_path / "memory.jsonl"
    memory = Memory(file, tmp_path)
    memory.note(one, "killed", ["test_m.py::a"], "test_m.py::a")
    memory.note(two, "survived", ["test_m.py::a"], "")

    later = Memory(file, tmp_path)
    assert (later.killer(one), later.killer(two)) == ("test_m.py::a", "")
    assert later.survives(two, ["test_m.py::a"])
    assert not later.survives(one, ["test_m.py::a"])
    assert not later.survives(two, ["test_m.py::a", "test_n.py::b"])
    other.write_text("a", encoding="utf-8")
    assert Memory(file, tmp_path).survives(two, ["test_m.py::a"])
    tested.write_text("a", encoding="utf-8")
    assert not Memory(file, tmp_path).survives(two, ["test_m.py::a"])
    tested.write_text("a + b", encoding="utf-8")
    module.write_text("a", encoding="utf-8")
    assert not Memory(file, tmp_path).survives(two, ["test_m.py::a"])


@pytest.mark.long
def test_only_tests_of_new_text_are_recorded_again(tmp_path: Path) -> None:
    root = held_root(tmp_path)
    (root / "held").mkdir()
    (root / "held/module.py").write_text(HELD, encoding="utf-8")
    for name in "ab":
        text = f"from held.module import far\n\n\ndef test_{name}():\n    assert far(2)\n"
        (root / f"tests/test_{name}.py").write_text(text, encoding="utf-8")
    options = Namespace(record=False, tests="tests", jobs=1)

    def ids() -> list[str]:
        return sorted(recorded(tmp_path / "record", ["held"], root, options).seconds)

    def runs() -> int:
        return len(list((tmp_path / "record").glob("*/*.json")))

    assert (ids(), runs()) == (["tests/test_a.py::test_a", "tests/test_b.py::test_b"], 1)
    assert (ids(), runs()) == (["tests/test_a.py::test_a", "tests/test_b.py::test_b"], 1)
    (root / "tests/test_b.py").write_text(text.replace("test_b", "test_c"), encoding="utf-8")
    assert (ids(), runs()) == (["tests/test_a.py::test_a", "tests/test_b.py::test_c"], 2)
    (last,) = (tmp_path / "record/001").glob("*.json")
    assert list(json.loads(last.read_text(encoding="utf-8"))["seconds"]) == ["tests/test_b.py::test_c"]
    (root / "held/module.py").write_text(f"{HELD}\nFAR = 2\n", encoding="utf-8")
    assert (len(ids()), runs()) == (2, 1)
