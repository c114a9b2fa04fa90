"""Drones in each other's pictures: geometry by hand, both directions, between samples, and what is told."""

from __future__ import annotations

from math import asin, atan2, pi, radians, sqrt
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.passes.verify import sight
from shotc.passes.verify.sight import CameraAndBody, infimum
from tests.support.sight_plans import EYE, LENGTH, at, claims, film, mission, still, through, unfilmed

R = 0.5  # of the body
ROOT = sqrt(2.0)


@pytest.mark.parametrize(
    ("place", "out"),
    [
        ((20.0, 0.0, 10.0), -20.0 / ROOT - R),  # in the middle
        ((20.0, 20.0, 10.0), -R),  # its centre on the left edge
        ((20.0, 20.0 + ROOT * R, 10.0), 0.0),  # touches it from outside
        ((20.0, -20.0 - ROOT * R, 10.0), 0.0),  # and the right one
        ((20.0, 0.0, 30.0 + ROOT), ROOT / ROOT - R),  # above
        ((20.0, 0.0, -10.0 - ROOT), ROOT / ROOT - R),  # below
        ((-3.0, 0.0, 10.0), 3.0 - R),  # behind
        ((-0.4, 0.0, 10.0), 0.4 - R),  # behind, but its body reaches forward
        ((0.0, 5.0, 10.0), 5.0 / ROOT - R),  # beside
    ],
)
def test_metres_out_of_the_frame(place: tuple[float, float, float], out: float) -> None:
    (found,) = claims(mission(), film("eye", still(EYE)), unfilmed("bird", still(at(*place))))
    assert (found.subject, found.shot, found.constraint) == ("eye", "eyes", "bird out of the picture")
    assert (found.limit, found.unit, found.upper, found.hard) == (0.0, "m", False, True)
    assert found.worst == pytest.approx(out, abs=1e-9)
    assert found.holds is (out >= -1e-6)
    assert found.method == "bounded"
    assert found.position == pytest.approx(tuple(EYE[:3]))


def test_a_wide_frame_is_less_high() -> None:
    level = mission(aspect=2.0)
    above = unfilmed("bird", still(at(20.0, 0.0, 21.0)))
    (found,) = claims(level, film("eye", still(EYE)), above)
    assert found.worst == pytest.approx((11.0 - 10.0) / sqrt(1.25) - R)


@pytest.mark.parametrize(
    ("place", "angle"),
    [
        ((20.0, 10.0, 10.0), atan2(1, 2) - asin(R / sqrt(500))),
        ((20.0, 0.0, 10.0), -asin(R / 20)),
        ((-5.0, 0.0, 10.0), pi - asin(R / 5)),
        ((0.3, 0.0, 10.0), -pi / 2),  # the camera is within the body
    ],
)
def test_radians_off_the_axis(place: tuple[float, float, float], angle: float) -> None:
    cone = mission(half_angle=radians(25))
    (found,) = claims(cone, film("eye", still(EYE)), unfilmed("bird", still(at(*place))))
    assert (found.limit, found.unit) == (radians(25), "rad")
    assert found.path == ("rules", "mutual_visibility", "half_angle")
    assert found.worst == pytest.approx(angle)
    assert found.holds is (angle >= radians(25))


def test_both_directions_are_claims_of_their_own() -> None:
    # One looks at the other, which looks away.
    both = claims(mission(), film("eye", still(EYE)), film("bird", still(at(20.0, 0.0, 10.0))))
    assert [(c.subject, c.constraint, c.holds) for c in both] == [
        ("eye", "bird out of the picture", False),
        ("bird", "eye out of the picture", True),
    ]
    assert both[1].worst == pytest.approx(20.0 - 0.6, rel=0.011)


@pytest.mark.parametrize("when", [1.0, 4.0, 6.0])
def test_a_shot_of_one_frame_is_judged_at_that_frame(when: float) -> None:
    crossing = through([0.0, 4.0, LENGTH], [at(20, 40, 10), at(20, 10, 10), at(20, -40, 10)])
    pair = CameraAndBody(mission(), film("eye", still(EYE)), unfilmed("bird", crossing))
    found = infimum(pair, np.array([when]), 0.0)
    assert (found.at, found.proven, found.attained) == (when, *[float(pair.out(np.array([when]))[0])] * 2)


