"""Points moved into their bounds."""

from __future__ import annotations

import numpy as np

from shotc.solvers.spline_fit import TOUCH_TOLERANCE, within


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
