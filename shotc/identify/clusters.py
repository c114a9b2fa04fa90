"""Points that belong together: what rays of all keyframes hit, linked where they lie as near as rays do."""

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
"""Side of the cells of which one point each is linked."""
LINK_FOOTPRINTS, LEAST_LINK_M, MOST_LINK_M = 2.5, 0.9, 6.0
"""Points are linked that are nearer than so many footprints of their rays, within these bounds."""
LEAST_POINTS = 25
"""Points in boxes of what may be a target."""
NOBODY = -1
LOOSE = -1


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """What rays of keyframes hit above the ground.

    point     : shape (P, 3), metres of W
    footprint : shape (P,), how wide a ray is there, metres
    owner     : shape (P,), the number of the building that each belongs to; NOBODY where that is not known
    foot      : shape (P,), the lowest z of that building, metres; inf where it is not known
    keyframe  : shape (P,), the number of the keyframe whose ray it is
    place     : shape (P, 2), where in the box the ray goes, across and up: -1 to 1, more beside the box
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
        """Tell which rays go through the boxes, shape (P,); sides : of the boxes, as shares of theirs."""
        return np.asarray((np.abs(self.place) <= sides).all(axis=1))


def clusters(points: Points) -> IntArray:
    """Return the number of each point's cluster, shape (P,); LOOSE where it is too small to be a target.

    Points of two different owners are not linked, however near. Clusters are numbered by their size.
    """
    if not len(points):
        return np.zeros(0, dtype=np.intp)
    cells = np.column_stack([np.floor(points.point / VOXEL_M).astype(np.int64), points.owner])
    _, kept, of = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    linked = _linked(points.point[kept], points.footprint[kept], points.owner[kept])
    label = linked[of.ravel()]
    counts = np.bincount(label[points.within()], minlength=len(kept))
    rank = np.full(len(counts), LOOSE)
    large = np.flatnonzero(counts >= LEAST_POINTS)
    rank[large[np.argsort(-counts[large], kind="stable")]] = np.arange(len(large))
    return np.asarray(rank[label])


def _linked(point: Array, footprint: Array, owner: IntArray) -> IntArray:
    """Return the connected component of each point, shape (K,)."""
    link = np.clip(LINK_FOOTPRINTS * footprint, LEAST_LINK_M, MOST_LINK_M)
    pairs = cKDTree(point).query_pairs(float(link.max()), output_type="ndarray")
    a, b = pairs[:, 0], pairs[:, 1]
    near = np.linalg.norm(point[a] - point[b], axis=1) <= np.minimum(link[a], link[b])
    parted = (owner[a] != owner[b]) & (owner[a] != NOBODY) & (owner[b] != NOBODY)
    a, b = a[near & ~parted], b[near & ~parted]
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(len(point), len(point)))
    return np.asarray(connected_components(graph, directed=False)[1])