def test_only_the_time_of_the_shot_counts() -> None:
    crossing = through([0.0, 4.0, LENGTH], [at(20, 40, 10), at(20, -40, 10), at(20, -40, 10)])
    early, late = (film("eye", still(EYE), span) for span in ((0.0, 4.0), (4.0, LENGTH)))
    assert not claims(mission(), early, unfilmed("bird", crossing))[0].holds
    assert claims(mission(), late, unfilmed("bird", crossing))[0].holds


@pytest.mark.parametrize("span", [(0.0, 3.0), (7.0, LENGTH)])
def test_a_drone_on_its_pad_is_in_the_picture(span: tuple[float, float]) -> None:
    # It stands in the picture, flies up and back, and lands long before the camera is done.
    pad, up = at(20, 0, 8), at(20, 0, 60)
    hop = through([0.0, 3.0, 5.0, 6.9], [pad, pad, up, pad])
    (found,) = claims(mission(), film("eye", still(EYE), span), unfilmed("bird", hop))
    assert not found.holds


@pytest.mark.parametrize("half_angle", [None, radians(30)])
def test_a_drone_that_crosses_between_two_samples_is_found(half_angle: float | None) -> None:
    dash = through(
        [0.0, 4.2, 4.8, LENGTH], [at(20, 60, 10), at(20, 60, 10), at(20, -60, 10), at(20, -60, 10)]
    )
    slow = mission(rate=1.0, half_angle=half_angle)
    eye, bird = film("eye", still(EYE)), unfilmed("bird", dash)
    limit = half_angle or 0.0
    sampled = CameraAndBody(slow, eye, bird).out(np.arange(11.0))
    assert sampled.min() > limit  # at whole seconds it is far out
    (found,) = claims(slow, eye, bird)
    assert not found.holds
    assert found.time == pytest.approx(4.5, abs=0.02)
    middle = -20 / ROOT - R if half_angle is None else -asin(R / 20)
    assert found.worst == pytest.approx(middle, abs=0.02 * abs(middle - limit))


@pytest.mark.parametrize("axis", [CAM_YAW, CAM_PITCH])
def test_a_camera_that_turns_past_a_drone_between_two_samples_sees_it(axis: int) -> None:
    # It turns steadily, from 69 degrees on one side of the bird to as many on the other within a second.
    first, last = EYE.copy(), EYE.copy()
    first[axis], last[axis] = (2.4 * (t - 4.5) for t in (0.0, LENGTH))
    steady = Piecewise(np.array([0.0, LENGTH]), np.linspace(first, last, 6)[None])
    eye, bird = film("eye", steady, (4.0, 5.0)), unfilmed("bird", still(at(20.0, 0.0, 10.0)))
    slow = mission(rate=1.0)
    assert CameraAndBody(slow, eye, bird).out(np.array([4.0, 5.0])).min() > 5.0
    (found,) = claims(slow, eye, bird)
    assert not found.holds
    assert found.worst == pytest.approx(-20 / ROOT - R, rel=0.02)


def test_what_holds_is_proved_between_samples() -> None:
    # A bird that circles close above the frame.
    t = np.linspace(0.0, LENGTH, 41)
    ring = [at(20 + 2 * np.cos(x), 2 * np.sin(x), 33) for x in t]
    slow = mission(rate=1.0)
    (found,) = claims(slow, film("eye", still(EYE)), unfilmed("bird", through(list(t), ring)))
    assert found.holds
    assert found.method == "bounded"
    dense = CameraAndBody(slow, film("eye", still(EYE)), unfilmed("bird", through(list(t), ring)))
    least = float(dense.out(np.linspace(0, LENGTH, 100_001)).min())
    assert least * 0.98 <= found.worst <= least


