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
from tests.support.remedies.by_hand import unnumbered
from tests.support.remedies.by_hand_planned import PLANNED_HANDS
from tests.support.remedies.tried import Judge, tried_all

pytestmark = pytest.mark.slow

AT_THE_FIELD = "it says what to do at the field, the mission is in order"
STREAMED = "it is another way to fly the same plan"
PLANNED = [info for info in registry().values() if info.phase == "plan"]

NOT_WRITTEN = {
    ("M009", "move the shot or zone `lane` by # m"): "then M011 is found, whose help is tried",
    ("N016", "run `shotc identify mission.yaml`"): "it is a command; tests/cli/test_identify.py runs it",
    (
        "D055",
        "name a .ttf file beside the mission",
    ): "it takes a font; tests/unit/show/goals/test_goal_sources.py reads one",
    ("E102", "watch the zone by eye"): AT_THE_FIELD,
    ("E121", "try it in a wide place first"): AT_THE_FIELD,
    ("E123", "keep them in mind"): AT_THE_FIELD,
    ("E118", "start it by eye, frame more loosely"): AT_THE_FIELD,
    ("E124", "take the photos by hand or out of the film"): AT_THE_FIELD,
    ("E145", "fly them by one clock with `shotc stream`"): STREAMED,
    ("E107", "fly the plan itself with `shotc stream`"): STREAMED,
    ("E118", "fly the plan itself with `shotc stream` on a machine that takes it"): STREAMED,
    ("E116", "plan with `--autopilot dji-fly`"): "it is an option of the command",
}
"""Alternatives that are no edit of a mission, and why."""

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
    result = tried_all(info.failing, judged, PLANNED_HANDS)
    assert result.wrong == []
    assert [text for text in result.untried if (info.code, unnumbered(text)) not in NOT_WRITTEN] == []
