"""The mutants: which changes are made, that each is a program, and whose tests they meet."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.experiments.mutants.__main__ import ROOT, draw, every, report
from tests.experiments.mutants.changes import mutants
from tests.experiments.mutants.coverage_map import CoverageMap
from tests.experiments.mutants.equivalents import EQUIVALENTS
from tests.experiments.mutants.trial import Trial

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


def test_an_equivalent_mutant_is_one_that_there_is() -> None:
    keys = {mutant.key for mutant in every(sorted({e.path for e in EQUIVALENTS}))}
    assert [e for e in EQUIVALENTS if e.key not in keys] == []
    assert all(Path(ROOT / e.path).is_file() and e.reason for e in EQUIVALENTS)


def test_who_asks_for_what_is_shared_runs_its_lines() -> None:
    text = "def f(a):\n    return a + 1\n"
    (added, _) = mutants("m.py", text)
    lines = {"m.py": {"1": [""], "2": ["t::a", "shared plan"], "9": ["t::d"]}}
    record = {
        "lines": lines,
        "asked": {"shared plan": ["t::b", "shared case"], "shared case": ["t::c"]},
        "seconds": {"t::a": 1.0, "t::b": 0.5, "t::c": 0.1, "t::d": 0.1},
        "failed": [],
    }
    assert CoverageMap([record]).tests(added) == ["t::c", "t::b", "t::a"]
    assert CoverageMap([record, {**record, "failed": ["t::b"]}]).tests(added) == ["t::c", "t::a"]
    imported = {**record, "lines": {"m.py": {"1": [""], "2": ["", "t::a"], "9": ["t::d"]}}}
    assert set(CoverageMap([imported]).tests(added)) == {"t::a", "t::d"}


def test_equivalent_mutants_are_not_counted() -> None:
    (mutant,) = mutants("m.py", "a + b")
    ends = [("killed", 8), ("timeout", 1), ("survived", 1), ("equivalent", 5)]
    trials = [Trial(mutant, verdict, 1) for verdict, count in ends for _ in range(count)]
    text, share = report(trials)
    assert share == 0.9
    assert "survived   m.py:1  +  ->  -  in  a + b" in text
