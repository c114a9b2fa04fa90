"""Pushing drones apart: the cost's slope against differences, and what comes of a push."""

from __future__ import annotations

from itertools import combinations
from math import hypot

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import centres, places
from shotc.ir.limits import Limits
from shotc.ir.show import Apart
from shotc.show.solvers.pusher import STEP_SHARE, Push, Pusher, _Cost, sizes, slopes
from shotc.show.solvers.qcqp import DerivativeBounds

BALL = Apart("ellipsoid", 1.5, 2.0, 0.1)
CAN = Apart("cylinder", 1.5, 2.0, 0.1)
LIMITS = Limits(3.5, 2.5, 1.5, 2.0, 8.0, 1.0, 1.0)
BREAKS = np.linspace(0.0, 6.0, 9)


def even(start: tuple[float, float, float], end: tuple[float, float, float]) -> Array:
    """Return the control points of a drone that flies evenly from one place to another."""
    share = (centres(BREAKS)[:, None] - BREAKS[0]) / (BREAKS[-1] - BREAKS[0])
    return np.asarray(np.array(start) + share * (np.array(end) - start))


def meeting() -> Array:
    """Two that cross, 0.3 m aside and 0.2 m higher; one that hovers nearby; one that is far from all."""
    return np.stack(
        [
            even((-4.0, 0.0, 20.0), (4.0, 0.0, 20.0)),
            even((0.3, -4.0, 20.2), (0.3, 4.0, 20.2)),
            even((2.0, 1.2, 19.5), (2.0, 1.2, 19.5)),
            even((30.0, 0.0, 20.0), (31.0, 0.0, 20.0)),
        ]
    )


def size(a: Array, b: Array, apart: Apart) -> float:
    """Return how far apart two are in the fleet's sense, as metres across."""
    across, up = hypot(*(a - b)[:2]), abs(float((a - b)[2])) * apart.across / apart.upright
    return hypot(across, up) if apart.shape == "ellipsoid" else max(across, up)


@pytest.mark.parametrize("apart", [BALL, CAN])
def test_distances_grow_in_the_directions_that_are_told(apart: Apart) -> None:
    relative = np.random.default_rng(2).normal(size=(30, 3))
    slope = slopes(relative, sizes(relative, apart), apart)
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 1e-6
        grown = (sizes(relative + step, apart) - sizes(relative - step, apart)) / 2e-6
        assert slope[:, axis] == pytest.approx(grown, abs=1e-6)


@pytest.mark.parametrize("apart", [BALL, CAN])
def test_the_pairs_within_reach_are_those_of_all(apart: Apart) -> None:
    at = np.random.default_rng(4).uniform(0.0, 8.0, (40, 3))
    stretched = at * [1.0, 1.0, apart.across / apart.upright]
    found = {
        tuple(sorted(pair))
        for pair in Pusher(BREAKS, DerivativeBounds(LIMITS), apart).pairs(stretched, 2.2).tolist()
    }
    assert found == {(i, j) for i, j in combinations(range(40), 2) if size(at[i], at[j], apart) < 2.2}
    assert found


@pytest.mark.parametrize("apart", [BALL, CAN])
@pytest.mark.parametrize("movable", [[0, 1, 2, 3], [0, 2]])
def test_the_slope_of_the_cost_is_that_of_its_values(apart: Apart, movable: list[int]) -> None:
    start = meeting()
    start[0, 5] += [0.0, 0.0, 3.0]  # faster than it may fly
    wanted = start + np.random.default_rng(6).normal(scale=0.1, size=start.shape)
    pusher = Pusher(BREAKS, DerivativeBounds(LIMITS), apart)
    cost = _Cost(pusher, start, wanted, np.array(movable), Push(1.1 * apart.across, 3.0))
    x = cost.begin() + np.random.default_rng(8).normal(scale=0.05, size=len(cost.begin()))
    value, slope = cost(x)
    assert value > 0.0
    for k in range(0, len(x), 3):
        for axis in range(k, k + 3):
            step = np.zeros(len(x))
            step[axis] = 1e-6
            assert (cost(x + step)[0] - cost(x - step)[0]) / 2e-6 == pytest.approx(
                slope[axis], abs=1e-4, rel=1e-4
            )


