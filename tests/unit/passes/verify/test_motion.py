"""Every limit of a drone, its gimbal and its lens on both sides, for motions along one cubic."""

from __future__ import annotations

from math import atan2, hypot, inf, pi, radians

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import SAME_LENS_RAD, LensRange
from shotc.ir.limits import G_M_S2
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV, X, Y, Z
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.motion import motion
from tests.support.plain_flights import plain_mission
from tests.support.records import replace

LENGTH_S = 4.0
SPARE = 1e-4
"""Relative distance of each limit from its boundary."""

RATE, ACCELERATION, JERK = 1.5 / LENGTH_S, 6.0 / LENGTH_S**2, 12.0 / LENGTH_S**3
"""The extremes of the derivatives of 3 x^2 - 2 x^3, where x is the share of the time."""


def eased(start: dict[int, float], by: dict[int, float]) -> Piecewise:
    """Return a flight whose channels go from a start by some amounts, along 3 x^2 - 2 x^3."""
    ctrl = np.zeros((1, 4, 7))
    ctrl[..., HFOV] = 1.2
    for channel, value in start.items():
        ctrl[..., channel] = value
    for channel, amount in by.items():
        ctrl[:, 2:, channel] += amount
    return Piecewise(np.array([0.0, LENGTH_S]), ctrl)


def claims(
    by: dict[int, float], start: dict[int, float] | None = None, **changes: object
) -> dict[str, Claim]:
    """Return the claims on a motion; changes : of the drone, its limits and its gimbal."""
    mission = plain_mission()
    drone = mission.drones[0]
    parts = {
        name: replace(part, **{k: v for k, v in changes.items() if k in part._fields})
        for name, part in (("limits", drone.limits), ("gimbal", drone.gimbal))
    }
    own = {k: v for k, v in changes.items() if k in drone._fields}
    drone = replace(drone, **parts, **own)
    track = DroneTrajectory(drone.name, eased(start or {}, by), (), (), ())
    found = list(motion(JudgedFlight(mission, drone, track)))
    assert len({c.constraint for c in found}) == len(found)
    return {c.constraint: c for c in found}


BOUNDS = {
    "speed": ("speed", {X: 3.0, Y: -4.0, Z: 30.0}, 5.0 * RATE, 2.0),
    "climb": ("climb", {X: 30.0, Z: 5.0}, 5.0 * RATE, 2.0),
    "descent": ("descent", {X: 30.0, Z: -5.0}, 5.0 * RATE, 2.0),
    "acceleration": ("acceleration", {X: 2.0, Y: -3.0, Z: 6.0}, 7.0 * ACCELERATION, None),
    "jerk": ("jerk", {X: 2.0, Y: -3.0, Z: -6.0}, 7.0 * JERK, None),
    "body yaw rate": ("yaw_rate", {BODY_YAW: -2.0}, 2.0 * RATE, 2.0),
    "body yaw acceleration": ("yaw_acceleration", {BODY_YAW: -2.0}, 2.0 * ACCELERATION, None),
    "gimbal pitch rate": ("rate", {CAM_PITCH: -1.0}, RATE, 2.0),
    "gimbal pitch acceleration": ("acceleration", {CAM_PITCH: -1.0}, ACCELERATION, None),
    "gimbal yaw rate": ("rate", {CAM_YAW: 0.5, BODY_YAW: -0.5}, RATE, 2.0),
    "gimbal yaw acceleration": ("acceleration", {CAM_YAW: 0.5, BODY_YAW: -0.5}, ACCELERATION, None),
}


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
@pytest.mark.parametrize("name", BOUNDS)
def test_a_limit_bounds_the_fastest_instant(name: str, spare: float) -> None:
    key, by, worst, time = BOUNDS[name]
    claim = claims(by, **{key: worst * (1.0 + spare)})[name]
    assert claim.worst == pytest.approx(worst, rel=1e-6)
    assert (claim.upper, claim.holds) == (True, spare > 0)
    assert claim.limit == pytest.approx(worst * (1.0 + spare))
    assert claim.path[-1] == key
    assert time is None or claim.time == pytest.approx(time, abs=0.05)


