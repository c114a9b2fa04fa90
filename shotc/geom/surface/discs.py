"""Points of clouds as occluders: each is a disc perpendicular to every ray that passes it.

A point is near only few rays of a frame. So only the cells of a billboard around the point's projection are
tested.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.surface.boards import Billboards
from shotc.geom.surface.triangles import TINY_SQUARE, cross, dot

STEEP_COSINE = 0.1
"""Cosine of the angle between a line of sight and a billboard's normal, below which all its cells are
tested."""


def stopped_by_discs(
    of: tuple[Array, IntArray], boards: Billboards, reach: Array, radius: float
) -> tuple[IntArray, IntArray]:
    """Return which rays discs block: their frames and their cells, (S,) each, with repetitions.

    of : the points, (K, 3), metres of W, and the frame of each, (K,); radius : of the discs, metres
    reach : share of the way to a cell at which its ray ends, (F, n, n); a point nearer than the radius to
        that end is a part of the target
    """
    (points, frame), n = of, reach.shape[1]
    offset = points - boards.eye[frame]
    first, last = _cells_about(offset, frame, boards, radius, n)
    wide = np.maximum(last - first + 1, 0)
    count = wide[:, 0] * wide[:, 1]
    pair = np.repeat(np.arange(len(points)), count)
    number = np.arange(len(pair)) - np.repeat(np.cumsum(count) - count, count)
    a = first[pair, 0] + number // wide[pair, 1]
    b = first[pair, 1] + number % wide[pair, 1]
    its, to = frame[pair], offset[pair]
    ray = boards.corner[its] - boards.eye[its]
    ray = ray + ((a + 0.5) / n)[:, None] * boards.right[its] + ((b + 0.5) / n)[:, None] * boards.up[its]
    square = np.maximum(dot(ray, ray), TINY_SQUARE)
    along = dot(to, ray) / square
    off = dot(to, to) - along**2 * square
    met = (along > 0.0) & (off <= radius**2) & (along + radius / np.sqrt(square) < reach[its, a, b])
    return its[met], (a * n + b)[met]


def _cells_about(
    offset: Array, frame: IntArray, boards: Billboards, radius: float, n: int
) -> tuple[IntArray, IntArray]:
    """Return the first and last cell, along right and up, whose rays may meet discs, (K, 2) each.

    offset : the points minus the eyes of their frames, (K, 3), metres
    A ray that meets a disc of radius r passes its point, at depth d and distance l, by at most r, and at a
    depth of d - r or more. So it meets the board, at depth D, within r D l / (d (d - r)) of the point's
    projection.
    """
    normal = cross(boards.right, boards.up)
    normal /= np.maximum(np.sqrt(dot(normal, normal)), TINY_SQUARE)[:, None]
    corner = boards.corner - boards.eye
    depth = dot(normal, corner)
    side = np.sign(depth)
    far, deep = np.sqrt(dot(offset, offset)), dot(offset, normal[frame]) * side[frame]
    cosine = (deep - radius) / np.maximum(far, TINY_SQUARE)
    clear = cosine > STEEP_COSINE
    share = np.where(clear, deep / np.maximum(np.abs(depth), TINY_SQUARE)[frame], 1.0)
    on = offset / share[:, None] - corner[frame]
    reach = radius / np.where(clear, share * cosine, 1.0)
    first, last = np.zeros((2, len(offset), 2), dtype=np.intp)
    for k, edge in enumerate((boards.right, boards.up)):
        square = np.maximum(dot(edge, edge), TINY_SQUARE)[frame]
        at, half = dot(on, edge[frame]) / square, reach / np.sqrt(square)
        low, high = np.ceil((at - half) * n - 0.5), np.floor((at + half) * n - 0.5)
        first[:, k] = np.where(clear, np.clip(low, 0, n), 0)
        last[:, k] = np.where(clear, np.clip(high, -1, n - 1), n - 1)
    behind = deep < -radius
    last[behind] = first[behind] - 1
    return first, last
