"""Paths through waypoints of machines whose curves are not published.

Every leg, from one point to the next, has the same number of samples. DJI states only "third-order Bezier
curve"; its flights look like a centripetal Catmull-Rom spline. Litchi rounds corners with a quadratic Bezier
curve.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import bernstein_basis

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

Tangents = Callable[[Array], tuple[Array, Array]]
"""From points (m, 3) to the handles of each leg, (m - 1, 3) each: from its start, and back from its end."""

SHORTEST_M = 1e-9  # metres, in place of a length of zero


def through(points: Array, stops: Mask, tangents: Tangents, count: int, *, cut: bool) -> Array:
    """Return samples (m - 1, count + 1, 3) of the cubics through points (m, 3), metres.

    stops : (m,), whether the machine stands still at a point
    cut : whether the curve begins anew at a stop
    """
    ctrl = cubics(points, stops, tangents, cut=cut)
    basis = bernstein_basis(3, np.linspace(0.0, 1.0, count + 1))
    return np.asarray(np.einsum("tk,mkd->mtd", basis, ctrl))


def cubics(points: Array, stops: Mask, tangents: Tangents, *, cut: bool) -> Array:
    """Return the Bernstein control points (m - 1, 4, 3) of the legs of ``through``."""
    ends = [0, len(points) - 1]
    if cut:
        ends[1:1] = (int(i) for i in np.flatnonzero(stops) if 0 < i < len(points) - 1)
    legs = []
    for first, last in pairwise(ends):
        run = points[first : last + 1]
        leave, reach = tangents(run)
        legs.append(np.stack([run[:-1], run[:-1] + leave, run[1:] - reach, run[1:]], axis=1))
    return np.concatenate(legs)


def straight(points: Array) -> tuple[Array, Array]:
    """Return the handles of straight legs, (m - 1, 3) each, for points (m, 3)."""
    third = np.diff(points, axis=0) / 3
    return third, third


def catmull_rom(alpha: float) -> Tangents:
    """Return Catmull-Rom tangents (Yuksel, Schaefer and Keyser, "Parameterization and applications of
    Catmull-Rom curves", 2011). End points are mirrored.

    alpha : 0 uniform, 0.5 centripetal, 1 chordal
    """

    def tangents(points: Array) -> tuple[Array, Array]:
        steps = np.diff(points, axis=0)
        steps = np.concatenate([steps[:1], steps, steps[-1:]])
        knots = np.maximum(np.linalg.norm(steps, axis=1), SHORTEST_M)[:, None] ** alpha
        before, after = knots[:-1], knots[1:]
        rate = steps[:-1] / before - (steps[:-1] + steps[1:]) / (before + after) + steps[1:] / after
        span = knots[1:-1]
        return rate[:-1] * span / 3, rate[1:] * span / 3

    return tangents


def handles(share: float) -> Tangents:
    """Return tangents parallel to the chord between a point's neighbours, with handles of ``share`` of the
    leg.
    """

    def tangents(points: Array) -> tuple[Array, Array]:
        steps = np.diff(points, axis=0)
        along = np.concatenate([steps[:1], points[2:] - points[:-2], steps[-1:]])
        along = along / np.maximum(np.linalg.norm(along, axis=1), SHORTEST_M)[:, None]
        length = share * np.linalg.norm(steps, axis=1)[:, None]
        return along[:-1] * length, along[1:] * length

    return tangents


def natural(points: Array) -> tuple[Array, Array]:
    """Return the handles of the natural cubic spline parameterised by chord length, for points (m, 3)."""
    steps = np.diff(points, axis=0)
    span = np.maximum(np.linalg.norm(steps, axis=1), SHORTEST_M)
    count = len(points)
    matrix, right = np.zeros((count, count)), np.zeros((count, 3))
    rows = np.arange(1, count - 1)
    matrix[rows, rows - 1], matrix[rows, rows + 1] = 1 / span[:-1], 1 / span[1:]
    matrix[rows, rows] = 2 / span[:-1] + 2 / span[1:]
    right[rows] = 3 * (steps[:-1] / span[:-1, None] ** 2 + steps[1:] / span[1:, None] ** 2)
    matrix[0, 0], matrix[-1, -1] = 2 / span[0], 2 / span[-1]
    matrix[0, 1], matrix[-1, -2] = 1 / span[0], 1 / span[-1]
    right[0], right[-1] = 3 * steps[0] / span[0] ** 2, 3 * steps[-1] / span[-1] ** 2
    rate = np.linalg.solve(matrix, right)
    return rate[:-1] * span[:, None] / 3, rate[1:] * span[:, None] / 3


def rounded(points: Array, sizes: Array, count: int) -> Array:
    """Return samples (m - 1, count + 1, 3) of straight legs with quadratic Bezier curves at the corners.

    A leg begins and ends at the middle of a curve, so it does not pass through its inner points.

    sizes : (m,), metres from an inner point to both ends of its curve
    """
    ctrl, bend = corners(points, sizes), count // 8
    bent = bernstein_basis(3, np.linspace(0.0, 1.0, bend + 1))
    straight = bernstein_basis(3, np.linspace(0.0, 1.0, count - 2 * bend + 1)[1:-1])
    parts = [np.einsum("tk,mkd->mtd", basis, ctrl[:, i]) for i, basis in enumerate((bent, straight, bent))]
    return np.concatenate(parts, axis=1)


def corners(points: Array, sizes: Array) -> Array:
    """Return the Bernstein control points (m - 1, 3, 4, 3) of the legs of ``rounded``: curve, line, curve."""
    steps = np.diff(points, axis=0)
    unit = steps / np.maximum(np.linalg.norm(steps, axis=1), SHORTEST_M)[:, None]
    size = sizes.copy()[:, None]
    size[0] = size[-1] = 0.0
    before, after = np.concatenate([unit[:1], unit]), np.concatenate([unit, unit[-1:]])
    start, end = points - size * before, points + size * after
    middle = 0.25 * start + 0.5 * points + 0.25 * end
    leave = np.stack([middle, 0.5 * (points + end), end], axis=1)[:-1]
    reach = np.stack([start, 0.5 * (start + points), middle], axis=1)[1:]
    thirds = np.linspace(0.0, 1.0, 4)[None, :, None]
    line = leave[:, 2:] + thirds * (reach[:, :1] - leave[:, 2:])
    return np.stack([_raised(leave), line, _raised(reach)], axis=1)


def _raised(quadratic: Array) -> Array:
    """Return quadratics (m, 3, 3) as cubics (m, 4, 3)."""
    a, b, c = quadratic[:, 0], quadratic[:, 1], quadratic[:, 2]
    return np.stack([a, (a + 2 * b) / 3, (2 * b + c) / 3, c], axis=1)
