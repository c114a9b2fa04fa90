"""Bounds of integrals against closed forms."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.integral import integral_convex
from shotc.geom.pieces import pieces
from shotc.geom.proof import norm

EVEN = Piecewise(np.array([1.0, 3.0, 4.0]), np.array([[[3.0, 4.0]] * 3, [[0.0, 2.0]] * 3]))
"""(3, 4) for two seconds, then (0, 2) for one."""

SWING = Piecewise(np.array([0.0, 2.0]), np.array([[[-1.0], [1.0]]]))
"""From -1 evenly to 1 in two seconds."""


@pytest.mark.parametrize("share", [0.1, 1e-3, 1e-6])
@pytest.mark.parametrize(
    ("curve", "value", "integral"),
    [
        (EVEN, norm, 2 * hypot(3.0, 4.0) + 2.0),
        (SWING, norm, 1.0),
        (SWING, lambda p: p[..., 0] ** 2, 2 / 3),
        (Piecewise(np.array([0.0, 3.0]), np.array([[[0.0], [0.0], [9.0]]])), lambda p: p[..., 0], 9.0),
    ],
)
def test_the_integral_lies_between_bounds_as_near_as_is_asked(curve, value, integral, share) -> None:
    found = integral_convex(pieces(curve), value, share)
    assert found.low - 1e-9 <= integral <= found.high + 1e-9
    assert found.high - found.low <= share * integral + 1e-9


def test_no_curve_has_no_integral() -> None:
    none = pieces(SWING).pick(np.array([False]))
    assert integral_convex(none, norm, 0.1) == (0.0, 0.0)
