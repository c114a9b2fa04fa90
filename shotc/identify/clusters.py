"""Clusters of points that rays of all keyframes hit; points are linked if they are as near as the rays'
spacing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask

VOXEL_M = 0.5
"""Side of the cells, each of which has one point in the linking, metres."""
LINK_FOOTPRINTS, LEAST_LINK_M, MOST_LINK_M = 2.5, 0.9, 6.0
"""Link distance in footprints of the rays, and its bounds in metres."""
LEAST_POINTS = 25
"""Least points in boxes of a cluster that may be a target."""
NOBODY = -1
LOOSE = -1


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """The points above the ground that rays of keyframes hit.

    point : shape (P, 3), W, metres
    footprint : shape (P,), width of a ray at the point, metres
    owner : shape (P,), number of the point's building; NOBODY where it is unknown
    foot : shape (P,), lowest z of that building, metres; inf where it is unknown
    keyframe : shape (P,), number of the ray's keyframe
    place : shape (P, 2), position of the ray in the box, across and up: -1 to 1, larger outside the box
    """

    point: Array
    footprint: Array
    owner: IntArray
    foot: Array
    keyframe: IntArray
    place: Array

    def __len__(self) -> int:
        return len(self.point)

    def within(self, sides: float = 1.0) -> Mask:
        """Return which rays pass through the boxes, shape (P,).

        sides : size of the boxes, relative to their own
        """
        return np.asarray((np.abs(self.place) <= sides).all(axis=1))


def clusters(points: Points) -> IntArray:
    """Return the number of each point's cluster, shape (P,); LOOSE where it is too small to be a target.

    Points of two different owners are not linked. Clusters are numbered by size, the largest first.
    """
    if not len(points):
        return np.zeros(0, dtype=np.intp)
    cells = np.column_stack([np.floor(points.point / VOXEL_M).astype(np.int64), points.owner])
    _, first, of = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    linked = _linked(points.point[first], points.footprint[first], points.owner[first])
    label = linked[of.ravel()]
    counts = np.bincount(label[points.within()], minlength=len(first))
    rank = np.full(len(counts), LOOSE)
    large = np.flatnonzero(counts >= LEAST_POINTS)
    rank[large[np.argsort(-counts[large], kind="stable")]] = np.arange(len(large))
    return np.asarray(rank[label])


def _linked(point: Array, footprint: Array, owner: IntArray) -> IntArray:
    """Return the number of the connected component of each point, shape (K,)."""
    link = np.clip(LINK_FOOTPRINTS * footprint, LEAST_LINK_M, MOST_LINK_M)
    pairs = cKDTree(point).query_pairs(float(link.max()), output_type="ndarray")
    a, b = pairs[:, 0], pairs[:, 1]
    near = np.linalg.norm(point[a] - point[b], axis=1) <= np.minimum(link[a], link[b])
    parted = (owner[a] != owner[b]) & (owner[a] != NOBODY) & (owner[b] != NOBODY)
    a, b = a[near & ~parted], b[near & ~parted]
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(len(point), len(point)))
    return np.asarray(connected_components(graph, directed=False)[1])
