"""Half-planes that keep cylinders apart: a pair by hand, all pairs by brute force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.show.geom.cylinder_planes import (
    REACH_RATIO,
    CylinderPlanes,
    cylinder_planes,
    least_before_and_after,
)
from shotc.show.geom.lattice import lattice
from shotc.show.solvers.match import matched


def distances(before: Array, after: Array, scalars: Array) -> Array:
    """How far all pairs are apart at one time, as the rule of cylinders is written."""
    a, b, a_up, b_up = scalars
    i, j = np.triu_indices(len(before), 1)
    r0, r1 = before[i] - before[j], after[i] - after[j]
    across = np.hypot(*(a * r0[:, :2] + b * r1[:, :2]).T)
    return np.asarray(np.maximum(across, np.abs(a_up * r0[:, 2] + b_up * r1[:, 2])))


def pictures(seed: int, count: int) -> tuple[Array, Array]:
    """Two parts of the densest lattice, turned about the vertical, matched."""
    rng = np.random.default_rng(seed)
    points = lattice(np.full(3, -4.0), np.full(3, 4.0), 1.0, True)
    both = []
    for _ in range(2):
        nearest = np.argsort(np.linalg.norm(points - rng.uniform(-1, 1, 3), axis=1))[:count]
        c, s = np.cos(a := rng.uniform(0.0, 6.0)), np.sin(a)
        both.append(points[nearest] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
    before, after = both
    return before, after[matched(before, after)]


def rows(planes: CylinderPlanes, time: int) -> set[tuple[bool, float, float]]:
    here = planes.at == time
    found = zip(planes.upright[here], planes.normals[here], strict=True)
    return {(bool(up), float(a.round(9)), float(b.round(9))) for up, (a, b) in found}


BESIDE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
ABOVE = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.2]])


def test_who_stands_beside_before_and_above_after_is_kept_apart_by_one_or_the_other() -> None:
    early, late = [1.0, 0.2, 1.0, 0.3], [0.3, 1.0, 0.4, 1.0]
    planes = cylinder_planes(BESIDE, ABOVE, np.array([early, early, early, late, late]))
    assert rows(planes, 0) == {(False, 1.0, 0.0)}  # a >= 1
    assert rows(planes, 2) == {(True, 0.0, 1.2)}  # 1.2 b' >= 1
    assert rows(planes, 1) == rows(planes, 0) | rows(planes, 2)  # both where it changes over
    assert planes.least == pytest.approx(1.0)


def test_a_motion_on_which_they_collide_asks_for_its_larger_distance() -> None:
    planes = cylinder_planes(BESIDE, ABOVE, np.array([[0.5, 0.5, 0.5, 0.7]] * 3))
    assert planes.least == pytest.approx(0.84)
    assert rows(planes, 1) == {(True, 0.0, 1.2)}


@pytest.mark.parametrize(("middle", "share"), [(0.995, 0.995), (1.0, 1.0), (1.2, 1.0), (0.7, 1.0)])
def test_who_is_a_little_too_near_between_two_times_is_farther_apart_at_both(
    middle: float, share: float
) -> None:
    # Two drones side by side that stay so: at a + b from each other.
    apart, between = [0.6, 0.4, 0.5, 0.5], [0.6, middle - 0.6, 0.5, 0.5]
    planes = cylinder_planes(BESIDE, BESIDE, np.array([apart, between, apart]))
    for time in (0, 1):
        assert rows(planes, time) == {(False, share, share)}  # a + b >= 1 / share
    assert planes.least == pytest.approx(min(middle, 1.0))


def test_a_pair_stays_apart_as_it_is_at_both_times_whatever_it_is_between() -> None:
    # Apart upright at both times, and across by a little more in the middle alone.
    pair = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
    at_both, between = [0.3, 0.3, 0.5, 0.5], [0.6, 0.6, 0.5, 0.5]
    planes = cylinder_planes(pair, pair, np.array([at_both, between, at_both]))
    assert rows(planes, 0) == rows(planes, 1) == {(True, 1.0, 1.0)}


def test_far_pairs_ask_for_nothing() -> None:
    planes = cylinder_planes(9.0 * BESIDE, 9.0 * BESIDE, np.array([[0.5, 0.5, 0.5, 0.5]] * 3))
    assert len(planes.at) == 0
    assert planes.least == REACH_RATIO


def test_the_least_of_the_formations_is_at_most_one() -> None:
    assert least_before_and_after(BESIDE, ABOVE) == 1.0
    assert least_before_and_after(1.5 * BESIDE, 1.5 * ABOVE) == 1.0
    assert least_before_and_after(0.9 * BESIDE, ABOVE) == pytest.approx(0.9)
    assert least_before_and_after(BESIDE, 0.7 * ABOVE) == pytest.approx(0.84)


scalars = st.lists(st.floats(0.0, 1.3), min_size=4, max_size=4)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 40), st.lists(scalars, min_size=3, max_size=3), scalars)
def test_whatever_keeps_the_half_planes_keeps_all_pairs_about_a_motion_apart(
    seed: int, count: int, motion: list[list[float]], other: list[float]
) -> None:
    before, after = pictures(seed, count)
    planes = cylinder_planes(before, after, np.array(motion))
    near = distances(before, after, np.array(motion[1])) < REACH_RATIO
    for time, upright in ((0, False), (0, True), (1, False), (1, True)):
        assert len(rows(planes, time)) <= 2 * len(near)
        here = (planes.at == time) & (planes.upright == upright)
        assert (planes.normals[here] >= 0.0).any(axis=1).all()
    # Other scalars, made as much larger as the half-planes ask for.
    point = np.array(other) + 0.05
    for time in (0, 1):
        here = planes.at == time
        chosen = np.where(planes.upright[here, None], point[2:], point[:2])
        sums = (planes.normals[here] * chosen).sum(axis=1)
        if len(sums) and sums.min() > 0.05:
            enough = distances(before, after, point / min(sums.min(), 1.0))
            assert enough[near].min() >= 1.0 - 1e-9


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 40), st.lists(scalars, min_size=3, max_size=3))
def test_the_least_distance_is_that_of_all_pairs(seed: int, count: int, motion: list[list[float]]) -> None:
    before, after = pictures(seed, count)
    least = min(float(distances(before, after, np.array(row)).min()) for row in motion)
    found = cylinder_planes(before, after, np.array(motion)).least
    # Pairs that are near only at an end are not looked for.
    assert found >= least - 1e-9
    middle = float(distances(before, after, np.array(motion[1])).min())
    assert found <= min(middle, REACH_RATIO) + 1e-9
