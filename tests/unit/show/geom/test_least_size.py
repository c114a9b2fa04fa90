"""The least size of formations of cylinders, and the shortest way: against all pairs and the theory."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.show.geom.arcs import sampled
from shotc.show.geom.lattice import lattice
from shotc.show.geom.least_size import DIRECTIONS, _bounds, least_size
from shotc.show.solvers.match import matched


def kept(before: Array, after: Array, a: Array, b: Array) -> Array:
    """How near any two come at each (a, b), as the rule of cylinders is written."""
    i, j = np.triu_indices(len(before), 1)
    r0, r1 = before[i] - before[j], after[i] - after[j]
    way = a[:, None, None] * r0 + b[:, None, None] * r1
    return np.asarray(np.maximum(np.hypot(way[..., 0], way[..., 1]), np.abs(way[..., 2])).min(axis=1))


def crowd(rng: np.random.Generator, count: int) -> Array:
    """Places, not of a lattice, any two of which keep a cylinder of radius and half height 1 free."""
    found: list[Array] = []
    while len(found) < count:
        place = rng.uniform(-0.75, 0.75, 3) * count ** (1 / 3) * 1.6
        away = np.abs(np.array(found) - place) if found else np.zeros((0, 3))
        if (np.maximum(np.hypot(away[:, 0], away[:, 1]), away[:, 2]) >= 1.0).all():
            found.append(place)
    return np.array(found)


def solid(rng: np.random.Generator, count: int) -> Array:
    points = lattice(np.full(3, -4.0), np.full(3, 4.0), 1.0, True)
    nearest = np.argsort(np.linalg.norm(points - rng.uniform(-1, 1, 3), axis=1))[:count]
    c, s = np.cos(a := rng.uniform(0.0, 6.0)), np.sin(a)
    return np.asarray(points[nearest] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))


def _length(line: Array) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


ends = st.tuples(st.integers(0, 2**31), st.integers(2, 40), st.sampled_from([crowd, solid]))


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(ends)
def test_no_pair_comes_too_near_at_that_size_and_some_would_at_less(drawn: object) -> None:
    seed, count, kind = drawn  # type: ignore[misc]
    rng = np.random.default_rng(seed)
    before, after = kind(rng, count), kind(rng, count) * rng.uniform(1.0, 2.0)
    after = after[matched(before, after)]
    size = least_size(before, after).size
    middle = 0.5 * (DIRECTIONS[1:] + DIRECTIONS[:-1])
    near = kept(before, after, (1.0 - middle) * size, middle * size)
    assert near.min() >= 1.0 - 1e-9
    # Between the directions in which it is told the bound is a little larger than what is needed.
    asked = size > 1.0
    assert near[asked].max(initial=0.0) <= 1.06


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(ends)
def test_the_way_is_large_enough_everywhere_and_turns_one_way(drawn: object) -> None:
    seed, count, kind = drawn  # type: ignore[misc]
    rng = np.random.default_rng(seed)
    before, after = kind(rng, count), kind(rng, count)
    after = after[matched(before, after)]
    way, *rounder = least_size(before, after).ways()
    for line in (way, *rounder):
        assert line[0] == pytest.approx([1.0, 0.0])
        assert line[-1] == pytest.approx([0.0, 1.0])
    assert kept(before, after, *way.T).min() >= 1.0 - 1e-3
    for line in rounder:
        inner = line[len(line) // 4 : -len(line) // 4]
        assert kept(before, after, *inner.T).min() >= 1.0 - 1e-3
    step = np.diff(way, axis=0)
    turn = step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0]
    assert turn.min() >= -1e-9


@pytest.mark.parametrize("seed", range(4))
def test_tangents_bound_how_near_a_pair_is_between_two_directions(seed: int) -> None:
    r0, r1 = np.random.default_rng(seed).uniform(-2.0, 2.0, (2, 40, 3))
    u = np.linspace(0.0, 1.0, 9 * 100 + 1)
    way = (1.0 - u)[:, None, None] * r0 + u[:, None, None] * r1
    near = np.maximum(np.hypot(way[..., 0], way[..., 1]), np.abs(way[..., 2]))
    least = np.array([near[100 * k : 100 * k + 101].min(axis=0) for k in range(9)]).T
    assert (_bounds(r0, r1, u[::100]) <= least + 1e-12).all()


def test_tangents_are_exact_for_who_is_above_all_the_way() -> None:
    r0, r1 = np.zeros((3, 3)), np.zeros((3, 3))
    r0[:, 2], r1[:, 2] = [1.0, 1.0, 2.0], [-3.0, 2.0, 0.4]
    # They are level with each other at a quarter of the way; they part; they come nearer.
    bounds = _bounds(r0, r1, np.array([0.0, 0.2, 0.6, 1.0]))
    assert bounds == pytest.approx(np.array([[0.2, 0.0, 1.4], [1.0, 1.2, 1.6], [1.68, 1.04, 0.4]]), abs=1e-12)


def test_who_stands_side_by_side_before_and_above_each_other_after_keeps_one_of_both() -> None:
    before = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 9.0, 1.0]])
    after = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 9.0, 0.0], [1.0, 9.0, 0.0]])
    way = next(least_size(before, after).ways())
    assert np.maximum(*way.T).min() >= 1.0 - 1e-9
    assert least_size(before, after).most == pytest.approx(2.0, rel=0.02)
    assert _length(way) == pytest.approx(2.0, rel=0.01)
    assert np.abs(way - 1.0).sum(axis=1).min() < 0.05
    for rounder in list(least_size(before, after).ways())[1:]:
        # Round corners go out to where they are free again, and no farther.
        inner = rounder[len(rounder) // 4 : -len(rounder) // 4]
        assert 1.0 - 1e-3 <= np.maximum(*inner.T).min() <= 1.01


def test_pairs_far_apart_before_and_after_ask_for_nothing() -> None:
    rng = np.random.default_rng(1)
    before, after = 2.0 * crowd(rng, 30), 2.0 * crowd(rng, 30)
    found = least_size(before, after[matched(before, after)])
    assert found.most == 1.0
    assert next(found.ways()).sum(axis=1) == pytest.approx(1.0)


def test_splines_are_pushed_out_until_they_are_large_enough() -> None:
    rng = np.random.default_rng(2)
    before, after = solid(rng, 40), solid(rng, 40)
    after = after[matched(before, after)]
    free = least_size(before, after)
    way = next(free.ways())
    ctrl = np.concatenate([way[[0, 0]], way[:: len(way) // 12], way[[-1, -1]]])
    assert free.least_share(ctrl) < 0.98
    pushed = free.pushed_out(ctrl)
    assert free.least_share(pushed) >= 1.0 - 1e-4
    a, b = (x.ravel() for x in sampled(pushed, 50))
    assert kept(before, after, a, b).min() >= 1.0 - 1e-3
