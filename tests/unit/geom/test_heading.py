"""The angle between a heading and a course, bounded at every instant."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise, bernstein_basis, quintic_hermite
from shotc.geom.heading import _bounds, _GroundMotion, sup_off_course
from shotc.geom.pieces import Pieces, pieces
from shotc.geom.vec import wrapped

SLOW = 0.3
GAP = 1e-4


def sampled(curve: Piecewise, count: int = 40_001) -> float:
    """Return the largest angle at samples, by the definition alone."""
    t = np.linspace(curve.start, curve.end, count)
    v = curve.derivative()(t)[:, :2]
    off = np.abs(wrapped(curve(t)[:, 2] - np.arctan2(v[:, 1], v[:, 0])))
    return float(off[np.linalg.norm(v, axis=1) > SLOW].max(initial=-inf))


def straight(heading: Array) -> Piecewise:
    """A motion to the East at 2 m/s for 3 s, with the control points of a heading."""
    x = np.linspace(0.0, 6.0, 6)
    return Piecewise(np.array([0.0, 3.0]), np.column_stack([x, np.zeros(6), heading])[None])


@pytest.mark.parametrize("seed", range(12))
def test_the_bound_is_no_less_than_any_sample_and_as_near_as_is_asked(seed: int) -> None:
    rng = np.random.default_rng(seed)
    breaks = np.cumsum(rng.uniform(0.3, 2.0, 5))
    ctrl = np.cumsum(rng.normal(0.0, 1.0, (4, 6, 3)), axis=1)
    ctrl[:, :, 0] += np.linspace(0.0, 4.0, 6)
    curve = Piecewise(breaks, ctrl)
    bound = sup_off_course(pieces(curve), SLOW, lambda _: GAP)
    most = sampled(curve)
    assert bound.proven >= most
    assert bound.proven <= max(bound.attained + GAP, most + 0.01)


def test_a_heading_that_turns_along_a_straight_way_is_known_exactly() -> None:
    # 0.6 x (1 - x) of 4: largest, 0.6, in the middle; whole turns do not count.
    bump = np.array([0.0, 0.48, 0.72, 0.72, 0.48, 0.0])
    for turns in (0.0, -2 * np.pi, 6 * np.pi):
        bound = sup_off_course(pieces(straight(bump + turns)), SLOW, lambda _: 1e-7)
        assert bound.proven == pytest.approx(0.6, abs=1e-6)
        assert bound.at == pytest.approx(1.5, abs=1e-2)


def test_who_flies_backwards_is_half_a_turn_off() -> None:
    bound = sup_off_course(pieces(straight(np.full(6, np.pi))), SLOW, lambda _: GAP)
    assert bound.proven == pytest.approx(np.pi)


def test_who_turns_on_the_spot_has_no_course() -> None:
    spot = Piecewise(np.array([0.0, 3.0]), np.column_stack([np.zeros((6, 2)), np.linspace(0, 9, 6)])[None])
    assert sup_off_course(pieces(spot), SLOW, lambda _: GAP).proven == -inf


@pytest.mark.parametrize("spread", [0.1, 0.5, 2.0])
def test_the_bound_on_each_piece_holds(spread: float) -> None:
    """Of 400 pieces, most of which speed up by far, with a heading near the course."""
    rng = np.random.default_rng(11)
    steps = rng.normal(0.0, spread, (400, 5, 3)) + np.array([1.0, 0.0, 0.0]) * rng.uniform(
        0.2, 3.0, (400, 5, 1)
    )
    ctrl = np.concatenate([np.zeros((400, 1, 3)), np.cumsum(steps, axis=1)], axis=1)
    flown = Pieces(np.zeros(400), rng.uniform(0.2, 2.0, 400), ctrl)
    basis = bernstein_basis(5, np.linspace(0.0, 1.0, 65))
    velocity, heading = flown.channels(0, 1).derivative(), flown.channels(2)
    v = np.einsum("tk,mkd->mtd", bernstein_basis(4, np.linspace(0.0, 1.0, 65)), velocity.ctrl)
    turned = np.einsum("tk,mk->mt", basis, heading.ctrl[:, :, 0])
    off = np.abs(wrapped(turned - np.arctan2(v[..., 1], v[..., 0])))
    upper, middle = _bounds(_GroundMotion(velocity, velocity.derivative(), heading, heading.derivative()))
    assert (upper >= off.max(axis=1) - 1e-9).all()
    assert middle == pytest.approx(off[:, 32], abs=1e-9)


@pytest.mark.parametrize("faster", [3.0, -3.0])
@pytest.mark.parametrize("early", [False, True])
def test_the_bound_holds_where_a_heading_leaves_the_course_of_a_curve(faster: float, early: bool) -> None:
    """On 11 degrees of a circle, with the course at one end; there the bound by rates is the nearer one."""
    half = 0.1
    ends = np.array([-half, half])
    out = np.column_stack([np.sin(ends), 1 - np.cos(ends)])
    on, back = np.column_stack([np.cos(ends), np.sin(ends)]), np.column_stack([-np.sin(ends), np.cos(ends)])
    circle = pieces(quintic_hermite(ends, 10.0 * out, 10.0 * on, 10.0 * back))
    t, begin = np.linspace(-1.0, 1.0, 6) * half, half if early else -half
    # The control points of x^2 are those of a parabola: its blossom at two of its five places.
    square = half**2 * np.array([1.0, 0.2, -0.2, -0.2, 0.2, 1.0])
    heading = t + faster * (square - 2.0 * begin * t + begin**2)
    flown = Pieces(circle.low, circle.high, np.concatenate([circle.ctrl, heading[None, :, None]], axis=2))
    velocity, turning = flown.channels(0, 1).derivative(), flown.channels(2)
    upper, _ = _bounds(_GroundMotion(velocity, velocity.derivative(), turning, turning.derivative()))
    most = abs(faster) * (2.0 * half) ** 2
    assert most - 1e-6 <= upper[0] <= 1.6 * most


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_bound_holds_where_a_course_turns_ever_faster_away_from_a_heading(side: float) -> None:
    """On y = t^3 / 10 the course is atan(0.3 t^2); the heading stays East."""
    cube = side * 0.1 * np.array([0.0, 0.0, 0.0, 0.1, 0.4, 1.0])
    ctrl = np.column_stack([np.linspace(0.0, 1.0, 6), cube, np.zeros(6)])[None]
    flown = Pieces(np.zeros(1), np.ones(1), ctrl)
    velocity, heading = flown.channels(0, 1).derivative(), flown.channels(2)
    upper, middle = _bounds(_GroundMotion(velocity, velocity.derivative(), heading, heading.derivative()))
    assert np.arctan(0.3) <= upper[0] <= 1.5 * np.arctan(0.3)
    assert middle == pytest.approx([np.arctan(0.075)])
