"""Moves of cylinders with own scalars of the heights: a pair by theory, pictures by proof and samples."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import knots
from shotc.geom.separation import closest
from shotc.ir.limits import Limits
from shotc.ir.show import Apart
from shotc.show.geom.lattice import lattice
from shotc.show.geom.least_size import least_size
from shotc.show.solvers.arc_move import ArcMove, Drones, fastest_arc
from shotc.show.solvers.match import matched
from shotc.show.solvers.move import fastest
from shotc.show.solvers.own_heights import MOST_SCALAR, OwnHeightsTask, _first, own_heights

LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
APART = Apart("cylinder", 1.5, 2.5, 0.0)
SCALE = np.array([1.0, 1.0, 0.6]) / 1.5
MIDDLE = np.zeros(3)
Ends = tuple[Array, Array]


def dense(seed: int, count: int) -> Ends:
    """Parts of the densest lattice: a lump, and one that is four times as long as it is wide; metres."""
    rng = np.random.default_rng(seed)
    points = lattice(np.full(3, -7.0), np.full(3, 7.0), 1.001, True)
    both = []
    for longer in (1.0, 4.0):
        away = np.linalg.norm((points - rng.uniform(-1, 1, 3)) / (longer, 1.0, 1.0), axis=1)
        c, s = np.cos(a := rng.uniform(0.0, 6.0)), np.sin(a)
        both.append(points[np.argsort(away)[:count]] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
    before, after = both
    return before / SCALE, after[matched(before, after)] / SCALE


def task(ends: Ends, low: float = -inf, high: float = inf) -> OwnHeightsTask:
    return OwnHeightsTask(ends, SCALE / 1.0005, LIMITS, 1.0, (low, high))


def spline(move: ArcMove, ends: Ends) -> tuple[Array, Array, Array]:
    """Breaks, control points (n, K, 3), and 400 times."""
    starts, goals = ends
    coef = np.stack([*[starts] * 3, *move.between(starts, goals), *[goals] * 3], axis=1)
    breaks = np.arange(coef.shape[1] - 2) * move.piece
    return breaks, coef, np.linspace(0.0, breaks[-1], 400)


def scalars(move: ArcMove) -> tuple[Array, Array]:
    """(a, b) and those of the heights at 600 times, shape (600, 2) each."""
    breaks = np.arange(move.pieces + 1.0)
    at = np.linspace(0.0, move.pieces, 600)
    return tuple(BSpline(knots(breaks), ctrl, 3)(at) for ctrl in (move.ctrl, move.heights))  # type: ignore[return-value]


@pytest.mark.slow
def test_who_comes_to_be_above_the_other_leaves_its_side_when_the_height_is_reached() -> None:
    far = np.array([[40.0, 0.0, 0.0], [-40.0, 0.0, 0.0]])
    starts = np.concatenate([[[0.0, 0.0, 0.0], [0.0, 1.5, 0.0]], 0.2 * far])
    goals = np.concatenate([[[0.0, 0.0, -1.25], [0.0, 0.0, 1.25]], far])
    ends = (starts, goals)
    move = own_heights(task(ends), MIDDLE)
    assert move is not None
    level, upright = scalars(move)
    assert np.maximum(level[:, 0], upright[:, 1]).min() >= 1.0 - 2e-4
    assert max(level.max(), upright.max()) <= MOST_SCALAR
    common = fastest_arc(ends, MIDDLE, least_size(*(p * SCALE / 1.0005 for p in ends)), LIMITS, 1.0)
    assert move.duration < 0.95 * common.duration
    # Common scalars are both 1 at a time; here the long way is over when a is small.
    assert level[:, 0][level[:, 1] >= 0.99][0] < 0.9


def test_drones_that_change_places_at_one_height_have_no_such_move() -> None:
    starts = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    assert own_heights(task((starts, starts[::-1])), MIDDLE) is None


@pytest.mark.slow
def test_nothing_is_needed_if_nobody_moves() -> None:
    starts = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    move = own_heights(task((starts, starts)), MIDDLE)
    assert move is not None
    assert move.duration < 10.0


@pytest.mark.slow
def test_with_nobody_in_the_way_it_is_as_fast_as_the_straight_move() -> None:
    starts = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    goals = np.array([[8.0, 0.0, -1.25], [-8.0, 0.0, 1.25]])
    move = own_heights(task((starts, goals)), MIDDLE)
    assert move is not None
    assert move.duration <= fastest(goals - starts, LIMITS, 1.0).duration


@pytest.mark.slow
def test_a_pair_that_has_time_for_a_detour_above_stays_below_the_ceiling() -> None:
    starts = np.array([[0.0, 0.0, 0.0], [0.0, 1.5, 0.0]])
    goals = np.array([[0.0, 0.0, -1.25], [0.0, 0.0, 1.25]])
    move = own_heights(task((starts, goals), high=1.3), MIDDLE)
    assert move is not None
    assert (move.heights @ [0.0, 1.25]).max() == pytest.approx(1.3, abs=1e-6)


def test_the_first_motion_keeps_one_scalar_of_each_pair_at_one_and_is_the_same_backwards() -> None:
    starts = np.array([[1.0, 2.0, 0.5], [-3.0, 0.0, -0.5]])
    goals = np.array([[9.0, -4.0, -3.0], [-5.0, 7.0, 2.0]])
    limits = LIMITS._replace(descent=LIMITS.climb)
    there, back = (
        _first(Drones.of(ends, MIDDLE, limits, 1.0).with_own_heights())
        for ends in ((starts, goals), (goals, starts))
    )
    a, b, a_up, b_up = there.T
    assert np.maximum(a, b_up) == pytest.approx(1.0)
    assert np.maximum(a_up, b) == pytest.approx(1.0)
    assert there == pytest.approx(back[::-1][:, [1, 0, 3, 2]])


@pytest.mark.long
@settings(max_examples=4, deadline=None)
@given(st.integers(0, 2**31), st.integers(8, 40))
def test_dense_pictures_keep_the_separation_and_the_limits_at_every_time(seed: int, count: int) -> None:
    ends = dense(seed, count)
    move = own_heights(task(ends), MIDDLE)
    assert move is not None
    breaks, coef, at = spline(move, ends)
    assert closest(breaks, coef, APART).proven >= APART.across
    curve = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), 3)
    rate = curve.derivative()(at)
    assert np.hypot(rate[..., 0], rate[..., 1]).max() <= LIMITS.speed
    assert rate[..., 2].max() <= LIMITS.climb
    assert -rate[..., 2].min() <= LIMITS.descent
    for order, most in ((2, LIMITS.acceleration), (3, LIMITS.jerk)):
        assert np.linalg.norm(curve.derivative(order)(breaks[:-1] + 1e-9), axis=2).max() <= most


@pytest.mark.long
@pytest.mark.parametrize("low", [True, False])
def test_it_stays_between_the_heights(low: bool) -> None:
    ends = dense(3, 30)
    free = own_heights(task(ends), MIDDLE)
    assert free is not None
    farthest = [float(e[:, 2].min() if low else e[:, 2].max()) for e in ends]
    bound = float(0.1 * max(farthest, key=abs) + 0.9 * max(free.heights @ farthest, key=abs))
    move = own_heights(task(ends, low=bound) if low else task(ends, high=bound), MIDDLE)
    assert move is not None
    assert np.abs(move.heights @ farthest).max() <= abs(bound) + 1e-5
    assert move.duration >= free.duration * 0.99
    z = spline(move, ends)[1][..., 2]
    assert z.min() >= bound - 1e-5 if low else z.max() <= bound + 1e-5


@pytest.mark.slow
def test_the_busy_drone_and_its_limit_are_said() -> None:
    ends = dense(1, 20)
    move = own_heights(task(ends), MIDDLE)
    assert move is not None
    assert move.limit in ("speed", "climb", "descent", "acceleration", "jerk")
    assert 0 <= move.drone < 20
