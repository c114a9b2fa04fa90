"""Which points are inside of what is closed: by how often a ray from them crosses its triangles."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.tree import Surface, search
from shotc.geom.surface.triangles import pierced

SAME_M = 1e-6  # metres: corners that are nearer are one
RAYS = np.array([[0.0719, 0.0331, 1.0], [-0.0417, 0.0973, 1.0], [0.0233, -0.0871, 1.0]])
"""Ways that rays go, along no edge of what people build: of three, one may pass through an edge."""


def closed_parts(triangles: Array, part: IntArray, count: int) -> Mask:
    """Tell which parts have an inside: every edge is an edge of two of their triangles, or of four.

    triangles : shape (N, 3, 3), metres; part : shape (N,), the part that each belongs to
    """
    closed = np.zeros(count, dtype=bool)
    if not len(triangles):
        return closed
    corners = np.rint(triangles.reshape(-1, 3) / SAME_M).astype(np.int64)
    number = np.unique(corners, axis=0, return_inverse=True)[1].reshape(-1, 3)
    edges = np.concatenate([number[:, [0, 1]], number[:, [1, 2]], number[:, [2, 0]]])
    of = np.tile(part, 3)
    edges, of = edges[edges[:, 0] != edges[:, 1]], of[edges[:, 0] != edges[:, 1]]
    used = np.column_stack([of, edges.min(axis=1), edges.max(axis=1)])
    each, times = np.unique(used, axis=0, return_counts=True)
    closed[np.unique(of)] = True
    closed[each[times % 2 == 1, 0]] = False
    return closed


def inside(surface: Surface, part: IntArray, closed: Mask, p: Array) -> Mask:
    """Tell which points (K, 3) are inside of a closed part; (K,).

    part : shape (n,), of each triangle that the surface was made of; closed : of each part
    """
    votes = sum(_odd(surface, part, closed, p, ray).astype(int) for ray in RAYS)
    return np.asarray(2 * votes > len(RAYS))


def _odd(surface: Surface, part: IntArray, closed: Mask, p: Array, way: Array) -> Mask:
    """Tell of which points a ray crosses some closed part an odd number of times; (K,)."""
    out = np.zeros(len(p), dtype=bool)
    if not len(surface) or not closed.any() or not len(p):
        return out
    top = max(float(high[:, 2].max()) for high in surface.high[-1:])
    end = p + np.maximum(top + 1.0 - p[:, 2:], 0.0) * way

    def meets(item: IntArray, low: Array, high: Array) -> Mask:
        """Tell which boxes a ray may meet: by the stretch of it between their lower and upper sides."""
        z = p[item, 2]
        first, last = np.maximum(low[:, 2] - z, 0.0), high[:, 2] - z
        met = last >= 0.0
        for axis in (0, 1):
            ends = p[item, axis] + way[axis] * first, p[item, axis] + way[axis] * last
            met &= (np.minimum(*ends) <= high[:, axis]) & (np.maximum(*ends) >= low[:, axis])
        return np.asarray(met)

    pairs = search(surface, len(p), meets)
    of = part[surface.source[pairs.triangle]]
    pairs, of = pairs.pick(closed[of]), of[closed[of]]
    crossed = pierced(surface.triangles[pairs.triangle], p[pairs.item], end[pairs.item])
    each, times = np.unique(np.column_stack([pairs.item[crossed], of[crossed]]), axis=0, return_counts=True)
    out[each[times % 2 == 1, 0]] = True
    return out
