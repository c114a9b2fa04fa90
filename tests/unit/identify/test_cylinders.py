"""Circles and cylinders about points: the least one, and that of the paper."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.identify.cylinders import enclosing, least_circle
from tests.experiments.papers.printed_rules import outside, printed


def least(points: np.ndarray) -> float:
    """Return the least radius by trying the circles of all pairs and triples."""
    from itertools import combinations

    best = np.inf
    for some in [*combinations(points, 2), *combinations(points, 3)]:
        if len(some) == 2:
            centre = 0.5 * (some[0] + some[1])
        else:
            a, b, c = some
            matrix = 2 * np.array([b - a, c - a])
            if abs(np.linalg.det(matrix)) < 1e-9:
                continue
            centre = np.linalg.solve(matrix, [b @ b - a @ a, c @ c - a @ a])
        radius = np.linalg.norm(points - centre, axis=1).max()
        best = min(best, radius)
    return best


@pytest.mark.parametrize("seed", range(20))
def test_no_circle_about_the_points_is_smaller(seed):
    points = np.random.default_rng(seed).normal(size=(9, 2)) * [3.0, 1.0]
    circle = least_circle(points)
    assert circle.radius == pytest.approx(least(points), rel=1e-9)
    assert np.linalg.norm(points - circle.centre, axis=1).max() <= circle.radius * (1 + 1e-8)


@pytest.mark.parametrize(
    ("points", "radius"),
    [
        ([[3.0, 1.0]] * 5, 0.0),
        ([[0.0, 0.0], [4.0, 0.0]], 2.0),
        ([[float(k), 2.0 * k] for k in range(8)], 3.5 * 5**0.5),
        ([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 0.0]], 0.5),
    ],
)
def test_points_at_one_place_and_on_a_line_have_a_circle(points, radius):
    assert least_circle(np.array(points)).radius == pytest.approx(radius)


def test_the_circle_of_the_paper_may_leave_points_outside_and_the_least_one_does_not():
    turn = np.radians([90.0, 210.0, 330.0])
    corners = np.column_stack([np.cos(turn), np.sin(turn), [5.0, 6.0, 9.0]])
    paper, ours = printed(corners, 0.0), enclosing(corners, 0.0)
    assert paper.radius == pytest.approx(3**0.5 / 2)
    assert outside(paper, corners) == pytest.approx(1 / 3)
    assert ours.radius == pytest.approx(1.0)
    assert outside(ours, corners) == 0.0
    assert (ours.bottom, ours.top) == (5.0, 9.0)
    assert enclosing(corners - [0, 0, 2.5], 0.0).bottom == 0.0
