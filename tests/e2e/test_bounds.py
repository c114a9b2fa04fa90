"""Times that ``check`` can only bound: it says so, and ``plan`` answers each with the exact number, once."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry

MISSION = """\
shotc: 1
mission: bounds
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0], endurance: 5 min}}
rules: {composition: center}
shots:
  - id: pass
    kind: keyframes
    drone: cam
    target: mast
    timing: {start: 20 s, duration: 16 s}
    keyframes:
      - {at: [-20, -20, 8], look_at: mast}
      - {at: [0, -24, 9], look_at: mast}
      - {at: [20, -20, 10], look_at: mast, hold: 1 s}
"""
SLIPS = {
    "K003": ("hold: 1 s", "hold: 20 s"),
    "K004": ("duration: 16 s", "duration: 4 s"),
    "K005": ("endurance: 5 min", "endurance: 15 s"),
    "K008": ("start: 20 s", "start: 1 s"),
}
REMEDIES = {
    "T001": (r"duration: \d+ s", r"`(duration: [\d.]+ s)`"),
    "T003": (r"start: \d+ s", r"`(start: [\d.]+ s)`"),
}


def checked(text: str) -> list[Diagnostic]:
    return list(check_source(text.encode(), "bounds.yaml", None).diagnostics)


def planned(text: str) -> tuple[bool, list[Diagnostic]]:
    done = compile_source(text.encode(), "bounds.yaml", None, PlanOptions(refiner="none"))
    return done.plan is not None, list(done.diagnostics)


@pytest.mark.slow
@pytest.mark.parametrize("code", SLIPS)
def test_check_knows_a_bound_and_plan_the_number(code: str) -> None:
    assert SLIPS[code][0] in MISSION
    text = MISSION.replace(*SLIPS[code])
    assert [d.code for d in checked(text)] == [code]
    done, (told,) = planned(text)
    assert not done
    assert told.code in registry()[code].exact
    if told.code not in REMEDIES:
        return
    old, new = REMEDIES[told.code]
    number = re.search(new, told.help)
    assert number is not None, told.help
    done, found = planned(re.sub(old, number[1], text))
    assert (done, found) == (True, [])


@pytest.mark.parametrize("code", ["K003", "K004", "K008"])
def test_what_check_proposes_says_that_it_is_a_bound(code: str) -> None:
    (told,) = checked(MISSION.replace(*SLIPS[code]))
    assert re.search(r"more than|later than", told.help)
    assert "`shotc plan` finds" in told.help


@pytest.mark.slow
@pytest.mark.parametrize("code", ["K006", "K007"])
def test_shots_in_each_others_way_are_answered_once(code: str) -> None:
    text = registry()[code].failing
    assert [d.code for d in checked(text)] == [code]
    done, (told,) = planned(text)
    assert (done, told.code) == (False, "T003")


def test_a_bound_stands_where_no_later_pass_answers_it(tmp_path: Path) -> None:
    text = MISSION.replace(*SLIPS["K004"])
    for stop in ("resolve", "place-keyframes", "solve-path-qp"):
        done = compile_source(
            text.encode(), "bounds.yaml", tmp_path, PlanOptions(refiner="none", stop_after=stop)
        )
        assert done.plan is None
        assert [d.code for d in done.diagnostics] == ["K004"]
    assert done.reports[-1].name == "solve-path-qp"


def test_check_still_judges_the_framing() -> None:
    text = MISSION.replace(*SLIPS["K004"]).replace("[0, -24, 9]", "[0, -6, 9]")
    assert [d.code for d in checked(text)] == ["K004", "G010"]
