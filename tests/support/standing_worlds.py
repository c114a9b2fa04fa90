"""Terrain and houses about the origin of W for shows made by hand, with answers computed without a tree."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.surface.ground import ground_of
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh, obstacle_mesh
from shotc.ir.terrain import Terrain
from tests.support.meshes import box_mesh
from tests.support.surfaces import Grid, grid

STEP, SIDE = 10.0, 61
MIDDLE = 0.5 * STEP * (SIDE - 1)


def terrain(shape: Grid) -> Terrain:
    """Return a grid as terrain whose middle is the origin of W."""
    return Terrain(ground_of(shape.corners - [MIDDLE, MIDDLE, 0.0], shape.faces), "relief.csv")


def ridge(height: float, at: float = 60.0, half: float = 40.0) -> Grid:
    """Return a ridge along y: ``height`` at x = at, falling evenly to 0 in ``half`` metres on either side."""
    x = (np.arange(SIDE) - SIDE // 2) * STEP
    profile = height * np.maximum(0.0, 1.0 - np.abs(x - at) / half)
    return grid(np.repeat(profile[:, None], SIDE, axis=1), STEP)


def height_over(shape: Grid, p: Array) -> Array:
    """Return how high places (n, 3) of W are over a grid, by the cell that each is in."""
    return np.asarray(p[..., 2] - shape.height_at(p[..., 0] + MIDDLE, p[..., 1] + MIDDLE))


def house(centre: tuple[float, float, float], size: tuple[float, float, float]) -> ObstacleMesh:
    """Return a box as the buildings of a mission."""
    triangles = box_mesh(centre, size)
    part = np.zeros(len(triangles), dtype=np.intp)
    return obstacle_mesh("buildings", "houses.geojson", triangles, (part, ("house",)))


def from_box(p: Array, centre: tuple[float, float, float], size: tuple[float, float, float]) -> Array:
    """Return the distances of places (..., 3) from a box, 0 inside."""
    away = np.maximum(np.abs(p - np.array(centre)) - 0.5 * np.array(size), 0.0)
    return np.asarray(np.linalg.norm(away, axis=-1))


def over(mission: MissionIR, shape: Grid) -> MissionIR:
    """Return a mission over a grid, its pads moved up to stand on it."""
    fleets = tuple(
        fleet._replace(
            pads=tuple((x, y, z - float(height_over(shape, np.array([x, y, 0.0])))) for x, y, z in fleet.pads)
        )
        for fleet in mission.fleets
    )
    return mission._replace(terrain=terrain(shape), fleets=fleets)