def test_the_cost_counts_what_every_pair_lacks_and_what_deviates() -> None:
    # Two that stand 1 m apart, 2 m wanted: over 6 s both ways of counting are sums of equal terms.
    start = np.stack([even((0, 0, 20), (0, 0, 20)), even((1, 0, 20), (1, 0, 20))])
    pusher = Pusher(BREAKS, DerivativeBounds(LIMITS), BALL)
    cost = _Cost(pusher, start, start, np.array([0, 1]), Push(2.0, 5.0))
    count = len(pusher.samples(start))
    assert cost(cost.begin())[0] == pytest.approx(5.0 * count * 6.0 / (count - 1) * 1.0**2)
    away = _Cost(pusher, start, start, np.array([0, 1]), Push(0.5, 5.0))
    assert away(away.begin())[0] == 0.0
    moved = away.begin()
    moved[::3] += 0.1  # all free points of both, a little east
    assert away(moved)[0] > 0.0


@pytest.mark.parametrize("apart", [BALL, CAN])
def test_nobody_gets_far_between_two_samples(apart: Apart) -> None:
    pusher, coef = Pusher(BREAKS, DerivativeBounds(LIMITS), apart), 3.0 * meeting()
    times = pusher.samples(coef)
    assert (times[0], times[-1]) == (BREAKS[0], BREAKS[-1])
    at = places(BREAKS, coef, times)
    for a, b in combinations(range(len(coef)), 2):
        for k in range(len(times) - 1):
            way = (at[a, k + 1] - at[a, k]) - (at[b, k + 1] - at[b, k])
            assert np.linalg.norm(way * pusher.scale) <= STEP_SHARE * apart.across + 1e-9


@pytest.mark.parametrize("late", np.linspace(0.0, 2.0, 7).tolist())
@pytest.mark.parametrize("apart", [BALL, CAN])
def test_who_passes_at_nine_tenths_of_the_distance_is_crowded_whenever_it_does(
    apart: Apart, late: float
) -> None:
    aside = 0.9 * apart.across
    coef = np.stack(
        [
            even((0.0, 0.0, 20.0), (0.0, 0.0, 20.0)),
            even((-30.0 - late, aside, 20.0), (30.0 - late, aside, 20.0)),
        ]
    )
    assert Pusher(BREAKS, DerivativeBounds(LIMITS), apart).crowded(coef, apart.across).tolist() == [0, 1]


@pytest.mark.parametrize("apart", [BALL, CAN])
def test_who_comes_too_near_is_crowded_and_is_pushed_away_and_the_others_stay(apart: Apart) -> None:
    coef, pusher = meeting(), Pusher(BREAKS, DerivativeBounds(LIMITS), apart)
    assert pusher.crowded(coef, apart.across).tolist() == [0, 1, 2]
    assert pusher.crowded(coef, 0.2).tolist() == []
    pushed = pusher.push(coef, coef, np.array([0, 1]), Push(1.05 * apart.across, 1e4))
    assert (pushed[2:] == coef[2:]).all()
    assert (pushed[:, :3] == coef[:, :3]).all()
    assert (pushed[:, -3:] == coef[:, -3:]).all()
    times = np.linspace(0.0, 6.0, 601)
    before, after = (places(BREAKS, c, times) for c in (coef, pushed))

    def nearest(at: Array) -> float:
        return min(size(at[a, k], at[b, k], apart) for a, b in ((0, 1), (0, 2), (1, 2)) for k in range(601))

    assert nearest(before) < 0.5
    assert nearest(after) > 0.9 * apart.across
