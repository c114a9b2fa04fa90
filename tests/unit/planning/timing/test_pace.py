"""The pace of a leg whose time is free, and what it may use in a duration that planning gives to it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from shotc.ir.pace import most_share
from shotc.ir.path import MovingLeg, Stop
from shotc.planning.path.rejoin import lasting
from shotc.planning.path.with_camera import NoTransit
from shotc.planning.timing.limits import ceiling_of
from shotc.planning.timing.timed_leg import leg_motion, leg_time
from tests.support.timing_paths import line, mission, shot_leg, uses

DRONE = mission().drones[0]
PACE = 0.6
MOST = most_share(PACE)


def leg(length: float, **changes: object) -> MovingLeg:
    ends = ((0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 1.2), (length, 0.0, 20.0, 0.0, 0.0, 0.0, 1.2))
    return replace(shot_leg(line(*ends)), pace=PACE, **changes)


def most_used(flown: MovingLeg) -> float:
    """The largest share of the limits that a leg uses."""
    motion = leg_motion(DRONE, flown)
    assert motion is not None
    return max(uses(motion.curve, ceiling_of(DRONE)).values())


def test_a_longer_way_in_the_old_time_uses_more_than_the_pace_but_not_more_than_its_share() -> None:
    old = leg(60.0)
    new = lasting(DRONE, old, leg(66.0))
    assert leg_time(DRONE, new) == pytest.approx(leg_time(DRONE, old), abs=1e-9)
    assert most_used(old) == pytest.approx(PACE, abs=1e-3)
    assert PACE + 0.01 < most_used(new) <= MOST


def test_a_way_that_full_limits_alone_would_fly_in_time_needs_the_time_of_its_pace() -> None:
    old, new = leg(60.0), leg(84.0)
    assert leg_time(DRONE, replace(new, pace=1.0)) < leg_time(DRONE, old)
    with pytest.raises(NoTransit, match=r"at 0\.75 of the limits") as fault:
        lasting(DRONE, old, new)
    assert fault.value.least == pytest.approx(leg_time(DRONE, new))


def test_a_duration_of_the_mission_is_met_at_full_limits() -> None:
    given = leg(60.0, duration=leg_time(DRONE, replace(leg(60.0), pace=1.0)) + 0.01)
    assert most_used(lasting(DRONE, given, given)) > 0.99


def test_a_smoothing_is_kept_in_a_given_time() -> None:
    old, new = leg(60.0, smoother=3.0), leg(66.0, smoother=3.0)
    motion = leg_motion(DRONE, lasting(DRONE, old, new))
    assert motion is not None
    assert uses(motion.curve, ceiling_of(DRONE))["jerk"] <= MOST / 3.0


def test_after_the_last_time_a_leg_that_rests_there_keeps_its_pace() -> None:
    flown = leg(60.0)
    marks = (replace(flown.marks[0], time=0.0), replace(flown.marks[0], s=20.0, time=8.0), flown.marks[1])
    timed = replace(flown, marks=marks, stops=(Stop(0.0, 0.0), Stop(20.0, 1.0), Stop(60.0, 0.0)))
    motion = leg_motion(DRONE, timed)
    assert motion is not None
    after = motion.moves[1].curve
    assert max(uses(after, ceiling_of(DRONE)).values()) <= PACE
