"""Moves on elliptic arcs: the theorem on random fleets, the shortest way by brute force."""

from __future__ import annotations

from math import acos, hypot, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import pdist

from shotc.geom.apart import ROUNDING_RATIO, stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import knots
from shotc.geom.separation import closest
from shotc.ir.limits import Limits
from shotc.ir.show import Apart
from shotc.show.geom.arcs import Gaps, sampled
from shotc.show.geom.lattice import lattice
from shotc.show.geom.least_size import least_size
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from shotc.show.solvers.match import matched

LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
gaps_of_balls = st.tuples(*[st.floats(1.0, 2.0)] * 2).map(lambda g: Gaps(*g))


def formation(rng: np.random.Generator, count: int, apart: Apart) -> Array:
    """Part of the densest lattice there is, turned about the vertical, as near as goals may be; metres."""
    side = 2.0 + 1.2 * count ** (1 / 3)
    size = np.full(3, side)
    points = lattice(-size, size, 1.0, apart.shape == "cylinder") * apart.across * ROUNDING_RATIO
    nearest = np.argsort(np.linalg.norm(points - rng.uniform(-1, 1, 3), axis=1))[:count]
    c, s = np.cos(a := rng.uniform(0, 2 * pi)), np.sin(a)
    turned = points[nearest] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turned / (1.0, 1.0, stretch(apart)))


def gauge(relative: Array, apart: Apart) -> Array:
    """How many times the separation places are apart, as the rule is written."""
    across, up = np.hypot(relative[..., 0], relative[..., 1]) / apart.across, relative[..., 2] / apart.upright
    return np.hypot(across, up) if apart.shape == "ellipsoid" else np.maximum(across, np.abs(up))


def flown(move: ArcMove, starts: Array, goals: Array) -> tuple[Array, Array]:
    coef = np.stack([starts, starts, starts, *move.between(starts, goals), goals, goals, goals], axis=1)
    return np.arange(coef.shape[1] - 2) * move.piece, coef


@pytest.mark.long
@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 60), st.sampled_from(["ellipsoid", "cylinder"]))
def test_fleets_as_dense_as_the_separation_allows_keep_it(seed: int, count: int, shape: str) -> None:
    rng = np.random.default_rng(seed)
    apart = Apart(shape, 1.5, 2.5, 0.0)  # type: ignore[arg-type]
    scale = np.array([1.0, 1.0, stretch(apart)])
    starts = formation(rng, count, apart)
    goals = formation(rng, count, apart) + rng.normal(size=3) * 20.0
    goals = goals[matched(starts * scale, goals * scale)]
    ends = [p * scale / apart.across for p in (starts, goals)]
    free = (
        least_size(*(p / 1.0005 for p in ends))
        if shape == "cylinder"
        else Gaps(*(float(pdist(p).min()) for p in ends))
    )
    pivot = rng.normal(size=3) * 10.0
    move = fastest_arc((starts, goals), pivot, free, LIMITS, 1.0)
    breaks, coef = flown(move, starts, goals)
    assert closest(breaks, coef, apart).proven >= apart.across * (1 - 1e-9)
    spline = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), 3)
    at = spline(np.linspace(0.0, breaks[-1], 300))
    for i in range(1, count):
        assert gauge(at[:, i:] - at[:, :-i], apart).min() >= 1 - 1e-9
    rate = spline.derivative()(np.linspace(0.0, breaks[-1], 300))
    assert np.hypot(rate[..., 0], rate[..., 1]).max() <= LIMITS.speed
    assert rate[..., 2].max() <= LIMITS.climb
    assert -rate[..., 2].min() <= LIMITS.descent
    for order, most in ((2, LIMITS.acceleration), (3, LIMITS.jerk)):
        assert np.linalg.norm(spline.derivative(order)(breaks[:-1] + 1e-9), axis=2).max() <= most


@pytest.mark.long
@given(gaps_of_balls)
def test_the_way_is_the_shortest_outside_the_circle(gaps: Gaps) -> None:
    """Against the shortest path through a fine polygon round the circle and both ends."""
    line = next(gaps.ways()) * np.array(gaps)
    length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    angles = np.linspace(0.0, pi / 2, 181)
    round_it = np.column_stack([np.cos(angles), np.sin(angles)]) / np.cos(angles[1] / 2)
    points = np.concatenate([[[gaps.before, 0.0]], round_it, [[0.0, gaps.after]]])
    apart = points[:, None] - points
    size = np.linalg.norm(apart, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        foot = np.clip((apart * points[:, None]).sum(2) / size**2, 0.0, 1.0)
        nearest = np.linalg.norm(points[:, None] - foot[..., None] * apart, axis=2)
    free = np.where(nearest >= 1.0 - 1e-9, size, 0.0)
    shortest = shortest_path(free, directed=False, indices=0)[-1]
    assert shortest * (1 - 1e-4) <= length <= shortest * (1 + 1e-6)
    assert np.linalg.norm(line, axis=1).min() >= min(1.0, hypot(*gaps) / 2) - 1e-6
    if not gaps.straight:
        closed = sum(sqrt(g * g - 1) for g in gaps) + pi / 2 - sum(acos(1 / g) for g in gaps)
        assert length == pytest.approx(closed, rel=1e-6)


@pytest.mark.slow
@given(gaps_of_balls)
def test_straight_ways_are_enough_exactly_where_they_stay_outside(gaps: Gaps) -> None:
    s = np.linspace(0.0, 1.0, 2001)
    least = float(np.hypot((1 - s) * gaps.before, s * gaps.after).min())
    if abs(least - 1.0) > 1e-5:
        assert gaps.straight == (least > 1.0)


@pytest.mark.slow
@given(st.integers(0, 2**31))
def test_splines_are_sampled_where_they_are(seed: int) -> None:
    ctrl = np.random.default_rng(seed).uniform(-1.0, 1.0, (9, 2))
    spline = BSpline(np.arange(-3.0, 10.0), ctrl, 3)
    found = np.stack(sampled(ctrl, 5), axis=-1)
    at = np.arange(6)[:, None] + np.linspace(0.0, 1.0, 6)
    assert found == pytest.approx(spline(at), abs=1e-12)
    assert Gaps(1.0, 1.3).least_share(ctrl) == pytest.approx(
        np.hypot(*(np.moveaxis(spline(np.linspace(0.0, 6.0, 145)), -1, 0) * [[1.0], [1.3]])).min()
    )


def test_a_point_after_a_wide_step_is_pushed_out_no_farther_than_the_corner_of_a_square() -> None:
    ctrl = np.array([[1.0, 0.0], [0.05, 1.0], [0.0, 1.0]])
    pushed = Gaps(1.0, 1.0).pushed_out(ctrl)
    assert (pushed[[0, 2]] == ctrl[[0, 2]]).all()
    assert 1.0 <= hypot(*pushed[1]) <= sqrt(2.0) + 1e-9
