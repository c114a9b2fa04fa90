"""Measures of headings: the paper's control effort, and the total rotation."""

from __future__ import annotations

from math import comb

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import subdivide

SAMPLES_PER_PIECE = 64  # samples of a piece, for the distance


def effort(curve: Piecewise) -> float:
    """Return the integral of the squared second derivative, exactly (rad^2 / s^3 over seconds)."""
    second = curve.derivative(2)
    m = second.degree
    gram = [
        [comb(m, i) * comb(m, j) / comb(2 * m, i + j) / (2 * m + 1) for j in range(m + 1)]
        for i in range(m + 1)
    ]
    each = np.einsum("pid,ij,pjd->p", second.ctrl, np.array(gram), second.ctrl)
    return float(each @ np.diff(curve.breaks))


def distance(curve: Piecewise) -> float:
    """Return the total rotation of the heading, rad: the sum of steps between close samples."""
    values: Array = curve(subdivide(curve.breaks, SAMPLES_PER_PIECE))
    return float(np.abs(np.diff(values, axis=0)).sum())
