"""The exact lowest ground below polygons in the plan. The ground is linear over each of its triangles.

So its minimum over a polygon is at a corner of the polygon, at a corner of a triangle, or where sides cross.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.surface.ground import Ground, height_at
from shotc.geom.surface.tree import in_plan
from shotc.geom.surface.triangles import TINY_SQUARE


def lowest_under(ground: Ground, rings: Sequence[Array]) -> Array:
    """Return the lowest ground (K,) below simple polygons, each of corners (n, 2), metres of W.

    It is NaN for a polygon without any ground. Parts of a polygon beyond the ground do not count.
    """
    if not rings:
        return np.zeros(0)
    starts = np.cumsum([0, *map(len, rings)])[:-1]
    corners = height_at(ground, np.concatenate(rings))
    lowest = np.fmin.reduceat(corners, starts)
    low = np.array([ring.min(axis=0) for ring in rings])
    high = np.array([ring.max(axis=0) for ring in rings])
    pairs = in_plan(ground.surface, low, high)
    ends = np.searchsorted(pairs.item, np.arange(len(rings) + 1))
    for k, ring in enumerate(rings):
        triangles = ground.surface.triangles[pairs.triangle[ends[k] : ends[k + 1]]]
        if len(triangles):
            lowest[k] = np.fmin(lowest[k], _least(triangles, ring))
    return lowest


def _least(triangles: Array, ring: Array) -> float:
    """Return the least z of triangles' corners in a ring, and of crossings of their sides with the ring."""
    a, b = triangles.reshape(-1, 3), triangles[:, [1, 2, 0]].reshape(-1, 3)
    inside = a[in_ring(ring, a[:, :2]), 2]
    c, d = ring, np.roll(ring, -1, axis=0)
    along, across = (b - a)[:, None, :2], (d - c)[None]
    apart = c[None] - a[:, None, :2]
    turn = along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]
    turn = np.where(np.abs(turn) > TINY_SQUARE, turn, np.nan)  # parallel sides have their minimum at corners
    share = (apart[..., 0] * across[..., 1] - apart[..., 1] * across[..., 0]) / turn
    other = (apart[..., 0] * along[..., 1] - apart[..., 1] * along[..., 0]) / turn
    cross = (share >= 0.0) & (share <= 1.0) & (other >= 0.0) & (other <= 1.0)
    z = (a[:, None, 2] + share * (b - a)[:, None, 2])[cross]
    return float(np.concatenate([[np.inf], inside, z]).min()) if len(inside) or len(z) else float("nan")


def in_ring(ring: Array, points: Array) -> Mask:
    """Return which points (K, 2) are in a polygon of corners (n, 2), by crossing number; shape (K,)."""
    a, b = ring[None], np.roll(ring, -1, axis=0)[None]
    x, y = points[:, :1], points[:, 1:]
    rises = b[..., 1] - a[..., 1]
    at = a[..., 0] + (y - a[..., 1]) * (b[..., 0] - a[..., 0]) / np.where(rises == 0.0, 1.0, rises)
    return np.asarray((((a[..., 1] > y) != (b[..., 1] > y)) & (x < at)).sum(axis=1) % 2 == 1)
