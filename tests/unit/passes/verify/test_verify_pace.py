"""The pace of a shot whose time is free: each limit that it scales, at every instant."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import pieces
from shotc.geom.proof import sup_convex
from shotc.ir.drone import Drone, LensRange
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.limits import Timing
from shotc.ir.mission import Shot
from shotc.ir.pace import most_share
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify.paced import CONSTRAINT, limit_uses
from tests.support.records import replace
from tests.support.tampered_plans import MISSION, PLAN
from tests.support.verdicts import claim, codes, verdict_on

DRONE = MISSION.drones[0]
WINDY = replace(
    DRONE,
    limits=DRONE.limits._replace(wind=(2.0, -3.0), tilt=radians(5)),
    lens=LensRange(radians(20), radians(80), 0.7),
)
CURVE = Piecewise(np.arange(5.0), np.random.default_rng(4).normal(size=(4, 6, 7)))
SMOOTHER = 3.0


def dense(order: int) -> Array:
    derived = CURVE.derivative(order)
    return np.concatenate([derived(np.linspace(0.0, 4.0, 20_001)), *derived.ctrl[:, [0, -1]]])


def size(order: int, *channels: int) -> float:
    return float(np.linalg.norm(dense(order)[:, channels], axis=1).max())


def least_scale(limits_speed: float) -> float:
    """The least factor on all ground speeds of a limit in wind that reaches every speed, by bisection."""
    low, high = 0.0, 1e3
    velocity, wind = dense(1)[:, :2], np.array(WINDY.limits.wind)
    for _ in range(50):
        middle = 0.5 * (low + high)
        kept = np.linalg.norm(velocity / middle - wind, axis=1) <= limits_speed
        low, high = (low, middle) if kept.all() else (middle, high)
    return high


def swing(order: int) -> float:
    rows = dense(order)
    return float(np.abs(rows[:, CAM_YAW] - rows[:, BODY_YAW]).max())


def expected(drone: Drone) -> list[tuple[str, float]]:
    limits, gimbal, lens = drone.limits, drone.gimbal, drone.lens
    assert lens is not None
    return [
        ("speed", least_scale(limits.speed)),
        ("climb", float(dense(1)[:, 2].max()) / limits.climb),
        ("descent", float(-dense(1)[:, 2].min()) / limits.descent),
        ("acceleration", size(2, 0, 1, 2) / (9.80665 * np.sin(radians(5)))),
        ("jerk", size(3, 0, 1, 2) / (limits.jerk / SMOOTHER)),
        ("yaw_rate", size(1, BODY_YAW) / limits.yaw_rate),
        ("yaw_acceleration", size(2, BODY_YAW) / limits.yaw_acceleration),
        ("gimbal.rate", swing(1) / gimbal.rate),
        ("gimbal.acceleration", swing(2) / gimbal.acceleration),
        ("gimbal.rate", size(1, CAM_PITCH) / gimbal.rate),
        ("gimbal.acceleration", size(2, CAM_PITCH) / gimbal.acceleration),
        ("zoom_rate", size(1, HFOV) / lens.rate),
    ]


def test_each_limit_counts_by_the_largest_share_that_is_used_at_any_instant() -> None:
    uses = limit_uses(WINDY, pieces(CURVE), SMOOTHER)
    found = [(use.name, sup_convex(use.pieces, use.share, lambda _: 1e-7).proven) for use in uses]
    for (name, share), (known, true) in zip(found, expected(WINDY), strict=True):
        assert name == known
        assert share == pytest.approx(true, rel=1e-3), name


def test_a_low_smoothing_leaves_the_jerk_limit_as_it_is_and_a_fixed_lens_does_not_zoom() -> None:
    uses = limit_uses(DRONE, pieces(CURVE), 0.5)
    assert "zoom_rate" not in {use.name for use in uses}
    assert uses[4].name == "jerk"
    assert float(uses[4].share(np.array([DRONE.limits.jerk, 0.0, 0.0]))) == pytest.approx(1.0)


def paced(
    *, beside: bool = False, placed: tuple[PlacedKeyframe, ...] | None = None, **changes: object
) -> TrajectoryIR:
    """The half orbit, at 0.982 of its speed limit, with a free time; ``beside`` a second drone."""
    shot: Shot = replace(MISSION.shots[0], **{"timing": Timing(), **changes})
    old = PLAN.keyframes.shots[0]
    whole = replace(old, shot=shot, keyframes=placed or old.keyframes)
    shots: tuple[PlacedShot, ...] = (whole,)
    if beside:
        shots += (replace(whole, shot=replace(shot, id="other", drone="cam2")),)
    mission = replace(MISSION, shots=(shot,))
    return replace(PLAN, keyframes=replace(PLAN.keyframes, mission=mission, shots=shots))


def test_a_brisk_flight_is_refused_for_a_normal_shot() -> None:
    found = next(d for d in verdict_on(paced(pace=0.75)).diagnostics if d.code == "V065")
    assert "pace of shot `half` is 0.9818 of the limits, at most 0.75 of the limits" in found.message
    assert "it uses `speed` most; the shot's `pace` is 0.75" in found.notes


@pytest.mark.parametrize(("pace", "holds"), [(1.0, True), (0.982, True), (0.981, False)])
def test_the_pace_is_kept_to_a_millionth(pace: float, holds: bool) -> None:
    found = claim(paced(pace=pace), CONSTRAINT)
    assert (found.limit, found.holds, found.method) == (pace, holds, "bounded")


@pytest.mark.parametrize(("pace", "holds"), [(0.79, True), (0.78, False)])
def test_beside_another_drone_a_shot_may_use_a_quarter_more(pace: float, holds: bool) -> None:
    found = claim(paced(pace=pace, beside=True), CONSTRAINT)
    assert (found.limit, found.holds) == (1.25 * pace, holds)
    assert most_share(0.9) == 1.0


def test_a_shot_with_times_has_no_pace() -> None:
    keyframes = PLAN.keyframes.shots[0].keyframes
    timed = (*keyframes[:-1], replace(keyframes[-1], time=30.0))
    for free in (paced(timing=Timing(duration=30.0), pace=0.1), paced(placed=timed, pace=0.1)):
        assert CONSTRAINT not in {c.constraint for c in verdict_on(free).certificate}
        assert "V065" not in codes(free)


@pytest.mark.parametrize(("hold", "judged"), [(0.0, False), (1.0, True)])
def test_after_a_keyframe_with_a_time_the_pace_holds_from_the_next_rest(hold: float, judged: bool) -> None:
    keyframes = list(PLAN.keyframes.shots[0].keyframes)
    keyframes[1] = replace(keyframes[1], time=10.0)
    keyframes[2] = replace(keyframes[2], hold=hold)
    free = paced(placed=tuple(keyframes), pace=0.75)
    assert (CONSTRAINT in {c.constraint for c in verdict_on(free).certificate}) is judged
