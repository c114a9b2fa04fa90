"""How near points come to what a drone must stay out of; arrays of points at once."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import footprint_distances
from shotc.ir.mission import Drone, MissionIR
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.clearances import Clearance, clearances_of, from_parked
from shotc.planning.obstacles import flight_space
from shotc.planning.over_ground import OverGround

Obstacle = Clearance | OverGround | BesideMesh
"""What straight legs may come nearer to than the plan does; flat ground is none of it."""


def keep_outs(mission: MissionIR, drone: Drone) -> tuple[Obstacle, ...]:
    """Return zones, standing targets, parked drones, terrain and meshes, with what they are held to."""
    around = (*clearances_of(mission, drone), *from_parked(mission, drone))
    return (*(each for each in around if not each.inside), *flight_space(mission, drone).surfaces)


def shortfall(obstacle: Obstacle, points: Array) -> Array:
    """Return by how much each point, shape (n, 3), is too near to the obstacle, metres; negative is free."""
    if not isinstance(obstacle, Clearance):
        return -obstacle.slack(points)
    solid = obstacle.solid
    across = footprint_distances(solid, points[:, :2])
    above = np.maximum(np.maximum(solid.bottom - points[:, 2], points[:, 2] - solid.top), 0.0)
    return np.asarray(obstacle.metres - np.hypot(across, above))
