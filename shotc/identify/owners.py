"""Separate buildings in meshes; points of different buildings are not linked, however near they are."""

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
    """The building of each triangle from which a mesh was made.

    owner : shape (n,), its number; NOBODY where it is unknown
    foot : shape (n,), lowest z of that building, metres; inf where it is unknown
    """

    owner: IntArray
    foot: Array


def owners_of(mission: MissionIR, mesh: ObstacleMesh) -> Owners:
    """Return the owners of the triangles of a mesh.

    Each footprint is a building. In a scene a building is a closed body that stands on the ground, with the
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
    """Return the lowest corner of each owner, shape (owners, 3); zeros for an unused number."""
    triangles = mesh.surface.triangles
    corner = triangles[np.arange(len(triangles)), triangles[..., 2].argmin(axis=1)]
    of = owner[mesh.surface.source]
    order = np.lexsort((corner[:, 2], of))
    numbers, first = np.unique(of[order], return_index=True)
    out = np.full((int(owner.max()) + 1, 3), 0.0)
    out[numbers] = corner[order[first]]
    return out


def _carriers(mesh: ObstacleMesh, stands: Mask) -> IntArray:
    """Return for each body the number of the body that carries it, or its own, shape (bodies,).

    A closed body stands on the one below with the largest common area of their bounding boxes, and so on
    whatever carries that one.

    stands : which bodies are closed and stand on the ground, (bodies,)
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
    """Return the lower and the upper corners of the bodies' bounding boxes, (bodies, 3) each, metres."""
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    of = mesh.body[mesh.surface.source]
    np.minimum.at(low, of, mesh.surface.triangles.min(axis=1))
    np.maximum.at(high, of, mesh.surface.triangles.max(axis=1))
    return low, high
