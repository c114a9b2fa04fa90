"""A smooth spline fitted to samples, and points moved into their bounds."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bspline import energy_rows, greville, restrict, spline, subdivide
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import TOUCH_TOLERANCE, Fit, fit, within


def test_what_is_out_of_its_bounds_is_moved_to_them_and_rounding_is_left() -> None:
    points = np.array(
        [
            -3.0,
            -1.0 - 0.5 * TOUCH_TOLERANCE,
            0.2,
            1.0 + 0.5 * TOUCH_TOLERANCE,
            1.0 + 2.0 * TOUCH_TOLERANCE,
            9.0,
        ]
    )
    found = within(points, -1.0, 1.0)
    assert found.tolist() == [-1.0, points[1], 0.2, points[3], 1.0, 1.0]


def test_every_point_has_bounds_of_its_own() -> None:
    points = np.array([[0.0, 5.0], [0.0, 5.0]])
    low, high = np.array([[-1.0, 6.0], [1.0, 0.0]]), np.array([[1.0, 7.0], [2.0, 4.0]])
    assert within(points, low, high).tolist() == [[0.0, 6.0], [1.0, 4.0]]


@pytest.mark.parametrize("length", [0.05, 2.4, 40.0, 3000.0])
@pytest.mark.parametrize("pieces", [2, 20, 60])
def test_values_that_hardly_weigh_pull_a_curve_without_anchors_to_their_mean(
    length: float, pieces: int
) -> None:
    """A short stiff leg once gave a singular system, whose solution was not a number."""
    breaks = np.linspace(0.0, length, pieces + 1)
    at = (breaks[:-1] + breaks[1:]) / 2
    value, weight = np.sin(np.arange(pieces)), np.full(pieces, 1e-14 / length)
    none, stiff = np.empty(0), (1.0, min(4.0, length) ** 4)
    status, coef = fit(Fit(breaks, at, value, weight, none, none, stiff))
    assert status is Status.SOLVED
    assert np.abs(coef - value.mean()).max() < 1e-5  # ten times the rounding of 60 pieces in 5 cm


@pytest.mark.parametrize("beyond", [5e-7, 1e-3])
def test_a_fit_that_is_a_little_beyond_its_bound_is_bounded(beyond: float) -> None:
    breaks = np.linspace(0.0, 4.0, 5)
    at, none, ones = (breaks[:-1] + breaks[1:]) / 2, np.empty(0), np.ones(4)
    low, high = np.full((4, 6), -1.0), np.ones((4, 6))
    status, coef = fit(Fit(breaks, at, (1.0 + beyond) * ones, ones, none, none, (1.0, 1.0), low, high))
    assert status is Status.SOLVED
    assert coef.max() <= 1.0 + 1e-8
    assert coef == pytest.approx(1.0, abs=1e-3)


@pytest.mark.slow
def test_more_pieces_bring_a_bounded_fit_no_further_from_its_optimum() -> None:
    """A heading between two borders that turn at the end. With 70 pieces it once swung by 14 deg beside its
    optimum, called solved: a spline on finer pieces may do all that one on coarser pieces does.
    """
    coarse, stiff = np.linspace(0.0, 16.0, 11), (1.0, 67.0)
    turning = spline(coarse, 0.58 * ((greville(coarse) / 16.0) ** 6)[:, None])
    none, costs = np.empty(0), []
    for parts in (1, 3, 7, 14):
        breaks = subdivide(coarse, parts)
        camera = restrict(turning, breaks).ctrl[:, :, 0]
        ends, anchors = breaks[[0, -1]], np.array([0.1745, 0.58 - 0.1745])
        status, coef = fit(
            Fit(breaks, none, none, none, ends, anchors, stiff, camera - 0.175, camera + 0.175)
        )
        assert status is Status.SOLVED
        energies = (energy_rows(breaks, order).apply(coef[:, None]) for order in (1, 3))
        costs.append(sum(each * float((e**2).sum()) for each, e in zip(stiff, energies, strict=True)))
        assert np.abs(spline(breaks, coef[:, None]).ctrl[:, :, 0] - camera).max() <= 0.175 + 1e-7
    assert max(costs) <= (1.0 + 1e-6) * costs[0]