def test_a_camera_that_turns_with_its_body_does_not_turn_its_gimbal() -> None:
    found = claims({CAM_YAW: 2.0, BODY_YAW: 2.0})
    assert found["gimbal yaw rate"].worst == found["gimbal yaw acceleration"].worst == 0.0
    assert found["gimbal yaw max"].worst == found["gimbal yaw min"].worst == 0.0


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
def test_in_a_wind_the_speed_through_the_air_counts(spare: float) -> None:
    """At the fastest instant it is (3 R - 2, -4 R + 1), and at both ends (-2, 1)."""
    worst = hypot(3.0 * 8.0 * RATE - 2.0, -4.0 * 8.0 * RATE + 1.0)
    by = {X: 24.0, Y: -32.0}
    found = claims(by, wind=(2.0, -1.0), speed=worst + spare)
    assert "speed" not in found
    assert found["airspeed"].worst == pytest.approx(worst, rel=1e-6)
    assert found["airspeed"].holds == (spare > 0)
    for wind in ((2.0, -1.0), (2.0, 0.0), (0.0, -1.0)):
        assert claims({}, wind=wind)["airspeed"].worst == pytest.approx(hypot(*wind))


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
def test_tilt_and_thrust_are_those_of_the_acceleration(spare: float) -> None:
    """At the start a = (3 A, -4 A, 2 A), at the end its opposite, where the weight is lighter."""
    by = {X: 3.0, Y: -4.0, Z: 2.0}
    tilt = atan2(5.0 * ACCELERATION, G_M_S2 - 2.0 * ACCELERATION)
    thrust = hypot(5.0 * ACCELERATION, G_M_S2 + 2.0 * ACCELERATION) / G_M_S2
    found = claims(by, tilt=tilt + spare, thrust_to_weight=thrust + spare)
    for name, worst, time in (("tilt", tilt, LENGTH_S), ("thrust to weight", thrust, 0.0)):
        assert found[name].worst == pytest.approx(worst, rel=1e-6)
        assert (found[name].holds, found[name].time) == (spare > 0, time)
    assert not {"tilt", "thrust to weight"} & set(claims(by, tilt=inf, thrust_to_weight=inf))


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
@pytest.mark.parametrize(
    ("axis", "start", "by"),
    [("pitch", {CAM_PITCH: -0.4}, {CAM_PITCH: 0.9}), ("yaw", {CAM_YAW: -0.2, BODY_YAW: 0.2}, {CAM_YAW: 0.9})],
)
def test_the_gimbal_stays_in_its_range(
    axis: str, start: dict[int, float], by: dict[int, float], spare: float
) -> None:
    found = claims(by, start, **{axis: (-0.4 - spare, 0.5 + spare)})
    low, high = found[f"gimbal {axis} min"], found[f"gimbal {axis} max"]
    assert (low.worst, high.worst) == pytest.approx((-0.4, 0.5))
    assert (low.upper, high.upper) == (False, True)
    assert low.holds == high.holds == (spare > 0)
    assert (low.time, high.time) == (0.0, LENGTH_S)


@pytest.mark.parametrize("turns", [-3, -1, 0, 2])
@pytest.mark.parametrize("middle", [0.0, 2.5, -3.0])
def test_whole_turns_of_a_camera_against_its_body_are_none(turns: int, middle: float) -> None:
    start = {CAM_YAW: middle + 0.3 + 2 * pi * turns}
    found = claims({CAM_YAW: 0.5}, start, yaw=(middle - 1.0, middle + 1.0))
    assert found["gimbal yaw min"].worst == pytest.approx(middle + 0.3)
    assert found["gimbal yaw max"].worst == pytest.approx(middle + 0.8)
    around = claims({CAM_YAW: 2 * pi}, start, yaw=(middle - 1.0, middle + 1.0))
    assert not around["gimbal yaw max"].holds


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
def test_a_lens_stays_in_its_range_and_at_its_rate(spare: float) -> None:
    lens = LensRange(0.5 - spare + SAME_LENS_RAD, 1.1 + spare - SAME_LENS_RAD, 0.6 * RATE + spare)
    found = claims({HFOV: -0.6}, {HFOV: 1.1}, lens=lens)
    low, high, rate = (found[name] for name in ("field of view min", "field of view max", "zoom rate"))
    assert (low.worst, high.worst, rate.worst) == pytest.approx((0.5, 1.1, 0.6 * RATE))
    assert low.holds == high.holds == rate.holds == (spare > 0)
    assert (low.path[-1], rate.path[-1]) == ("zoom", "zoom_rate")
    fixed = claims({}, {HFOV: 1.1}, lens=LensRange(1.1, 1.1, 0.0))
    assert "zoom rate" not in fixed
    assert fixed["field of view max"].holds


@pytest.mark.parametrize("spare", [SPARE, -SPARE])
def test_a_lens_without_data_is_a_pinhole(spare: float) -> None:
    found = claims({HFOV: radians(169.0) - 2 * spare}, {HFOV: radians(1.0) + spare}, lens=None)
    assert found["field of view min"].holds == found["field of view max"].holds == (spare > 0)
    assert "zoom rate" not in found


def test_turns_of_a_camera_count_from_its_first_instant() -> None:
    mission = plain_mission()
    ctrl = np.full((1, 2, 7), 1.2)
    ctrl[0, :, CAM_YAW] = 1.3, 21.3  # at once at full rate, three turns
    track = DroneTrajectory("cam1", Piecewise(np.array([0.0, LENGTH_S]), ctrl), (), (), ())
    found = {c.constraint: c.worst for c in motion(JudgedFlight(mission, mission.drones[0], track))}
    assert (found["gimbal yaw min"], found["gimbal yaw max"]) == pytest.approx((0.1, 20.1))
