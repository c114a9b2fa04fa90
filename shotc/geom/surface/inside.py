"""Which points are inside of what is closed: by how often a ray from them crosses its triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.tree import Surface, search
from shotc.geom.surface.triangles import pierced

SAME_M = 1e-6  # metres: corners that are nearer are one
RAYS = np.array([[0.0719, 0.0331, 1.0], [-0.0417, 0.0973, 1.0], [0.0233, -0.0871, 1.0]])
"""Ways that rays go, along no edge of what people build: of three, one may pass through an edge."""


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """The body of each triangle, shape (N,), and which bodies have an inside."""

    body: IntArray
    closed: Mask


def bodies(triangles: Array) -> Bodies:
    """Tell what triangles, shape (N, 3, 3), metres, make: bodies are connected by edges.

    One has an inside if every edge is an edge of two of its triangles, or of four.
    """
    if not len(triangles):
        return Bodies(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=bool))
    corners = np.rint(triangles.reshape(-1, 3) / SAME_M).astype(np.int64)
    number = np.unique(corners, axis=0, return_inverse=True)[1].reshape(-1, 3)
    ends = np.concatenate([number[:, [0, 1]], number[:, [1, 2]], number[:, [2, 0]]])
    of = np.tile(np.arange(len(triangles)), 3)
    long = ends[:, 0] != ends[:, 1]
    ends, of = np.sort(ends[long], axis=1), of[long]
    _, edge, times = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    # Triangles and edges are the nodes of one graph.
    count = len(triangles)
    links = coo_array((np.ones(len(of)), (of, count + edge.ravel())), shape=(count + len(times),) * 2)
    found, label = connected_components(links, directed=False)
    closed = np.ones(found, dtype=bool)
    closed[label[count:][times % 2 == 1]] = False
    flat = np.setdiff1d(np.arange(count), of)  # a triangle without edges is a point of a cloud
    closed[label[flat]] = False
    return Bodies(label[:count], closed)


def inside(surface: Surface, body: IntArray, closed: Mask, p: Array) -> Mask:
    """Tell which points (K, 3) are inside of a closed body; (K,).

    body : shape (n,), of each triangle that the surface was made of; closed : of each body
    """
    votes = sum(_odd(surface, body, closed, p, ray).astype(int) for ray in RAYS)
    return np.asarray(2 * votes > len(RAYS))


def _odd(surface: Surface, body: IntArray, closed: Mask, p: Array, way: Array) -> Mask:
    """Tell of which points a ray crosses some closed body an odd number of times; (K,)."""
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
    of = body[surface.source[pairs.triangle]]
    pairs, of = pairs.pick(closed[of]), of[closed[of]]
    crossed = pierced(surface.triangles[pairs.triangle], p[pairs.item], end[pairs.item])
    each, times = np.unique(np.column_stack([pairs.item[crossed], of[crossed]]), axis=0, return_counts=True)
    out[each[times % 2 == 1, 0]] = True
    return out
