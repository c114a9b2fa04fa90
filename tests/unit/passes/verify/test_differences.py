"""How many differences between a plan and its mission are told one by one."""

from __future__ import annotations

from math import inf, nan

import pytest

from shotc.passes.verify.asked import MissionDifference
from shotc.passes.verify.certificate import _same
from shotc.passes.verify.file import MOST_REPORTED, diagnostics_of
from tests.support.film_plans import orbit_plan

ASKED = orbit_plan().trajectory.keyframes


@pytest.mark.parametrize("count", [0, 1, MOST_REPORTED, MOST_REPORTED + 1, MOST_REPORTED + 5])
def test_the_first_ones_are_told_and_the_others_counted(count: int) -> None:
    found = [MissionDifference(("shots", 0), f"difference {k}") for k in range(count)]
    texts = [d.message for d in diagnostics_of(found, ASKED, "V016", ("a note",))]
    assert texts[:MOST_REPORTED] == [d.text for d in found[:MOST_REPORTED]]
    more = [f"and {count - MOST_REPORTED} more differences between the plan and its mission"]
    assert texts[MOST_REPORTED:] == (more if count > MOST_REPORTED else [])


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        (1.0, 1.0, True),
        (1.0, 1.1, False),
        (1000.0, 1000.0 * (1 + 1e-3), False),
        (inf, inf, True),
        (inf, 1.0, False),
        (-inf, inf, False),
        (nan, nan, False),
    ],
)
def test_two_numbers_of_claims_are_the_same_whichever_is_proved(one: float, other: float, same: bool) -> None:
    assert _same(one, other) is same
    assert _same(other, one) is same
