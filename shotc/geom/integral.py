"""Bounds of an integral that hold: Bernstein hulls, halved until they are tight enough."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.pieces import Pieces
from shotc.geom.proof import Value

ROUNDS = 12
"""Halvings at most; each divides the gap by four."""


class Between(NamedTuple):
    """An integral lies between these two."""

    low: float
    high: float


def integral_convex(pieces: Pieces, value: Value, share: float) -> Between:
    """Bound the integral of a convex function along polynomial pieces, over their parameter.

    value : convex, maps control points (..., D) to numbers (...), none negative
    share : of the integral, by which the bounds may differ
    The curve is a mean of its control points with weights that integrate to 1 / (n + 1), so the function's
    mean is at most the mean of its values there, and (Jensen's inequality) at least its value at their mean.
    """
    low, high = 0.0, 0.0
    for left in range(ROUNDS, -1, -1):
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
