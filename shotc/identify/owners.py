"""Buildings of their own in meshes: what is not linked with its neighbour, however near that stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.identify.clusters import NOBODY
from shotc.identify.views import ON_GROUND_M
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.terrain import ground_heights


@dataclass(frozen=True, slots=True, eq=False)
class Owners:
    """Of each triangle that a mesh was made of the building that it belongs to.

    owner : shape (n,), its number, NOBODY where that is not known
    foot  : shape (n,), the lowest z of that building, metres; inf where it is not known
    """

    owner: IntArray
    foot: Array


def owners_of(mission: MissionIR, mesh: ObstacleMesh) -> Owners:
    """Return whom the triangles of a mesh belong to.

    Of footprints each is a building. Of a scene it is a closed body that stands on the ground: a roof or a
    chimney belongs to what it is on.
    """
    owner = mesh.part if mesh.kind == "buildings" else mesh.body
    known = np.ones(len(owner), dtype=bool) if mesh.kind == "buildings" else mesh.closed[mesh.body]
    foot = np.full(len(owner), np.inf)
    if not known.any():
        return Owners(np.full(len(owner), NOBODY), foot)
    lowest = _lowest(mesh, owner)
    over = ground_heights(mission, lowest[:, :2])
    stands = lowest[:, 2] <= over + ON_GROUND_M
    if mesh.kind == "scene":
        known &= stands[owner]
    foot[known] = lowest[owner[known], 2]
    return Owners(np.where(known, owner, NOBODY), foot)


def _lowest(mesh: ObstacleMesh, owner: IntArray) -> Array:
    """Return the lowest corner of each owner, by its number, shape (owners, 3); inf for a number of none."""
    triangles = mesh.surface.triangles
    corner = triangles[np.arange(len(triangles)), triangles[..., 2].argmin(axis=1)]
    of = owner[mesh.surface.source]
    order = np.lexsort((corner[:, 2], of))
    numbers, first = np.unique(of[order], return_index=True)
    out = np.full((int(owner.max()) + 1, 3), 0.0)
    out[numbers] = corner[order[first]]
    return out
