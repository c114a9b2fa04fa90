"""Claims on the visible share of a target, from given shares of its outline."""

from __future__ import annotations

from math import inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.visible import HALF_SHARE, longest, visible
from tests.support.film_plans import orbit_plan

TIMES = np.array([3.0, 4.0, 5.0, 6.0, 7.0, 8.0])
EVERY = np.ones(len(TIMES), dtype=bool)


def claims(covered: list[float], *, visible_share: float | None = None, reveal: Any = None) -> list[Claim]:
    plan = orbit_plan().trajectory
    mission = plan.keyframes.mission
    promise = SimpleNamespace(visible=visible_share, reveal=reveal)
    shot: Any = SimpleNamespace(id="look", path=("shots", 0), promise=promise)
    flight = JudgedFlight(mission, mission.drones[0], plan.drones[0])
    return list(visible(flight, shot, "tower", TIMES, (np.array(covered), EVERY)))


def told(claim: Claim) -> tuple[float, float, float | None, bool, bool]:
    return claim.worst, claim.limit, claim.time, claim.hard, claim.holds


def test_without_a_promise_half_of_it_and_half_of_the_frames_are_enough() -> None:
    least, most = claims([0.0, 0.8, 0.9, 0.9, 0.2, 0.6])
    # The least share stands longest from 5 to 6 s; less than half is seen at 4 to 6 s and at 8 s.
    assert told(least) == (pytest.approx(0.1), HALF_SHARE, 5.0, False, False)
    assert told(most) == (pytest.approx(2 / 6), HALF_SHARE, 5.0, False, False)


def test_a_promised_share_is_required_and_replaces_the_count_of_frames() -> None:
    least, most = claims([0.3, 0.2, 0.4, 0.1, 0.0, 0.0], visible_share=0.6)
    assert told(least) == (pytest.approx(0.6), 0.6, 5.0, True, True)
    assert least.path == ("shots", 0, "require", "visible")
    assert told(most) == (1.0, -inf, 3.0, False, True)


@pytest.mark.parametrize(("first", "last"), [(0.2, 0.9), (0.9, 0.2)])
def test_a_reveal_counts_in_the_first_and_in_the_last_frame_from_both_sides(
    first: float, last: float
) -> None:
    covered = [0.75, 0.5, 0.6, 0.7, 0.65, 0.15]
    found = claims(covered if first < last else covered[::-1], reveal=(first, last))
    assert [c.limit for c in found] == [-inf, -inf, first, last]
    at_first, at_last = found[2:]
    few, many = (at_first, at_last) if first < last else (at_last, at_first)
    assert (few.worst, few.upper, few.holds) == (pytest.approx(0.25), True, False)
    assert (many.worst, many.upper, many.holds) == (pytest.approx(0.85), False, False)
    assert (at_first.time, at_last.time) == (3.0, 8.0)
    assert [c.path[-1] for c in found[2:]] == ["from", "to"]


@pytest.mark.parametrize(
    ("hidden", "middle"),
    [([0, 0, 0], 0), ([1, 0, 0], 0), ([0, 1, 1], 1), ([1, 0, 1, 1, 1], 3), ([1, 1, 0, 1], 0), ([1, 1, 1], 1)],
)
def test_the_longest_run_is_told_by_its_middle(hidden: list[int], middle: int) -> None:
    assert longest(np.array(hidden, dtype=bool)) == middle
