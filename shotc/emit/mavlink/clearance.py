"""How near points come to what a drone must stay out of; arrays of points at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shotc.geom.solids import Cylinder, Solid, edges
from shotc.ir.mission import Drone, MissionIR
from shotc.planning.clearances import Clearance, clearances_of, from_parked

Array = NDArray[np.float64]


def keep_outs(mission: MissionIR, drone: Drone) -> tuple[Clearance, ...]:
    """Return keep-out zones, standing targets and parked drones, with the clearances they are held to."""
    around = (*clearances_of(mission, drone), *from_parked(mission, drone))
    return tuple(each for each in around if not each.inside)


def shortfall(obstacle: Clearance, points: Array) -> Array:
    """Return by how much each point, shape (n, 3), is too near to the obstacle, metres; negative is free."""
    solid = obstacle.solid
    across = footprint_distance(solid, points[:, :2])
    above = np.maximum(np.maximum(solid.bottom - points[:, 2], points[:, 2] - solid.top), 0.0)
    return np.asarray(obstacle.metres - np.hypot(across, above))


def footprint_distance(solid: Solid, xy: Array) -> Array:
    """Return the horizontal distance of each point, shape (n, 2), to the solid's footprint; 0 inside."""
    if isinstance(solid, Cylinder):
        reach = np.hypot(xy[:, 0] - solid.centre[0], xy[:, 1] - solid.centre[1])
        return np.maximum(reach - solid.radius, 0.0)
    sides = edges(solid.points)
    distance = np.min([_segment_distance(np.array(a), np.array(b), xy) for a, b in sides], axis=0)
    inside = np.zeros(len(xy), dtype=bool)
    for (ax, ay), (bx, by) in sides:
        if ay != by:
            spans = (ay > xy[:, 1]) != (by > xy[:, 1])
            inside ^= spans & (xy[:, 0] < (bx - ax) * (xy[:, 1] - ay) / (by - ay) + ax)
    return np.where(inside, 0.0, distance)


def _segment_distance(a: Array, b: Array, xy: Array) -> Array:
    along = b - a
    share = np.clip((xy - a) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
    gap: Array = xy - a - share[:, None] * along
    return np.asarray(np.hypot(gap[:, 0], gap[:, 1]))
