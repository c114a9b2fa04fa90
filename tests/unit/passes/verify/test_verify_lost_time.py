"""Time that the mission leaves free: how long a way takes, how long a drone waits, and for whom."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.geom.shapes import CylinderShape
from shotc.geom.track import Track
from shotc.ir.limits import Timing
from shotc.ir.mission import Shot
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.passes.verify.least_time import least_times
from shotc.passes.verify.lost_time import BETWEEN, BETWEEN_SHOTS, WAY
from shotc.passes.verify.waits import WAITED
from tests.support.records import replace
from tests.support.slowed_plans import inserted, stretched, waiting
from tests.support.tampered_plans import MISSION, PLAN
from tests.support.timing_paths import CEILING, circle, line, s_curve_time
from tests.support.verdicts import claim, codes, verdict_on

pytestmark = pytest.mark.slow

DRONE, TRACK = MISSION.drones[0], PLAN.drones[0]
SHOT = (22.0, 52.0)
POSE = (20.0, 0.0, 0.0, 0.0, 1.2)


def free(track: object = TRACK, hold: float = 0.0, **changes: object) -> TrajectoryIR:
    """The half orbit with a free time at a calm pace; track : flown; hold : of its first keyframe."""
    shot: Shot = replace(MISSION.shots[0], **{"timing": Timing(), "pace": 0.6, **changes})
    placed = PLAN.keyframes.shots[0]
    first = replace(placed.keyframes[0], hold=hold)
    placed = replace(placed, shot=shot, keyframes=(first, *placed.keyframes[1:]))
    mission = replace(MISSION, shots=(shot,))
    return replace(PLAN, drones=(track,), keyframes=replace(PLAN.keyframes, mission=mission, shots=(placed,)))


@pytest.mark.parametrize("length", [0.5, 5.0, 30.0, 300.0])
def test_the_least_time_of_a_line_is_that_of_its_limits(length: float) -> None:
    path = line((0.0, 0.0, *POSE), (length, 0.0, *POSE))
    flown = least_times(path, (0.0, length), DRONE, 1.0).least[-1]
    exact = s_curve_time(length, CEILING.speed, CEILING.acceleration, CEILING.jerk)
    assert flown == pytest.approx(exact, rel=0.1)
    assert least_times(path, (0.0, length), DRONE, 0.5).least[-1] > 1.2 * flown


def test_a_narrow_circle_is_as_slow_as_its_acceleration() -> None:
    path = circle(2.0, 6.0)
    flown = least_times(
        path, (0.0, path.end), replace(DRONE, limits=DRONE.limits._replace(yaw_rate=99.0)), 1.0
    )
    assert flown.least[-1] > path.end / np.sqrt(CEILING.acceleration * 2.0)


def test_up_and_down_and_with_the_wind_each_have_their_speed() -> None:
    pose = POSE[1:]
    up, down = (line((0.0, 0.0, a, *pose), (0.0, 0.0, b, *pose)) for a, b in ((10.0, 90.0), (90.0, 10.0)))
    climb, descent = (least_times(path, (0.0, 80.0), DRONE, 1.0).least[-1] for path in (up, down))
    assert climb == pytest.approx(s_curve_time(80.0, 4.0, 3.0, 8.0), rel=0.1)
    assert descent == pytest.approx(s_curve_time(80.0, 3.0, 3.0, 8.0), rel=0.1)
    windy = replace(DRONE, limits=DRONE.limits._replace(wind=(3.0, 0.0)))
    path = line((0.0, 0.0, *POSE), (300.0, 0.0, *POSE))
    flown = least_times(path, (0.0, 300.0), windy, 1.0).least[-1]
    assert flown == pytest.approx(s_curve_time(300.0, 11.0, 3.0, 8.0), rel=0.1)


def test_neither_a_slower_law_nor_rests_change_the_least_time() -> None:
    calm = stretched(TRACK, SHOT, 8.0)
    held = waiting(TRACK, SHOT[0], 62.0)
    first = least_times(TRACK.curve, SHOT, DRONE, 1.0).least[-1]
    for track, end in ((calm, 22.0 + 8.0 * 30.0), (held, 52.0 + 62.0)):
        assert least_times(track.curve, (22.0, end), DRONE, 1.0).least[-1] == pytest.approx(first, rel=2e-3)


@pytest.mark.parametrize(("factor", "holds"), [(1.0, True), (2.0, False), (8.0, False)])
def test_a_free_shot_is_about_as_fast_as_its_pace(factor: float, holds: bool) -> None:
    ir = free(stretched(TRACK, SHOT, factor))
    assert claim(ir, BETWEEN).holds is holds
    assert ("V066" in codes(ir)) is not holds


@pytest.mark.parametrize(("hold", "holds"), [(0.0, False), (62.0, True)])
@pytest.mark.parametrize("duration", [None, 92.0])
def test_a_hold_lasts_as_long_as_it_is_asked_for(hold: float, holds: bool, duration: float | None) -> None:
    ir = free(waiting(TRACK, SHOT[0], 62.0), hold=hold, timing=Timing(duration=duration))
    assert claim(ir, BETWEEN).holds is holds


@pytest.mark.parametrize(
    ("asked", "rests", "holds"), [(0.0, 1.0, False), (2.0, 3.0, False), (2.0, 2.0, True)]
)
def test_a_second_of_rest_that_nobody_asked_for_is_lost(asked: float, rests: float, holds: bool) -> None:
    assert claim(free(waiting(TRACK, SHOT[0], rests), hold=asked), BETWEEN).holds is holds


def test_rest_within_a_given_time_is_not_lost() -> None:
    """A drone that reaches a keyframe at its ``time`` at the latest may rest there on its way to the next."""
    track = waiting(TRACK, SHOT[0], 1.5)
    assert claim(free(track, timing=Timing(duration=31.5)), BETWEEN).holds


def test_between_two_keyframes_at_the_same_time_nothing_is_lost() -> None:
    first, *others = TRACK.keyframes
    track = replace(TRACK, keyframes=(first, replace(first, index=1), *others[1:]))
    assert claim(free(track), BETWEEN).holds


def test_a_keyframe_a_nanosecond_outside_its_shot_hides_no_lost_time() -> None:
    slow = stretched(TRACK, SHOT, 8.0)
    first, *others = slow.keyframes
    early = replace(slow, keyframes=(replace(first, time=first.time - 1e-9), *others))
    assert not claim(free(early), BETWEEN).holds


def test_a_shot_flies_no_loops_beside_its_way() -> None:
    """Six times 12 m aside and back, where 15 m aside are allowed, before it goes on its way."""
    k = int(np.argmin(np.abs(TRACK.curve.breaks - SHOT[0])))
    here = TRACK.curve(SHOT[0])
    places = here + np.outer(np.arange(13) % 2, 12.0 * np.eye(7)[0])
    zero = np.zeros((13, 7))
    loops = quintic_hermite(SHOT[0] + 6.0 * np.arange(13.0), places, zero, zero)
    flown, sound = free(inserted(TRACK, k, loops)), free()
    assert claim(sound, "detour between keyframes").holds
    assert claim(flown, "way between keyframes").holds
    assert not claim(flown, "detour between keyframes").holds
    assert claim(flown, "detour between keyframes").worst == pytest.approx(144.0 + 31.4, abs=1.0)
    assert "V044" in codes(flown)


def test_a_shot_with_a_duration_may_be_slow() -> None:
    assert claim(free(stretched(TRACK, SHOT, 8.0), timing=Timing(duration=240.0)), BETWEEN).holds


def test_a_slow_transit_is_refused() -> None:
    assert claim(free(), BETWEEN_SHOTS).holds
    slow = free(stretched(TRACK, (0.0, 22.0), 4.0))
    assert "V066" in codes(slow)
    assert not claim(slow, BETWEEN_SHOTS).holds


def test_a_way_is_no_longer_than_what_stands_explains() -> None:
    """Two kilometres away and back, as fast as the drone flies."""
    k = int(np.argmin(np.abs(TRACK.curve.breaks - 8.0)))
    here = TRACK.curve(8.0)
    far = here - 2000.0 * np.eye(7)[1]
    zero = np.zeros((3, 7))
    loop = quintic_hermite(np.array([8.0, 490.0, 972.0]), np.stack([here, far, here]), zero, zero)
    ir = free(inserted(TRACK, k, loop))
    assert claim(ir, BETWEEN_SHOTS).holds
    assert not claim(ir, WAY).holds
    assert claim(ir, WAY).worst == pytest.approx(4030.4, abs=1.0)
    assert "V066" in codes(ir)


@pytest.mark.parametrize("at", [0.0, 8.0, 82.0])
def test_nobody_waits_without_a_reason(at: float) -> None:
    ir = free(waiting(TRACK, at, 1000.0))
    found = next(d for d in verdict_on(ir).diagnostics if d.code == "V066")
    assert "wait without a reason is 1000 s, at most 3 s" in found.message
    assert claim(free(waiting(TRACK, at, 2.9)), WAITED).holds


@pytest.mark.parametrize("at", [0.0, 82.0])
def test_a_wait_of_a_day_is_refused_like_any_other(at: float) -> None:
    assert claim(passed(0.0, 20.0, waiting(TRACK, at, 9e4)), WAITED).worst > 8e4


def test_a_flight_of_years_is_none() -> None:
    (found,) = verdict_on(free(waiting(TRACK, 0.0, 1e9))).diagnostics
    assert "lasts until 1e+09 s, longer than 100000 s" in found.message


def test_a_start_of_the_mission_is_a_reason() -> None:
    late = waiting(TRACK, 0.0, 1000.0)
    assert claim(free(late, timing=Timing(start=1022.0)), WAITED).worst == 0.0
    assert claim(free(late, timing=Timing(after="other")), WAITED).worst > 900.0


def passed(wait: float, until: float, track: DroneTrajectory | None = None) -> TrajectoryIR:
    """A flight that waits on its pad beside a walker, who leaves at ``until`` seconds; or another one."""
    walker = Target(
        "walker",
        (3.0, -60.0, 0.9),
        CylinderShape(0.4, 1.8),
        ("targets", "walker"),
        Track((0.0, until, until + 100.0), ((3.0, -60.0, 0.9), (3.0, -60.0, 0.9), (3.0, -560.0, 0.9))),
    )
    ir = free(track or waiting(TRACK, 0.0, wait))
    return replace(
        ir,
        keyframes=replace(
            ir.keyframes, mission=replace(ir.keyframes.mission, targets=(*MISSION.targets, walker))
        ),
    )


@pytest.mark.parametrize(
    ("wait", "until", "holds"),
    [(20.0, 20.0, True), (60.0, 60.0, True), (60.0, 20.0, False), (20.0, 1.0, False)],
)
def test_a_passer_by_is_a_reason_while_he_is_near(wait: float, until: float, holds: bool) -> None:
    assert claim(passed(wait, until), WAITED).holds is holds
