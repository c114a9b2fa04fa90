"""The surfaces that may hide a target: terrain, scenes and buildings, without what of them is the target.

A building that is filmed, or a statue that is scanned, is a part of a mesh and a target at once. What of a
mesh lies within the bodies of a standing target, or OWN_M about them, is its own, and hides nothing of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Solid
from shotc.geom.surface.sight import hidden, upright
from shotc.geom.surface.tree import Surface, surface_of
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh

OWN_M = 0.5
"""Metres about a target's bodies: footprints and scans are rarely as exact as the author's numbers."""

RAYS = 3
"""Along each side of what stands in for a target where viewpoints are chosen."""


def surfaces_before(mission: MissionIR, target: str) -> tuple[tuple[str, Surface], ...]:
    """Return, by sort and name, the surfaces that may hide a target; name : of the target."""
    own = tuple(
        body.solid for body in mission.targets if body.name in mission.one_with(target) and body.track is None
    )
    found = [(f"{mesh.kind} {mesh.file}", _without(mesh, own)) for mesh in mission.meshes]
    if mission.terrain is not None:
        found.insert(0, (f"terrain {mission.terrain.file}", mission.terrain.ground.surface))
    return tuple(found)


def share_hidden(surface: Surface, eyes: Array, centres: Array, radius: float, height: float) -> Array:
    """Return the share that a surface hides of upright cylinders about centres (N, 3) from eyes (N, 3); (N,).

    It is judged by rays to upright rectangles before the cylinders: what stands within its own radius is part
    of it.
    """
    boards = upright(eyes, centres, radius, height)
    return np.asarray(hidden(surface, boards, RAYS).mean(axis=(1, 2)))


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
def _without(mesh: ObstacleMesh, own: tuple[Solid, ...]) -> Surface:
    """Return the surface of a mesh without triangles all of whose corners are in solids, or next to them."""
    corners = mesh.surface.triangles.reshape(-1, 3)
    beside = np.zeros(len(corners), dtype=bool)
    for solid in own:
        beside |= distances(solid, corners) <= OWN_M
    its = beside.reshape(-1, 3).all(axis=1)
    return surface_of(mesh.surface.triangles[~its]) if its.any() else mesh.surface
