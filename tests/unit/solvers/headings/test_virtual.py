"""The angle of a virtual curve: there is none where the curve passes through the origin."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.solvers.headings import virtual

BREAKS = np.array([0.0, 2.0])
STRAIGHT_ON = Piecewise(BREAKS, np.zeros((1, 4, 1)))


def line(start: tuple[float, float], end: tuple[float, float]) -> Piecewise:
    return Piecewise(BREAKS, np.linspace(start, end, 4)[None])


def real(point: Piecewise) -> Piecewise | None:
    return virtual._real(None, np.zeros(2), STRAIGHT_ON, point)


def test_there_is_no_angle_where_a_curve_passes_through_the_origin() -> None:
    assert real(line((1.0, 0.0), (-1.0, 0.0))) is None
    assert real(line((0.0, 0.0), (1.0, 1.0))) is None


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("width", [0.5, 2.0])
def test_a_cubic_is_that_of_its_values_and_slopes_at_the_ends(order: int, width: float) -> None:
    cubic = np.polynomial.Polynomial([0.3, -1.1, 0.7, 0.4])
    slope, x = cubic.deriv(), np.array([0.0, 0.3, 0.8, 1.0])
    ends = np.array([cubic(0.0), slope(0.0), cubic(width), slope(width)])
    found = virtual._weights(np.full(4, width), x, order) @ ends
    assert found == pytest.approx(cubic.deriv(order)(x * width) if order else cubic(x * width), abs=1e-12)
