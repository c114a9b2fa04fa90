"""Every motion counts between two samples: at both of them all is well and at rest, in the middle it is not.

Each case moves one thing alone, so that a bound which leaves out its rate would close the time at once.
"""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.geom.shapes import BoxShape, CylinderShape
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Reference
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.close import errors_close, margins_close, rates
from shotc.passes.verify.sight import CameraAndBody, infimum
from tests.support.records import replace
from tests.support.sight_plans import EYE, LENGTH, at, film, mission, still, through, unfilmed

ENDS = np.array([0.0, 1.0])
POST = (20.0, 4.0, 10.0)
ASIDE = -0.2
"""Where the post stands on screen, half frames: it is a fifth of its distance to the left."""

SWAYS = {
    "yaw": {CAM_YAW: -0.9},
    "pitch": {CAM_PITCH: 0.9},
    "zoom": {HFOV: radians(-82)},
    "closing in": {0: 18.0},
    "aside": {1: -30.0},
    "above": {2: 30.0},
}


def swayed(moves: dict[int, float]) -> Piecewise:
    """Stand, move some channels there and back within the first second, and stand."""
    there = EYE.copy()
    for channel, by in moves.items():
        there[channel] += by
    return through([0.0, 0.5, 1.0, LENGTH], [EYE, there, EYE, EYE])


def flight(
    curve: Piecewise, track: Track | None = None, aside: float = 0.0, off: float = 0.0
) -> JudgedFlight:
    """A camera that films a post at one sample a second; what is wanted of it moves aside and back."""
    post = Target("post", POST, CylinderShape(1.0, 2.0), ("targets", "post"), track)
    of: MissionIR = replace(mission(rate=1.0), targets=(post,))
    zero = np.zeros((4, 2))
    wanted = np.array([[ASIDE + off, 0.0], [ASIDE + off + aside, 0.0], *[[ASIDE + off, 0.0]] * 2])
    reference = quintic_hermite(np.array([0.0, 0.5, 1.0, LENGTH]), wanted, zero, zero)
    flown = film("eye", curve)
    framed = (Reference("eyes", "post", 0.0, LENGTH, reference),)
    track_ = DroneTrajectory("eye", flown.curve, flown.phases, (), framed)
    return JudgedFlight(of, of.drone("eye"), track_)


def nodding(rate: float, channel: int = CAM_PITCH) -> Piecewise:
    """Stand, and turn down (or zoom in) and back evenly within the first second, as no motor could."""
    ends = np.repeat(EYE[None], 4, axis=0)
    ends[1, channel] -= 0.5 * rate
    ctrl = np.linspace(ends[:-1], ends[1:], 6, axis=1)
    return Piecewise(np.array([0.0, 0.5, 1.0, LENGTH]), ctrl)


def going(by: tuple[float, float, float]) -> Track:
    far = tuple(a + b for a, b in zip(POST, by, strict=True))
    return Track((0.0, 0.5, 1.0), (POST, (far[0], far[1], far[2]), POST))


def test_what_stands_is_closed() -> None:
    assert margins_close(flight(still(EYE)), "post", ENDS)
    assert errors_close(flight(still(EYE)), "eyes", "post", ENDS, 0.01)


@pytest.mark.parametrize("sway", SWAYS)
def test_a_target_that_leaves_the_frame_between_samples_is_not_closed(sway: str) -> None:
    assert not margins_close(flight(swayed(SWAYS[sway])), "post", ENDS)


@pytest.mark.parametrize("by", [(0.0, 40.0, 0.0), (0.0, 0.0, 40.0), (-30.0, 0.0, 0.0)])
def test_a_target_that_runs_out_of_the_frame_and_back_is_not_closed(by: tuple[float, float, float]) -> None:
    assert not margins_close(flight(still(EYE), going(by)), "post", ENDS)
    assert not errors_close(flight(still(EYE), going(by)), "eyes", "post", ENDS, 0.3)


@pytest.mark.parametrize(("turned", "closes"), [(0.0, True), (0.01, True), (pi / 2, False)])
def test_a_box_that_turns_out_of_the_frame_and_back_is_not_closed(turned: float, closes: bool) -> None:
    # Seen from behind it is 1 m wide, from its side 180 m.
    far = (100.0, *POST[1:])
    track = Track((0.0, 0.5, 1.0, LENGTH), (far,) * 4, (0.0, turned, 0.0, 0.0))
    lorry = Target("post", far, BoxShape(180.0, 1.0, 2.0, (1.0, 0.0)), ("targets", "post"), track)
    of = flight(still(EYE))
    of = replace(of, mission=replace(of.mission, targets=(lorry,)))
    assert margins_close(of, "post", ENDS) is closes


@pytest.mark.parametrize("sway", SWAYS)
def test_a_target_that_leaves_its_place_between_samples_is_not_closed(sway: str) -> None:
    assert not errors_close(flight(swayed(SWAYS[sway])), "eyes", "post", ENDS, 0.3)


def test_what_is_wanted_moves_between_samples_too() -> None:
    assert not errors_close(flight(still(EYE), aside=0.5), "eyes", "post", ENDS, 0.3)


