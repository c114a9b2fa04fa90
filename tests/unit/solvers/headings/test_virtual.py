"""The angle of a virtual curve: there is none where the curve passes through the origin."""

from __future__ import annotations

import numpy as np

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
