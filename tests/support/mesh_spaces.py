"""Free spaces beside meshes, and missions with meshes put into them."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh, obstacle_mesh
from shotc.ir.owners import GROUND, mesh_owner
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.free_space import FreeSpace, Obstacle, Wall

CLEARANCE = 2.3
"""Metres from the drone's centre in these spaces."""


def made_of(*parts: Array) -> ObstacleMesh:
    """A mesh each of whose parts is one of those that are given, shapes (N, 3, 3)."""
    number = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    names = tuple(f"part {k}" for k in range(len(parts)))
    return obstacle_mesh("scene", "a.ply", np.concatenate(parts), (number, names))


def space_of(*parts: Array, obstacles: tuple[Obstacle, ...] = ()) -> FreeSpace:
    """The space above flat ground and beside a mesh of such parts."""
    mesh, floor = made_of(*parts), Wall(GROUND, (0.0, 0.0, 1.0), CLEARANCE, CLEARANCE)
    return FreeSpace(obstacles, (floor,), (), meshes=(BesideMesh(mesh_owner(mesh), mesh, CLEARANCE),))


def with_meshes(mission: MissionIR, *parts: Array) -> MissionIR:
    """The mission with a mesh in its world."""
    return mission._replace(meshes=(made_of(*parts),))
