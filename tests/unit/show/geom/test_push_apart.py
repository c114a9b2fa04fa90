"""Goals pushed apart: apart indeed, near where they were, and refused where they do not fit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

from shotc.geom.bernstein import Array
from shotc.show.geom.push_apart import SLACK_SHARE, close_pairs, grain, nearest_pair, push_apart


def anywhere(_: Array, after: Array) -> Array:
    return after


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 120), st.floats(0.05, 0.9))
def test_goals_end_apart_and_near_their_shape(seed: int, n: int, density: float) -> None:
    rng = np.random.default_rng(seed)
    shape = rng.random((max(2000, 20 * n), 3))
    least = density * n ** (-1 / 3)
    goals = shape[:n]
    found = push_apart(goals, shape, least, anywhere)
    if found is None:
        assert density > 0.7
        return
    assert pdist(found).min() >= least * (1 - 1e-9)
    outside = np.maximum(np.maximum(-found, found - 1), 0)
    assert np.linalg.norm(outside, axis=1).max() <= 1.2 * (
        SLACK_SHARE * least + 0.12
    )  # 0.12: gaps of the points


@pytest.mark.parametrize("upright", [False, True])
def test_pairs_that_are_too_near_are_told_with_the_way_that_parts_them(upright: bool) -> None:
    goals = np.random.default_rng(2).uniform(0.0, 3.0, (40, 3))
    expected = {}
    for i in range(40):
        for j in range(i + 1, 40):
            x, y, z = goals[i] - goals[j]
            level = (x, y, 0.0) if np.hypot(x, y) >= abs(z) else (0.0, 0.0, z)
            apart = np.array(level if upright else (x, y, z))
            if np.linalg.norm(apart) < 0.8:
                expected[i, j] = apart
    found = close_pairs(goals, 0.8, upright)
    assert list(zip(found.first.tolist(), found.second.tolist(), strict=True)) == sorted(expected)
    assert found.apart == pytest.approx(np.array([expected[pair] for pair in sorted(expected)]))
    assert found.distance == pytest.approx(np.linalg.norm(found.apart, axis=1))
    assert any(apart[2] == 0.0 for apart in expected.values()) is upright


def test_goals_that_are_apart_stay_to_the_last_bit() -> None:
    goals = np.random.default_rng(0).random((50, 3))
    found = push_apart(goals, goals, nearest_pair(goals) * 0.999, anywhere)
    assert found is not None
    assert (found == goals).all()


def test_two_move_no_more_than_they_must() -> None:
    goals = np.array([[0.0, 0, 0], [0.5, 0, 0], [5, 0, 0]])
    line = np.linspace([-2.0, 0, 0], [6, 0, 0], 800)
    found = push_apart(goals, line, 1.0, anywhere)
    assert found is not None
    assert np.abs(found[:2, 0] - [-0.25, 0.75]).max() < 2e-3
    assert (found[2] == goals[2]).all()


def test_two_at_one_place_part() -> None:
    line = np.linspace([-1.0, 0, 0], [1, 0, 0], 100)
    found = push_apart(np.zeros((2, 3)), line, 0.5, anywhere)
    assert found is not None
    assert nearest_pair(found) >= 0.5 * (1 - 1e-9)


def test_a_plane_stays_a_plane() -> None:
    rng = np.random.default_rng(3)
    shape = np.column_stack([rng.random((2000, 1)) * 10, np.zeros((2000, 1)), rng.random((2000, 1)) * 10])
    found = push_apart(shape[:60], shape, 0.8, anywhere)
    assert found is not None
    assert (found[:, 1] == 0).all()


def test_more_than_fit_are_refused() -> None:
    shape = np.random.default_rng(0).random((3000, 3))
    assert push_apart(shape[:200], shape, 0.4, anywhere) is None


def test_nobody_goes_where_it_may_not() -> None:
    rng = np.random.default_rng(5)
    shape = rng.random((2000, 3))

    def above(before: Array, after: Array) -> Array:
        return np.where(after[:, 2:] < 0.0, before, after)

    found = push_apart(shape[:40], shape, 0.2, above)
    assert found is not None
    assert found[:, 2].min() >= 0.0


def test_a_single_goal_is_alone() -> None:
    assert nearest_pair(np.zeros((1, 3))) == np.inf
    assert push_apart(np.zeros((1, 3)), np.zeros((1, 3)), 1.0, anywhere) is not None


def test_the_grain_of_a_shape_is_how_far_its_points_are_apart() -> None:
    assert grain(cKDTree(np.zeros((1, 3)))) == 0.0
    grid = np.stack(np.meshgrid(*[np.arange(8.0) * 0.7] * 2), axis=-1).reshape(-1, 2)
    assert grain(cKDTree(grid)) == pytest.approx(0.7)
    # One point in twenty may stand alone.
    assert grain(cKDTree(np.concatenate([grid, [[50.0, 50.0]]]))) == pytest.approx(0.7)
