"""Matching drones to goals: the least sum for small fleets, no crossing pair in any."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.show.solvers import match as fleet_match
from shotc.show.solvers.match import crossing, matched


def formation(rng: np.random.Generator, count: int) -> Array:
    """Return points at least 1 apart: a jittered grid, turned."""
    side = int(np.ceil(count ** (1 / 3)))
    grid = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)[:count] * 1.4
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray((grid + rng.uniform(-0.11, 0.11, grid.shape)) @ turn)


@pytest.mark.parametrize("seed", range(5))
def test_no_permutation_has_a_smaller_sum(seed: int) -> None:
    rng = np.random.default_rng(seed)
    starts, goals = rng.normal(size=(6, 3)), rng.normal(size=(6, 3))
    order = matched(starts, goals)
    sums = [((starts - goals[list(p)]) ** 2).sum() for p in permutations(range(6))]
    assert ((starts - goals[order]) ** 2).sum() == pytest.approx(min(sums), rel=1e-12)


@pytest.mark.parametrize("count", [37, 400])
def test_a_large_fleet_has_no_crossing_pair_and_nearly_the_least_sum(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(count)
    starts, goals = formation(rng, count), rng.normal(size=(count, 3)) * 5.0
    exact = matched(starts, goals)
    monkeypatch.setattr(fleet_match, "EXACT_DRONES", 10)
    monkeypatch.setattr(fleet_match, "PART_DRONES", 50)
    order = matched(starts, goals)
    assert sorted(order) == list(range(count))
    assert crossing(starts, goals[order])[0] > -1e-6
    least = ((starts - goals[exact]) ** 2).sum()
    assert least <= ((starts - goals[order]) ** 2).sum() * (1 + 1e-12) <= 1.3 * least


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 40), st.booleans())
def test_straight_moves_keep_the_distance_that_is_promised(seed: int, count: int, large: bool) -> None:
    rng = np.random.default_rng(seed)
    starts, goals = formation(rng, count), formation(rng, count) + rng.normal(size=3) * 20.0
    with pytest.MonkeyPatch.context() as patch:
        if large:
            patch.setattr(fleet_match, "EXACT_DRONES", 1)
            patch.setattr(fleet_match, "PART_DRONES", 5)
        ends = goals[matched(starts, goals)]
    spaced = min(np.linalg.norm(a[i] - a[j]) for a in (starts, ends) for i in range(count) for j in range(i))
    for s in np.linspace(0.0, 1.0, 41):
        at = starts + s * (ends - starts)
        near = min(float(np.linalg.norm(at[i] - at[j])) for i in range(count) for j in range(i))
        assert near >= np.sqrt(s * s + (1 - s) ** 2) * spaced - 1e-7


def test_who_is_already_nearest_to_a_goal_of_his_own_keeps_it() -> None:
    rng = np.random.default_rng(1)
    starts = formation(rng, 300)
    mixed = rng.permutation(300)
    order = matched(starts, (starts + 0.01)[mixed])
    assert (mixed[order] == np.arange(300)).all()


def test_the_pair_that_crosses_is_named() -> None:
    starts = np.array([[0.0, 0, 0], [1, 0, 0], [5, 0, 0]])
    goals = np.array([[1.0, 9, 0], [0, 9, 0], [5, 9, 0]])
    least, i, j = crossing(starts, goals)
    assert (least, {i, j}) == (-1.0, {0, 1})
    assert crossing(starts[:1], goals[:1])[0] == np.inf


def test_where_the_goals_are_as_a_whole_changes_nothing() -> None:
    """Parts are halved about the means: a fleet that is matched in parts is matched alike 500 m away."""
    rng = np.random.default_rng(5)
    starts, goals = formation(rng, 310), rng.normal(size=(310, 3)) * [9.0, 5.0, 2.0]
    order = matched(starts, goals)
    assert (matched(starts, goals + np.array([300.0, -400.0, 100.0])) == order).all()
    assert (matched(starts - np.array([0.0, 500.0, 0.0]), goals) == order).all()


@pytest.mark.parametrize(("gain", "swapped"), [(0.99, False), (1.01, True)])
def test_two_drones_swap_goals_if_that_gains_more_than_rounding_of_the_largest_products(
    gain: float, swapped: bool
) -> None:
    least = fleet_match.TOLERANCE_SHARE * 100.0 * 50.0
    starts = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [100.0, 100.0, 100.0]])
    goals = np.array([[gain * least / 0.01, 0.0, 0.0], [0.0, 0.0, 0.0], [50.0, 50.0, 50.0]])
    order = fleet_match._untangled(starts, goals, np.arange(3))
    assert order.tolist() == ([1, 0, 2] if swapped else [0, 1, 2])
