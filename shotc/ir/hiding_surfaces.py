"""The surfaces that may hide a target: terrain, scenes and buildings, without the target's own triangles.

A filmed building or a scanned statue is a part of a mesh and a target at once. Triangles of a mesh within the
bodies of a standing target, or within OWN_M of them, are its own and hide nothing of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.framing import hidden as behind_any
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Solid
from shotc.geom.surface.boards import cells_of, upright
from shotc.geom.surface.cloud import splats
from shotc.geom.surface.occlusion import hidden
from shotc.geom.surface.tree import Surface, surface_of
from shotc.geom.surface.triangles import without_size
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh

OWN_M = 0.5
"""Distance from a target's bodies up to which triangles are its own, metres: footprints and scans are rarely
as exact as the author's numbers."""

DISC_SPACINGS = 4.0
"""Radius of the discs that stand for a cloud's points, in halves of their spacing; few rays pass between."""

MOST_DISCS = 200_000
"""Most discs of a cloud; beyond it they get larger and fewer."""

RAYS_PER_SIDE = 3
"""Rays along each side of the rectangle that stands in for a target in the choice of viewpoints."""


class NamedParts(NamedTuple):
    """The surface of a mesh of several parts, without the triangles of a target.

    mesh : the whole mesh; part : shape (N,), the number of the part that each triangle belongs to
    """

    mesh: ObstacleMesh
    surface: Surface
    part: IntArray


def surfaces_before(mission: MissionIR, target: str) -> tuple[tuple[str, Surface], ...]:
    """Return the surfaces that may hide a target, each with its sort and name; target : its name."""
    own = _bodies(mission, target)
    surfaces = [(_label(mesh), _without(mesh, own).surface) for mesh in mission.meshes]
    if mission.terrain is not None:
        surfaces.insert(0, (f"terrain {mission.terrain.file}", mission.terrain.ground.surface))
    return tuple(surfaces)


def parts_before(mission: MissionIR, target: str) -> dict[str, NamedParts]:
    """Return the meshes of several parts that may hide a target, by sort and name as in
    ``surfaces_before``.
    """
    own = _bodies(mission, target)
    return {_label(mesh): _without(mesh, own) for mesh in mission.meshes if len(mesh.names) > 1}


def _label(mesh: ObstacleMesh) -> str:
    return f"{mesh.kind} {mesh.file}"


def _bodies(mission: MissionIR, target: str) -> tuple[Solid, ...]:
    """Return the standing bodies of a target and of its group."""
    one = mission.one_with(target)
    return tuple(body.solid for body in mission.targets if body.name in one and body.track is None)


def share_hidden(surface: Surface, eyes: Array, centres: Array, radius: float, height: float) -> Array:
    """Return the share that a surface hides of upright cylinders about centres (N, 3) from eyes (N, 3), (N,).

    Rays lead to upright rectangles in front of the cylinders, so that what stands within the radius of a
    cylinder counts as a part of it.
    radius, height : of the cylinders, metres
    """
    boards = upright(eyes, centres, radius, height)
    return np.asarray(hidden(surface, boards, RAYS_PER_SIDE).mean(axis=(1, 2)))


def share_behind(solids: Sequence[Solid], eyes: Array, centres: Array, radius: float, height: float) -> Array:
    """Return the share that solids hide of such cylinders, by the same rays, shape (N,); as
    ``share_hidden``.
    """
    cells = cells_of(upright(eyes, centres, radius, height), RAYS_PER_SIDE)
    behind = behind_any(np.repeat(eyes, RAYS_PER_SIDE * RAYS_PER_SIDE, axis=0), cells, solids)
    return np.asarray(behind.reshape(len(eyes), -1).mean(axis=1))


def shares_hidden_by(
    mission: MissionIR, target: str, eyes: Sequence[tuple[float, Vec3]]
) -> Iterator[tuple[str, list[float]]]:
    """Yield the surfaces that may hide a target, with sort and name, and the share that each hides.

    eyes : mission times, seconds, and the camera's positions then, metres of W; there is a share for each
    """
    of = mission.target(target)
    places, centres = np.array([eye for _, eye in eyes]), np.array([of.at(t) for t, _ in eyes])
    for name, surface in surfaces_before(mission, target):
        yield name, share_hidden(surface, places, centres, of.radius, of.height).tolist()


@lru_cache(maxsize=16)
def _without(mesh: ObstacleMesh, own: tuple[Solid, ...]) -> NamedParts:
    """Return a mesh without the triangles all of whose corners are in or near the solids ``own``."""
    corners, part = mesh.surface.triangles.reshape(-1, 3), mesh.part[mesh.surface.source]
    beside = np.zeros(len(corners), dtype=bool)
    for solid in own:
        beside |= distances(solid, corners) <= OWN_M
    others: Mask = ~np.asarray(beside.reshape(-1, 3).all(axis=1))
    if mesh.spacing > 0.0:
        return _of_discs(mesh, others)
    if others.all():
        return NamedParts(mesh, mesh.surface, part)
    surface = surface_of(mesh.surface.triangles[others])
    return NamedParts(mesh, surface, part[others][surface.source])


def _of_discs(mesh: ObstacleMesh, which: Mask) -> NamedParts:
    """Return the selected triangles of a mesh with loose points; discs stand for the points."""
    triangles, part = mesh.surface.triangles[which], mesh.part[mesh.surface.source][which]
    loose = without_size(triangles)
    disc = DISC_SPACINGS * mesh.spacing
    if loose.any():
        discs = splats(triangles[loose, 0], disc, MOST_DISCS)
        points = np.repeat(discs.middle[:, None, :], 3, axis=1)
        triangles = np.concatenate([triangles[~loose], points])
        part, disc = np.concatenate([part[~loose], part[loose][discs.first]]), discs.size
    surface = replace(surface_of(triangles), disc=disc)
    return NamedParts(mesh, surface, part[surface.source])
