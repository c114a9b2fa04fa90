"""k-means in space and for a viewpoint: known optima, costs that never rise, Table I in its sound form."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.centroids import _Nearest, centroids, halved, view_plane, viewpoint_centroids
from tests.support.goal_costs import coverage

EYE = np.array([80.0, 0.0, 0.0])


def ball_of(count: int, seed: int = 0, radius: float = 1.0) -> Array:
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(count, 3))
    return radius * rng.random(count)[:, None] ** (1 / 3) * way / np.linalg.norm(way, axis=1)[:, None]


def cube_of(count: int, seed: int = 0) -> Array:
    return np.random.default_rng(seed).random((count, 3)) * 2 - 1


def never_rises(costs: tuple[float, ...]) -> bool:
    return bool(np.all(np.diff(costs) <= 1e-12 * costs[0]))


def flat(points: Array, centre: Array) -> Array:
    return (points - centre) @ view_plane(centre, EYE)[0].T


def test_a_single_goal_is_the_mean_and_costs_the_variance() -> None:
    points = ball_of(20_000)
    found = centroids(points, 1)
    assert found.goals[0] == pytest.approx(points.mean(axis=0))
    # The mean square of the radius of a unit ball is 3/5.
    assert coverage(points, found.goals) / len(points) == pytest.approx(0.6, rel=0.01)


def test_as_many_goals_as_points_are_the_points() -> None:
    points = cube_of(12)
    assert coverage(points, centroids(points, 12).goals) == pytest.approx(0.0, abs=1e-18)


def test_a_line_is_shared_evenly() -> None:
    points = np.linspace(0, 1, 4001)[:, None]
    goals = np.sort(centroids(points, 4, np.array([[0.1], [0.2], [0.3], [0.9]])).goals[:, 0])
    assert goals == pytest.approx([0.125, 0.375, 0.625, 0.875], abs=2e-3)


def test_points_are_halved_in_their_order_on_every_processor() -> None:
    row = np.arange(300)
    points = np.column_stack([np.where(row % 3 == 0, 0.0, np.where(row % 3 == 1, 1.0, 2.0)), 1e-3 * row])
    ones = np.flatnonzero(row % 3 == 1)
    first = np.sort(np.concatenate([np.flatnonzero(row % 3 == 0), ones[:50]]))
    expected = [points[first].mean(axis=0), np.delete(points, first, axis=0).mean(axis=0)]
    np.testing.assert_array_equal(halved(points, 2), expected)


def test_every_point_is_of_its_nearest_goal() -> None:
    points = ball_of(6000)
    found = centroids(points, 150)
    distance = np.linalg.norm(points - found.goals[found.labels], axis=1)
    assert distance == pytest.approx(cKDTree(found.goals).query(points)[0])


@pytest.mark.parametrize(("goal", "way"), [(27, -6.5), (39, -3.5), (39, -9.5), (39, -30.5)])
def test_a_goal_that_jumps_from_afar_takes_the_points_that_it_comes_to(goal: int, way: float) -> None:
    """A row of goals: the one that moves is no neighbour of those where it comes to."""
    goals = np.column_stack([np.arange(40.0), np.zeros((40, 2))])
    points = goals + np.array([0.45, 0.0, 0.0])
    near, step = _Nearest(points, goals), np.zeros((40, 3))
    step[goal, 0] = way
    moved = near.follow(goals, step)
    distance = np.linalg.norm(points - moved[near.in_order()], axis=1)
    assert distance == pytest.approx(cKDTree(moved).query(points)[0])


@pytest.mark.slow
def test_every_point_is_of_its_nearest_goal_whatever_they_begin_with() -> None:
    """Also where goals begin at one place, or far off, and all move far: nothing is missed."""
    points = ball_of(3000)
    for start in (np.zeros((40, 3)), np.repeat(points[:20], 2, axis=0), 5.0 + points[:40], points[:2]):
        found = centroids(points, len(start), start)
        distance = np.linalg.norm(points - found.goals[found.labels], axis=1)
        assert distance == pytest.approx(cKDTree(found.goals).query(points)[0])


@pytest.mark.long
@pytest.mark.parametrize("shape", [ball_of, cube_of])
def test_momentum_ends_below_plain_steps(shape: Callable[[int, int], Array]) -> None:
    shares = []
    for seed in range(4):
        points = shape(8000, seed)
        goals = halved(points, 200)
        for _ in range(60):
            labels = cKDTree(goals).query(points)[1]
            goals = np.stack([points[labels == k].mean(axis=0) for k in range(200)])
        shares.append(coverage(points, centroids(points, 200).goals) / coverage(points, goals))
    assert max(shares) < 0.995
    assert np.mean(shares) < 0.985


def test_the_cost_that_is_told_is_that_of_a_plain_search() -> None:
    points = ball_of(3000)
    found = centroids(points, 60)
    assert found.costs[0] == pytest.approx(coverage(points, halved(points, 60)))
    assert found.costs[-1] == pytest.approx(coverage(points, found.goals), rel=1e-3)


@pytest.mark.slow
def test_the_cost_is_that_of_the_reference() -> None:
    # Per point of a unit ball with 20 goals: 0.0904, measured elsewhere by plain steps.
    cost = coverage(ball_of(20_000), centroids(ball_of(20_000), 20).goals) / 20_000
    assert cost == pytest.approx(0.0904, rel=0.02)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 60), st.sampled_from([0.0, 0.1, 0.5, 3.0]))
def test_no_step_raises_the_cost(seed: int, n: int, weight: float) -> None:
    points = cube_of(600, seed) * np.random.default_rng(seed).uniform(0.2, 5, 3)
    space = centroids(points, n)
    seen = viewpoint_centroids(points, space.goals, np.array([9.0, -30.0, 2.0]), weight)
    assert never_rises(space.costs)
    assert never_rises(seen.costs)


@pytest.mark.long
@pytest.mark.parametrize("shape", [ball_of, cube_of])
@pytest.mark.parametrize("seed", range(4))
def test_cost_in_space_rises_and_in_the_picture_falls_with_the_weight(shape, seed: int) -> None:
    points = shape(10_000, seed)
    goals = centroids(points, 20).goals
    centre = points.mean(axis=0)
    sets = [viewpoint_centroids(points, goals, EYE, weight).goals for weight in (inf, 0.5, 0.0)]
    space = [coverage(points, g) for g in sets]
    picture = [coverage(flat(points, centre), flat(g, centre)) for g in sets]
    assert space[0] < space[1] < space[2]
    assert picture[0] > picture[1] > picture[2]


def test_goals_keep_their_depth() -> None:
    points = ball_of(5000)
    goals = centroids(points, 40).goals
    normal = view_plane(points.mean(axis=0), EYE)[1]
    seen = viewpoint_centroids(points, goals, EYE, 0.0).goals
    assert seen @ normal == pytest.approx(goals @ normal, abs=1e-12)
    assert not np.allclose(seen, goals)


def test_without_a_weight_on_the_picture_goals_stay() -> None:
    points = ball_of(1000)
    goals = centroids(points, 10).goals
    assert (viewpoint_centroids(points, goals, EYE, inf).goals == goals).all()


@pytest.mark.slow
def test_goals_that_begin_with_the_frame_before_follow_it() -> None:
    points = ball_of(6000)
    first = centroids(points, 100).goals
    turned = points @ np.array([[np.cos(0.02), np.sin(0.02), 0], [-np.sin(0.02), np.cos(0.02), 0], [0, 0, 1]])
    then = centroids(turned, 100, first).goals
    assert np.linalg.norm(then - first, axis=1).mean() < 0.02  # the turn alone moves them 0.013
    anew = centroids(turned, 100).goals
    assert cKDTree(anew).query(first)[0].mean() > 0.04


def test_the_picture_plane_has_right_and_up() -> None:
    (right, up), normal = view_plane(np.array([0.0, 0.0, 10.0]), np.array([0.0, -50.0, 10.0]))
    assert right == pytest.approx([1, 0, 0])
    assert up == pytest.approx([0, 0, 1])
    assert normal == pytest.approx([0, 1, 0])


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(ValueError, match="3 points cannot have 4"):
        centroids(np.zeros((3, 3)), 4)
    with pytest.raises(ValueError, match="middle"):
        view_plane(EYE, EYE)
