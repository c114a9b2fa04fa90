"""Smoothness of a curve at its breaks, relative to its scale."""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise

ROUNDING_SHARE = 16 * np.finfo(float).eps
ORDERS = ("value", "rate", "acceleration")


class Jump(NamedTuple):
    """The largest jump of a derivative, relative to its scale, and its parameter."""

    size: float
    at: float


def largest_jump(curve: Piecewise, order: int) -> Jump:
    """Return the largest jump of a derivative at a break, relative to its scale.

    The scale of a channel is its largest control value, at least one unit. The part that rounding of the
    control points can cause is subtracted: the n-th difference of values of size c over h carries 2^n c eps /
    h^n.
    """
    derived = curve.derivative(order).ctrl
    if len(derived) == 1:
        return Jump(0.0, curve.start)
    scale = np.maximum(1.0, np.abs(derived).max(axis=(0, 1)))
    jump = np.abs(derived[1:, 0] - derived[:-1, -1])
    excess = np.maximum(jump - _rounding(curve, order), 0.0) / scale
    k = int(np.argmax(excess.max(axis=1)))
    return Jump(float(excess[k].max()), float(curve.breaks[k + 1]))


def _rounding(curve: Piecewise, order: int) -> Array:
    width = np.diff(curve.breaks)
    shortest = np.minimum(width[1:], width[:-1])
    degree = curve.degree
    factor = factorial(degree) / factorial(max(degree - order, 0)) * 2**order
    size = np.abs(curve.ctrl).max(axis=(0, 1))
    return np.asarray(ROUNDING_SHARE * factor * size / shortest[:, None] ** order)
