"""Points inside closed bodies, by the number of crossings of a ray with their triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.tree import Surface, search
from shotc.geom.surface.triangles import pierced

SAME_M = 1e-6  # metres; nearer corners are the same
RAYS = np.array([[0.0719, 0.0331, 1.0], [-0.0417, 0.0973, 1.0], [0.0233, -0.0871, 1.0]])
"""Directions of rays, parallel to no edge of usual buildings. Of the three, one may cross an edge."""


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """The body of each triangle, shape (N,), and whether each body has an inside."""

    body: IntArray
    closed: Mask


def bodies(triangles: Array) -> Bodies:
    """Return the bodies of triangles (N, 3, 3), metres: their components connected by edges.

    A body has an inside if every edge belongs to an even number of its triangles.
    """
    if not len(triangles):
        return Bodies(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=bool))
    number = _numbered(np.rint(triangles.reshape(-1, 3) / SAME_M).astype(np.int64)).reshape(-1, 3)
    ends = np.sort(np.concatenate([number[:, [0, 1]], number[:, [1, 2]], number[:, [2, 0]]]), axis=1)
    of = np.tile(np.arange(len(triangles)), 3)
    long = ends[:, 0] != ends[:, 1]
    ends, of = ends[long], of[long]
    order = np.argsort((ends[:, 0] << 32) | ends[:, 1], kind="stable")
    ends, of = ends[order], of[order]
    starts = np.flatnonzero(np.concatenate([[True], (ends[1:] != ends[:-1]).any(axis=1)])[: len(ends)])
    times = np.diff(np.append(starts, len(ends)))
    label = _connected(len(triangles), of, starts, times)
    roots, body = np.unique(label, return_inverse=True)
    closed = np.ones(len(roots), dtype=bool)
    closed[body[of[np.repeat(times % 2 == 1, times)]]] = False
    flat = np.ones(len(triangles), dtype=bool)  # a triangle without edges is a point of a cloud
    flat[of] = False
    closed[body[flat]] = False
    return Bodies(body, closed)


def _numbered(rows: IntArray) -> IntArray:
    """Return the index of each row (N, 3) among the distinct rows; shape (N,)."""
    order = np.lexsort(rows.T)
    ordered = rows[order]
    number = np.empty(len(rows), dtype=np.int64)
    number[order] = np.cumsum(np.concatenate([[False], (ordered[1:] != ordered[:-1]).any(axis=1)]))
    return number


def _connected(count: int, of: IntArray, starts: IntArray, times: IntArray) -> IntArray:
    """Return for each of ``count`` triangles the least index in its body; edges connect triangles.

    of : triangles edge by edge; begins, times : start of each edge's triangles in it, and their number
    In every round all triangles of an edge take their least label, then each takes the label of its label.
    The number of rounds grows with the logarithm of the longest chain (Shiloach and Vishkin 1982).
    """
    label = np.arange(count)
    while len(starts):
        least = np.repeat(np.minimum.reduceat(label[of], starts), times)
        before = label.copy()
        np.minimum.at(label, before[of], least)
        np.minimum.at(label, of, least)
        label = label[label]
        if (label == before).all():
            break
    return label


def inside(surface: Surface, body: IntArray, closed: Mask, p: Array) -> Mask:
    """Return which points (K, 3) are inside a closed body, by a majority of rays; (K,).

    body : shape (n,), of each triangle that the surface was made of; closed : of each body
    """
    votes = sum(_odd(surface, body, closed, p, ray).astype(int) for ray in RAYS)
    return np.asarray(2 * votes > len(RAYS))


def _odd(surface: Surface, body: IntArray, closed: Mask, p: Array, direction: Array) -> Mask:
    """Return for which points a ray crosses some closed body an odd number of times; (K,)."""
    out = np.zeros(len(p), dtype=bool)
    if not len(surface) or not closed.any() or not len(p):
        return out
    top = float(surface.high[-1][:, 2].max())
    end = p + np.maximum(top + 1.0 - p[:, 2:], 0.0) * direction

    def meets(item: IntArray, low: Array, high: Array) -> Mask:
        """Return which boxes a ray may meet, by its part between their lower and upper sides."""
        z = p[item, 2]
        first, last = np.maximum(low[:, 2] - z, 0.0), high[:, 2] - z
        met = last >= 0.0
        for axis in (0, 1):
            ends = p[item, axis] + direction[axis] * first, p[item, axis] + direction[axis] * last
            met &= (np.minimum(*ends) <= high[:, axis]) & (np.maximum(*ends) >= low[:, axis])
        return np.asarray(met)

    pairs = search(surface, len(p), meets)
    of = body[surface.source[pairs.triangle]]
    pairs, of = pairs.pick(closed[of]), of[closed[of]]
    crossed = pierced(surface.triangles[pairs.triangle], p[pairs.item], end[pairs.item])
    each, times = np.unique(np.column_stack([pairs.item[crossed], of[crossed]]), axis=0, return_counts=True)
    out[each[times % 2 == 1, 0]] = True
    return out
