"""Buildings as triangles in W. This module needs numpy, so it is imported where a mission has buildings."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.surface.under_rings import lowest_under
from shotc.ir.obstacle_mesh import ObstacleMesh, obstacle_mesh
from shotc.ir.terrain import Terrain
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault
from shotc.kinds.footprints.houses import House
from shotc.passes.resolve.lower.buildings import BUILDINGS, GroundedBuilding
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.obstacles import Obstacles

MOST_TRIANGLES = 4_000_000


def buildings_mesh(houses: Sequence[House], name: str, terrain: Terrain | None, files: Files) -> Obstacles:
    """Return prisms on the ground, with flat lids; those outside of the terrain are left out with a
    warning.
    """
    count = sum(2 * len(h.ring) + 2 * len(h.lid) for h in houses)
    if count > MOST_TRIANGLES:
        message = f"its buildings have {count} triangles; {MOST_TRIANGLES} are the most"
        wrong = FileFault(message, None, "cut it to where the mission is flown")
        return Obstacles(faults=(bad_file(files.origins, BUILDINGS, name, wrong),))
    ground = _ground(terrain, houses).tolist()
    stand = tuple(
        GroundedBuilding(h, z if isfinite(z) else None) for h, z in zip(houses, ground, strict=True)
    )
    standing = [(house, z) for house, z in stand if z is not None]
    faults: tuple[Diagnostic, ...] = ()
    if len(standing) < len(houses):
        label = (files.origins.value(BUILDINGS), files.origins.value(("world", "terrain"), "the terrain"))
        count = len(houses) - len(standing)
        message = f"{count} buildings of `{name}` stand beyond the terrain, and are left out"
        faults = (Diagnostic("G037", message, label, help="take an elevation model that covers them"),)
    if not standing:
        return Obstacles((), faults, stand)
    return Obstacles((_prisms(name, standing),), faults, stand)


def _ground(terrain: Terrain | None, houses: Sequence[House]) -> Array:
    """Return z of the lowest ground below each building, NaN where there is none; shape (K,)."""
    if terrain is None:
        return np.zeros(len(houses))
    return lowest_under(terrain.ground, [np.array(house.ring) for house in houses])


def _prisms(name: str, standing: Sequence[tuple[House, float]]) -> ObstacleMesh:
    """Return the triangles of walls, lids and floors, facing outwards; standing : (house, z of its
    ground).
    """
    houses = [house for house, _ in standing]
    low = np.array([z + house.bottom for house, z in standing])
    high = np.array([z + house.top for house, z in standing])
    sizes = np.array([len(house.ring) for house in houses])
    starts = np.cumsum(sizes) - sizes
    side = np.repeat(np.arange(len(houses)), sizes)
    a = np.array([corner for house in houses for corner in house.ring])
    after = np.arange(len(a)) + 1
    after[starts + sizes - 1] = starts
    b = a[after]
    a0, b0, a1, b1 = (np.column_stack([p, z[side]]) for z in (low, high) for p in (a, b))
    flat = np.array([triangle for house in houses for triangle in house.lid])
    over = np.repeat(np.arange(len(houses)), [len(house.lid) for house in houses])
    lid, floor = (np.dstack([flat, np.repeat(z[over][:, None], 3, axis=1)]) for z in (high, low))
    walls = [np.stack([a0, b0, b1], axis=1), np.stack([a0, b1, a1], axis=1)]
    part = np.concatenate([side, side, over, over])
    names = tuple(house.name for house in houses)
    return obstacle_mesh("buildings", name, np.concatenate([*walls, lid, floor[:, ::-1]]), (part, names))
