"""Proves the separation of moves that all drones make in common, in closed form, without a search over pairs.

Let every control point of every drone be m + a x' + b g', with x' and g' its positions before and after
relative to the mean of each, and a, b >= 0 common to all drones. Then the squared distance of any two is at
least a^2 d0^2 + b^2 d1^2 (``geom.arcs``) if no two would have a smaller sum of squares with exchanged goals.
Nothing is assumed about the origin of the move: a and b are found by least squares from the control points,
and the residual is subtracted from the distance.
"""

from __future__ import annotations

from itertools import pairwise
from math import sqrt

import numpy as np

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.solvers.match import crossing

PIECE_PARTS = 16
"""Parts of a piece in each of which control points bound the least of a square."""
TOGETHER_M = 1e-3
"""Largest relative motion of drones that all move alike, as in a vertical climb."""
NEGATIVE_TOLERANCE = -1e-9
"""A scalar below zero by less is a rounding error."""


def common(coef: Array, apart: Distances) -> float:
    """Return a distance below which no two drones come, in the metric of the fleet, m; 0 if none is proved.

    Only for ellipsoids.

    coef : control points of a stretch of uniform pieces from stop to stop, shape (n, K, 3)
    """
    if apart.shape != "ellipsoid":
        return 0.0
    points = coef * np.array([1.0, 1.0, stretch(apart)])
    points = points - points.mean(axis=0)
    before, after = points[:, 0], points[:, -1]
    basis = np.stack([before.ravel(), after.ravel()], axis=1)
    flat = np.moveaxis(points, 1, -1).reshape(len(basis), -1)
    scalars = np.linalg.pinv(basis.T @ basis, rcond=1e-12, hermitian=True) @ (basis.T @ flat)
    off = np.moveaxis((flat - basis @ scalars).reshape(len(points), 3, -1), -1, 1)
    drift = points - before[:, None]
    drifted = float(np.sqrt(np.einsum("nkd,nkd->nk", drift, drift)).max())
    if drifted < TOGETHER_M:
        return nearest_pair(before) - 2.0 * drifted
    missed = float(np.sqrt(np.einsum("nkd,nkd->nk", off, off)).max())
    nearest = np.array([nearest_pair(before), nearest_pair(after)])
    # Positions are rounded after they are matched, so products may be slightly negative.
    lost = 2.0 * float(scalars.max(axis=1).prod()) * max(0.0, -crossing(before, after).product)
    least_square = _least(scalars * nearest[:, None]) ** 2 - lost
    return max(sqrt(max(least_square, 0.0)) - 2.0 * missed, 0.0)


def _least(scalars: Array) -> float:
    """Return a lower bound of the length of (a d0, b d1), from its control points (2, K); 0 if one is
    negative.
    """
    if (scalars < NEGATIVE_TOLERANCE).any():
        return 0.0
    windows = np.lib.stride_tricks.sliding_window_view(scalars, 4, axis=1)
    ends = np.linspace(0.0, 1.0, PIECE_PARTS + 1)
    least = np.inf
    for low, high in pairwise(ends.tolist()):
        # The blossom of a cubic gives its control points on a part from those of the spline.
        ctrl = np.stack([windows @ _weights(*at) for at in _triples(low, high)], axis=-1)
        middle = ctrl.mean(axis=-1)
        size = np.sqrt((middle**2).sum(axis=0))
        along = np.einsum("dpk,dp->pk", ctrl, middle / np.maximum(size, 1e-300))
        least = min(least, float(along.min()))
    return max(least, 0.0)


def _triples(low: float, high: float) -> list[tuple[float, float, float]]:
    return [(low, low, low), (low, low, high), (low, high, high), (high, high, high)]


def _weights(r: float, s: float, t: float) -> Array:
    """Return the weights of four control points of a uniform cubic B-spline in its blossom at r, s, t."""
    rows = np.eye(4)
    for degree, u in zip((3, 2, 1), (r, s, t), strict=True):
        share = (u + np.arange(degree - 1, -1, -1)) / degree
        rows = (1.0 - share)[:, None] * rows[:-1] + share[:, None] * rows[1:]
    return np.asarray(rows[0])
