"""How many differences between a plan and its mission are told one by one."""

from __future__ import annotations

import pytest

from shotc.passes.verify.asked import MissionDifference
from shotc.passes.verify.file import REPORTED, told
from tests.support.film_plans import orbit_plan

ASKED = orbit_plan().trajectory.keyframes


@pytest.mark.parametrize("count", [0, 1, REPORTED, REPORTED + 1, REPORTED + 5])
def test_the_first_ones_are_told_and_the_others_counted(count: int) -> None:
    found = [MissionDifference(("shots", 0), f"difference {k}") for k in range(count)]
    texts = [d.message for d in told(found, ASKED, "V016", ("a note",))]
    assert texts[:REPORTED] == [d.text for d in found[:REPORTED]]
    more = [f"and {count - REPORTED} more differences between the plan and its mission"]
    assert texts[REPORTED:] == (more if count > REPORTED else [])
