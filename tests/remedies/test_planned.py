"""The examples of every code that `plan` finds, on convex paths (`make fuzz`: refined, too), and their help.

The failing one raises its code alone, the passing one nothing, and each remedy that the help names is
written into the failing one and planned.
"""

from __future__ import annotations

from functools import cache, partial

import pytest

from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry
from tests.support.remedies.tried import Judge, failed

pytestmark = pytest.mark.slow

PLANNED = [info for info in registry().values() if info.phase == "plan"]

TOLD_IN_WORDS = {
    **dict.fromkeys(("M008", "M009", "Q001", "Q006"), "what moves out of the way is the author's choice"),
    **dict.fromkeys(("M011", "M013", "Q009"), "where else a home or a keyframe goes is the author's choice"),
    "V029": "where a shot begins and ends is the author's choice",
    "Q007": "where a keyframe goes is the author's choice",
    "N016": "a command of its own finds the target, or the author names it",
    "E101": "only the author knows where on earth it is",
    **dict.fromkeys(
        ("E102", "E107", "E116", "E118", "E121", "E123", "E145"),
        "it says what to do with the file, the mission is in order",
    ),
}
"""Codes whose help no rule applies, and why."""

UNREFINED = ("Q007",)
"""Codes of the convex path alone: a refiner leads the path aside, and verification tells what is left."""


REFINED = ("M008", "Q009")
"""Codes of which a refiner is asked: on its convex path the example has another, too."""

LONG = ("D056", "M011", "M015")
"""Codes whose remedies are many or long to plan: `make fuzz` tries them."""

OTHERS = [info for info in PLANNED if info.code not in (*REFINED, *UNREFINED)]


@cache
def planned(text: str, refiner: str | None = None) -> list[Diagnostic]:
    """Return all that planning a mission tells, and writing its outputs where it names some."""
    made = compile_source(text.encode(), "mission.yaml", None, PlanOptions(refiner=refiner))
    written = made.plan is not None and "emit" in text
    return [*made.diagnostics, *(emit_plan(made.plan).diagnostics if written else ())]


@pytest.mark.long
@pytest.mark.parametrize("info", PLANNED, ids=[info.code for info in PLANNED])
def test_an_example_shows_its_code_alone_and_its_help_does(info: CodeInfo) -> None:
    judged = partial(planned, refiner=None if info.code in REFINED else "none")
    assert_shown(info, judged)
    if info.code not in LONG:
        assert_mended(info, judged)


@pytest.mark.fuzz
@pytest.mark.parametrize("info", OTHERS, ids=[info.code for info in OTHERS])
def test_an_example_does_so_when_it_is_refined(info: CodeInfo) -> None:
    assert_shown(info, planned)
    assert_mended(info, planned)


def assert_shown(info: CodeInfo, judged: Judge) -> None:
    assert {d.code for d in judged(info.failing)} == {info.code}
    assert judged(info.passing) == []


def assert_mended(info: CodeInfo, judged: Judge) -> None:
    found, wrong = failed(info.failing, judged)
    assert bool(found) != (info.code in TOLD_IN_WORDS), "a rule applies it, or the list says why none does"
    assert wrong == []
