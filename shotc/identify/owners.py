"""Buildings of their own in meshes: what is not linked with its neighbour, however near that stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
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

    Of footprints each is a building. Of a scene it is a closed body that stands on the ground, with the
    closed bodies that stand on it: a roof, a chimney, the tank of a water tower.
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
        owner = _carriers(mesh, stands & mesh.closed[: len(stands)])[owner]
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


def _carriers(mesh: ObstacleMesh, stands: Mask) -> IntArray:
    """Return of each body the number of that which it stands on, its own where there is none; (bodies,).

    stands : which bodies are closed and stand on the ground, (bodies,)

    A closed body stands on the one below whose box it shares the most of, and with that on what is below it.
    """
    on, carried = np.arange(len(stands)), stands.copy()
    low, high = _boxes(mesh, len(stands))
    above = np.flatnonzero(mesh.closed[: len(stands)] & ~stands & np.isfinite(low[:, 2]))
    for body in above[np.argsort(low[above, 2], kind="stable")]:
        shared = np.minimum(high[body, :2], high[:, :2]) - np.maximum(low[body, :2], low[:, :2])
        reaches = (low[:, 2] <= low[body, 2]) & (high[:, 2] >= low[body, 2] - ON_GROUND_M)
        beneath = carried & reaches & (shared > 0.0).all(axis=1)
        beneath[body] = False
        if beneath.any():
            on[body] = on[np.where(beneath, shared.prod(axis=1), -np.inf).argmax()]
            carried[body] = True
    return on


def _boxes(mesh: ObstacleMesh, count: int) -> tuple[Array, Array]:
    """Return the lower and the upper corners of the boxes about bodies, (bodies, 3) each, metres."""
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    of = mesh.body[mesh.surface.source]
    np.minimum.at(low, of, mesh.surface.triangles.min(axis=1))
    np.maximum.at(high, of, mesh.surface.triangles.max(axis=1))
    return low, high
