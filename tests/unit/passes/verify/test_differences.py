"""How many differences between a plan and its mission are told one by one."""

from __future__ import annotations

import pytest

from shotc.passes.verify.asked import MissionDifference
from shotc.passes.verify.file import MOST_REPORTED, told
from tests.support.film_plans import orbit_plan

ASKED = orbit_plan().trajectory.keyframes


@pytest.mark.parametrize("count", [0, 1, MOST_REPORTED, MOST_REPORTED + 1, MOST_REPORTED + 5])
def test_the_first_ones_are_told_and_the_others_counted(count: int) -> None:
    found = [MissionDifference(("shots", 0), f"difference {k}") for k in range(count)]
    texts = [d.message for d in told(found, ASKED, "V016", ("a note",))]
    assert texts[:MOST_REPORTED] == [d.text for d in found[:MOST_REPORTED]]
    more = [f"and {count - MOST_REPORTED} more differences between the plan and its mission"]
    assert texts[MOST_REPORTED:] == (more if count > MOST_REPORTED else [])
