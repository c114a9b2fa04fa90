"""Buildings made triangles of W. It needs numpy, so it loads where a mission has buildings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.surface.under_rings import lowest_under
from shotc.ir.obstacle_mesh import obstacle_mesh
from shotc.ir.terrain import Terrain
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault
from shotc.kinds.footprints.houses import House
from shotc.passes.resolve.lower.buildings import BUILDINGS
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.obstacles import Obstacles

MOST_TRIANGLES = 4_000_000


def buildings_mesh(houses: Sequence[House], name: str, terrain: Terrain | None, files: Files) -> Obstacles:
    """Return prisms on the ground, with flat lids; of buildings beyond the terrain none, which is told."""
    count = sum(2 * len(h.ring) + 2 * len(h.lid) for h in houses)
    if count > MOST_TRIANGLES:
        message = f"its buildings have {count} triangles; {MOST_TRIANGLES} are the most"
        wrong = FileFault(message, None, "cut it to where the mission is flown")
        return Obstacles(faults=(bad_file(files.origins, BUILDINGS, name, wrong),))
    ground = _ground(terrain, houses)
    standing = [(house, float(z)) for house, z in zip(houses, ground, strict=True) if np.isfinite(z)]
    faults: tuple[Diagnostic, ...] = ()
    if len(standing) < len(houses):
        label = (files.origins.value(BUILDINGS), files.origins.value(("world", "terrain"), "the terrain"))
        count = len(houses) - len(standing)
        message = f"{count} buildings of `{name}` stand beyond the terrain, and are left out"
        faults = (Diagnostic("G037", message, label, help="take an elevation model that covers them"),)
    if not standing:
        return Obstacles(faults=faults)
    pieces = [_prism(house, z) for house, z in standing]
    part = np.repeat(np.arange(len(pieces)), [len(piece) for piece in pieces])
    names = tuple(house.name for house, _ in standing)
    return Obstacles((obstacle_mesh("buildings", name, np.concatenate(pieces), (part, names)),), faults)


def _ground(terrain: Terrain | None, houses: Sequence[House]) -> Array:
    """Return z of the lowest ground under each building, NaN where there is none; shape (K,)."""
    if terrain is None:
        return np.zeros(len(houses))
    return lowest_under(terrain.ground, [np.array(house.ring) for house in houses])


def _prism(house: House, ground: float) -> Array:
    """Return the triangles of a building's walls, of its lid and of its floor, facing outward; (T, 3, 3)."""
    low, high = ground + house.bottom, ground + house.top
    a = np.array(house.ring)
    b = np.roll(a, -1, axis=0)
    bottom = np.full((len(a), 1), low)
    top = np.full((len(a), 1), high)
    a0, b0, a1, b1 = (np.hstack(parts) for parts in ((a, bottom), (b, bottom), (a, top), (b, top)))
    lid = np.array(house.lid)
    flat = np.ones((*lid.shape[:2], 1))
    above, below = np.concatenate([lid, high * flat], axis=2), np.concatenate([lid, low * flat], axis=2)
    walls = [np.stack([a0, b0, b1], axis=1), np.stack([a0, b1, a1], axis=1)]
    return np.concatenate([*walls, above, below[:, ::-1]])
