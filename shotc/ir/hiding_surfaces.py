"""The surfaces that may hide a target: terrain, scenes and buildings, without what of them is the target.

A building that is filmed, or a statue that is scanned, is a part of a mesh and a target at once. What of a
mesh lies within the bodies of a standing target, or OWN_M about them, is its own, and hides nothing of it.
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
from shotc.geom.surface.sight import hidden
from shotc.geom.surface.tree import Surface, surface_of
from shotc.geom.surface.triangles import without_size
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh

OWN_M = 0.5
"""Metres about a target's bodies: footprints and scans are rarely as exact as the author's numbers."""

DISC_SPACINGS = 4.0
"""Radius of the discs that stand for a cloud's points, in halves of their spacing: few rays slip through."""

MOST_DISCS = 200_000
"""Of a cloud; where there would be more they are larger, and fewer."""

RAYS = 3
"""Along each side of what stands in for a target where viewpoints are chosen."""


class NamedParts(NamedTuple):
    """The surface of a mesh of several parts, without what of it is a target.

    mesh : what it is of; part : shape (N,), of each of its triangles, the number of what it belongs to
    """

    mesh: ObstacleMesh
    surface: Surface
    part: IntArray


def surfaces_before(mission: MissionIR, target: str) -> tuple[tuple[str, Surface], ...]:
    """Return, by sort and name, the surfaces that may hide a target; name : of the target."""
    own = _bodies(mission, target)
    found = [(_called(mesh), _without(mesh, own).surface) for mesh in mission.meshes]
    if mission.terrain is not None:
        found.insert(0, (f"terrain {mission.terrain.file}", mission.terrain.ground.surface))
    return tuple(found)


def parts_before(mission: MissionIR, target: str) -> dict[str, NamedParts]:
    """Return, by sort and name as in ``surfaces_before``, the meshes of several parts."""
    own = _bodies(mission, target)
    return {_called(mesh): _without(mesh, own) for mesh in mission.meshes if len(mesh.names) > 1}


def _called(mesh: ObstacleMesh) -> str:
    return f"{mesh.kind} {mesh.file}"


def _bodies(mission: MissionIR, target: str) -> tuple[Solid, ...]:
    """Return the bodies of a target, and of what is one with it, that stand."""
    one = mission.one_with(target)
    return tuple(body.solid for body in mission.targets if body.name in one and body.track is None)


def share_hidden(surface: Surface, eyes: Array, centres: Array, radius: float, height: float) -> Array:
    """Return the share that a surface hides of upright cylinders about centres (N, 3) from eyes (N, 3); (N,).

    It is judged by rays to upright rectangles before the cylinders: what stands within its own radius is part
    of it.
    """
    boards = upright(eyes, centres, radius, height)
    return np.asarray(hidden(surface, boards, RAYS).mean(axis=(1, 2)))


def share_behind(solids: Sequence[Solid], eyes: Array, centres: Array, radius: float, height: float) -> Array:
    """Return the share that solids hide of such cylinders, by the same rays; as ``share_hidden``."""
    cells = cells_of(upright(eyes, centres, radius, height), RAYS)
    behind = behind_any(np.repeat(eyes, RAYS * RAYS, axis=0), cells, solids)
    return np.asarray(behind.reshape(len(eyes), -1).mean(axis=1))


def shares_hidden_by(
    mission: MissionIR, target: str, eyes: Sequence[tuple[float, Vec3]]
) -> Iterator[tuple[str, list[float]]]:
    """Yield surfaces that may hide a target, by sort and name, and the share of it that each hides.

    eyes : mission times, seconds, and the camera's places then, metres of W; a share for each
    """
    of = mission.target(target)
    places, centres = np.array([eye for _, eye in eyes]), np.array([of.at(t) for t, _ in eyes])
    for name, surface in surfaces_before(mission, target):
        yield name, share_hidden(surface, places, centres, of.radius, of.height).tolist()


@lru_cache(maxsize=16)
def _without(mesh: ObstacleMesh, own: tuple[Solid, ...]) -> NamedParts:
    """Return a mesh without triangles all of whose corners are in solids, or next to them."""
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
    """Return those triangles of a mesh with loose points, and the discs that stand for the points."""
    triangles, part = mesh.surface.triangles[which], mesh.part[mesh.surface.source][which]
    loose = without_size(triangles)
    disc = DISC_SPACINGS * mesh.spacing
    if loose.any():
        kept = splats(triangles[loose, 0], disc, MOST_DISCS)
        points = np.repeat(kept.middle[:, None, :], 3, axis=1)
        triangles = np.concatenate([triangles[~loose], points])
        part, disc = np.concatenate([part[~loose], part[loose][kept.first]]), kept.size
    surface = replace(surface_of(triangles), disc=disc)
    return NamedParts(mesh, surface, part[surface.source])