@pytest.mark.slow
@pytest.mark.parametrize("visibility", ["require", "prefer"])
def test_a_claim_that_is_broken_tells_a_proved_bound_too(visibility: str) -> None:
    """What is called bounded is nowhere worse, whether it holds or not."""
    weave = through([0.0, 3.3, 6.1, LENGTH], [at(20, 30, 10), at(24, -3, 12), at(18, 5, 7), at(20, -30, 10)])
    eye, bird = film("eye", still(EYE)), unfilmed("bird", weave)
    (found,) = claims(mission(rate=2.0, visibility=visibility), eye, bird)
    dense = float(CameraAndBody(mission(), eye, bird).out(np.linspace(0.0, LENGTH, 200_001)).min())
    assert not found.holds
    assert found.method == "bounded"
    assert dense - 0.002 * abs(dense) <= found.worst <= dense


@pytest.mark.slow
def test_what_is_proved_is_below_and_what_is_attained_is_met() -> None:
    spin = through([0.0, LENGTH], [EYE, EYE + np.array([0, 0, 5, 2.0, -0.4, 0, -0.3])])
    sight = CameraAndBody(mission(), film("eye", spin), unfilmed("bird", still(at(-3.0, 25.0, 12.0))))
    found = infimum(sight, np.linspace(0.0, LENGTH, 7), 0.0)
    dense = sight.out(np.linspace(0.0, LENGTH, 200_001)).min()
    assert found.proven <= dense <= found.attained + 1e-9
    assert found.attained == pytest.approx(float(sight.out(np.array([found.at]))[0]))


def test_strengths() -> None:
    seen = (film("eye", still(EYE)), unfilmed("bird", still(at(20, 0, 10))))
    assert [c.hard for c in claims(mission(visibility="require"), *seen)] == [True]
    assert [c.hard for c in claims(mission(visibility="prefer"), *seen)] == [False]
    assert claims(mission(visibility="off"), *seen) == []


@pytest.mark.slow
def test_who_flies_close_and_fast_about_the_camera_is_still_proved() -> None:
    # Both circle: the value hardly changes, while every bound on its rate is large.
    t = np.linspace(0.0, LENGTH, 81)
    eye = [np.array([0, 0, 10, x, 0, x, radians(60)]) for x in t]
    bird = [at(8 * np.cos(x + 1.0), 8 * np.sin(x + 1.0), 10) for x in t]
    zero = np.zeros((len(t), 7))
    turning = zero + np.array([0, 0, 0, 1.0, 0, 1.0, 0])
    round_ = np.array([[-8 * np.sin(x + 1.0), 8 * np.cos(x + 1.0), 0, 0, 0, 0, 0] for x in t])
    inward = np.array([[-8 * np.cos(x + 1.0), -8 * np.sin(x + 1.0), 0, 0, 0, 0, 0] for x in t])
    spun = quintic_hermite(t, np.array(eye), turning, zero)
    flown = quintic_hermite(t, np.array(bird), round_, inward)
    for half_angle in (None, radians(30)):
        (found,) = claims(mission(half_angle=half_angle), film("eye", spun), unfilmed("bird", flown))
        value = 8 * np.sin(1.0 - radians(30)) - R if half_angle is None else 1.0 - asin(R / 8)
        assert found.method == "bounded"
        assert found.worst == pytest.approx(value, rel=0.02)


@pytest.mark.parametrize("whose", ["film", "other"])
@pytest.mark.parametrize("channel", range(7))
def test_each_acceleration_is_in_the_bound_that_it_belongs_to(whose: str, channel: int) -> None:
    t, push = np.array([0.0, 2.0]), np.zeros(7)
    push[channel] = 3.0
    moves = quintic_hermite(t, 0.5 * t[:, None] ** 2 * push, t[:, None] * push, np.ones((2, 1)) * push)
    stands = moves.__class__(t, np.zeros_like(moves.ctrl))
    curves = {"film": stands, "other": stands, whose: moves}
    pair = SimpleNamespace(**{name: SimpleNamespace(curve=curve) for name, curve in curves.items()})
    found = sight._fastest(cast("CameraAndBody", pair), 0.0, 2.0)
    kind = {0: "speed", 1: "speed", 2: "speed", CAM_YAW: "turn", CAM_PITCH: "turn", HFOV: "zoom"}.get(channel)
    counts = kind if whose == "film" or kind == "speed" else None
    bounds = {"speed": found.speed, "turn": found.turn, "zoom": found.zoom}
    assert bounds == {
        name: pytest.approx(3.0 if name == counts else 0.0, rel=0.06, abs=2e-3) for name in bounds
    }