@pytest.mark.parametrize(("aside", "closes"), [(0.03, True), (0.1, False)])
def test_an_error_near_its_limit_at_both_samples_leaves_little_for_what_is_between(
    aside: float, closes: bool
) -> None:
    of = flight(still(EYE), aside=aside, off=0.25)
    assert errors_close(of, "eyes", "post", ENDS, 0.3) is closes


def test_a_tall_target_moves_in_the_frame_as_fast_as_its_end_does() -> None:
    # Its top is 25 m away, its middle 20 m: at 0.3 rad/s it goes farther than its middle would.
    of = flight(nodding(0.3))
    tall = Target("post", (20.0, 0.0, 10.0), CylinderShape(0.1, 30.0), ("targets", "post"))
    of = replace(of, mission=replace(of.mission, targets=(tall,)))
    assert not margins_close(of, "post", ENDS)


@pytest.mark.parametrize(("limit", "closed"), [(0.15, False), (0.5, True)])
def test_up_and_down_count_as_much_as_the_frame_is_wide(limit: float, closed: bool) -> None:
    # In a frame twice as wide as high a tilt of 0.1 rad is 0.2 of half its height.
    of = flight(nodding(0.2))
    ahead = Target("post", (20.0, 0.0, 10.0), CylinderShape(0.1, 0.2), ("targets", "post"))
    wide = replace(mission(rate=1.0, aspect=2.0), targets=(ahead,))
    middle = Piecewise(np.array([0.0, LENGTH]), np.zeros((1, 6, 2)))
    track = replace(of.track, framing=(Reference("eyes", "post", 0.0, LENGTH, middle),))
    of = replace(of, mission=wide, drone=wide.drone("eye"), track=track)
    assert errors_close(of, "eyes", "post", ENDS, limit) is closed


@pytest.mark.parametrize(("limit", "closed"), [(0.1, False), (0.3, True)])
def test_a_wide_lens_moves_the_picture_faster_than_a_narrow_one(limit: float, closed: bool) -> None:
    # At 90 deg what stands four fifths to the side moves twice as fast as near the axis of a long lens.
    of = flight(nodding(0.3, HFOV))
    side = Target("post", (20.0, -16.0, 10.0), CylinderShape(0.1, 0.2), ("targets", "post"))
    there = Piecewise(np.array([0.0, LENGTH]), np.tile([0.8, 0.0], (1, 6, 1)))
    track = replace(of.track, framing=(Reference("eyes", "post", 0.0, LENGTH, there),))
    of = replace(of, mission=replace(of.mission, targets=(side,)), track=track)
    assert errors_close(of, "eyes", "post", ENDS, limit) is closed


@pytest.mark.parametrize("sway", SWAYS)
def test_rates_are_those_of_the_flight(sway: str) -> None:
    of = flight(swayed(SWAYS[sway]), going((1.0, -2.0, 3.0)))
    t = np.linspace(0.0, 1.0, 20_001)
    rate, place = of.track.curve.derivative()(t), of.track.curve(t)
    target = of.mission.targets[0]
    centres = np.array([target.at(float(x)) for x in t])
    velocity = np.diff(centres, axis=0) / np.diff(t)[:, None]
    found = rates(of, "post", 0.0, 1.0)
    for bound, value in (
        (found.speed, np.linalg.norm(rate[1:, :3] - velocity, axis=1).max()),
        (found.far, np.linalg.norm(place[:, :3] - centres, axis=1).max()),
        (found.turn, np.abs(rate[:, CAM_YAW]).max() + np.abs(rate[:, CAM_PITCH]).max()),
        (found.zoom, np.abs(rate[:, HFOV]).max()),
        (found.wide, np.tan(place[:, HFOV] / 2).max()),
        (-found.narrow, -np.tan(place[:, HFOV] / 2).min()),
    ):
        assert value - 1e-2 <= bound <= value + 0.06 * abs(value) + 1e-2


BIRD = at(20.0, 60.0, 10.0)
FAR = at(2000.0, 1500.0, 10.0)
PASSES = {
    "far bird": (still(EYE), through([0, 0.5, 1, LENGTH], [FAR, at(2000, 1200, 10), FAR, FAR])),
    "bird": (still(EYE), through([0, 0.5, 1, LENGTH], [BIRD, at(20, 25, 10), BIRD, BIRD])),
    "eye": (swayed({0: -30.0}), still(BIRD)),
    "yaw": (swayed({CAM_YAW: 0.4}), still(BIRD)),
    "pitch": (swayed({CAM_PITCH: 0.4}), still(at(20.0, 0.0, 60.0))),
    "zoom": (swayed({HFOV: radians(40)}), still(BIRD)),
}


CASES = [(name, None) for name in PASSES] + [(name, radians(30)) for name in PASSES if name != "zoom"]
"""Who moves, and the angle to be kept free, which does not change with the lens."""


@pytest.mark.parametrize(("name", "half_angle"), CASES)
def test_a_drone_that_comes_nearer_to_a_picture_between_samples_is_seen(
    name: str, half_angle: float | None
) -> None:
    eye, bird = PASSES[name]
    sight = CameraAndBody(mission(half_angle=half_angle), film("eye", eye), unfilmed("bird", bird))
    dense = sight.out(np.linspace(0.0, 1.0, 20_001)).min()
    assert dense < sight.out(ENDS).min() - 0.05
    found = infimum(sight, ENDS, half_angle or 0.0)
    assert found.proven <= dense + 1e-9
