"""Goals on strokes: drawn onto them, apart, and those without room taken out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist, pdist

from shotc.geom.bernstein import Array
from shotc.show.geom.push_along import push_along, thinned

GRAIN = 0.02


def anywhere(_: Array, after: Array) -> Array:
    return after


def line(x: float, length: float) -> Array:
    up = np.arange(0.0, length, GRAIN)
    return np.column_stack([np.full(len(up), x), up])


def off(goals: Array, shape: Array) -> float:
    return float(cdist(goals, shape).min(axis=1).max())


def test_goals_between_two_strokes_end_on_them() -> None:
    shape = np.concatenate([line(0.0, 10.0), line(2.0, 10.0)])
    between = np.column_stack([np.full(8, 1.01), np.linspace(0.5, 9.5, 8)])
    found = push_along(between, shape, 1.0, 0.1, anywhere)
    assert found is not None
    assert off(found, shape) <= 0.1 + 2 * GRAIN
    assert pdist(found).min() >= 1.0 - 1e-9


def test_a_line_holds_as_many_as_fit_along_it() -> None:
    shape = line(0.0, 10.0)
    assert push_along(shape[::50], shape, 0.9, 0.0, anywhere) is not None
    assert push_along(shape[::20], shape, 1.0, 0.1, anywhere) is None


@pytest.mark.long
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 60))
def test_what_is_left_is_apart_on_the_shape_and_not_few(seed: int, n: int) -> None:
    shape = np.concatenate([line(0.0, 10.0), line(3.0, 10.0)])
    goals = shape[np.random.default_rng(seed).integers(0, len(shape), n)]
    found = thinned(goals, shape, 1.0, 0.1, anywhere)
    assert len(found) < 2 or pdist(found).min() >= 1.0 - 1e-9
    assert off(found, shape) <= 0.1 + 2 * GRAIN
    assert len(found) >= min(n, 22) * 0.5


def test_where_it_is_held_no_goal_goes() -> None:
    shape = line(0.0, 10.0)

    def above(before: Array, after: Array) -> Array:
        return np.where(after[:, 1:] < 4.0, before, after)

    found = thinned(shape[200::10], shape, 1.0, 0.0, above)
    assert found[:, 1].min() >= 4.0 - 1e-9
    assert len(found) == pytest.approx(6, abs=1)
