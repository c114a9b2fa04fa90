"""Proved bounds on an integral, by Bernstein hulls that are halved until the bounds are tight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.pieces import Pieces
from shotc.geom.proof import Value

MOST_HALVINGS = 12
"""Most halvings; each divides the gap by four."""


class Between(NamedTuple):
    """Bounds on an integral."""

    low: float
    high: float


def integral_convex(pieces: Pieces, value: Value, share: float) -> Between:
    """Bound the integral of a convex function along polynomial pieces, over their parameter.

    value : convex and not negative, maps control points (..., D) to numbers (...)
    share : admissible difference of the bounds, as a share of the integral
    The curve is a mean of its control points with weights that integrate to 1 / (n + 1). So the function's
    mean is at most the mean of its values at the control points and, by Jensen's inequality, at least its
    value at their mean.
    """
    low, high = 0.0, 0.0
    for left in range(MOST_HALVINGS, -1, -1):
        if not len(pieces):
            break
        widths = pieces.high - pieces.low
        above = widths * value(pieces.ctrl).mean(axis=1)
        below = widths * value(pieces.ctrl.mean(axis=1))
        total = high + float(above.sum())
        is_open = (above - below) * len(pieces) > share * total if left else np.zeros(len(pieces), dtype=bool)
        low, high = low + float(below[~is_open].sum()), high + float(above[~is_open].sum())
        pieces = pieces.pick(is_open).halves()
    return Between(low, high)
