"""The airspace of a show: prisms that contain all paths of its fleets, which cameras always keep out of.

Proofs would allow cameras to fly between the drones of a fleet, but operators would not. Verification of
cameras and fleets does not use these prisms.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import pieces
from shotc.geom.solids import Prism
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.show import kept_from_cameras

HEIGHT_LAYERS = 6
"""Layers of height, each with a prism around the paths in it."""
THINNEST_M = 4.0
"""Least height of a layer, metres."""
PRISM_SIDES = 16
"""Sides of a prism."""


def airspace(mission: MissionIR, fleet: FleetTrajectory) -> Iterator[Zone]:
    """Yield keep-out zones around all paths of a fleet, with the separation of cameras."""
    own = mission.fleet(fleet.fleet)
    ctrl = pieces(fleet.breaks, fleet.coef).reshape(-1, 4, 3)
    low, high = ctrl[..., 2].min(axis=1), ctrl[..., 2].max(axis=1)
    number = int(np.clip((high.max() - low.min()) / THINNEST_M, 1, HEIGHT_LAYERS))
    clearance = kept_from_cameras(mission.rules.separation, own)
    for bottom, top in pairwise(np.linspace(low.min(), high.max(), number + 1).tolist()):
        inside = (high >= bottom) & (low <= top)
        if inside.any():
            points = _about(ctrl[inside].reshape(-1, 3)[:, :2], clearance)
            solid = Prism(points, bottom - clearance, top + clearance)
            yield Zone(f"airspace of {own.name}", "out", solid, own.path)


def _about(points: Array, clearance: float) -> tuple[tuple[float, float], ...]:
    """Return the corners (SIDES, 2) of a polygon at a clearance around points (N, 2), counter-clockwise."""
    turn = 2.0 * np.pi * np.arange(PRISM_SIDES) / PRISM_SIDES
    sides = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    reach = np.array([(points @ side).max() for side in sides]) + clearance
    corners = []
    for k in range(PRISM_SIDES):
        pair = sides[[k, (k + 1) % PRISM_SIDES]]
        x, y = np.linalg.solve(pair, reach[[k, (k + 1) % PRISM_SIDES]]).tolist()
        corners.append((x, y))
    return tuple(corners)
