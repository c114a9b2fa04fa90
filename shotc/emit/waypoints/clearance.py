"""How near points come to what a drone must stay out of; arrays of points at once."""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import footprint_distances, signed_distance
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING, GROUND, Owner
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.clearances import Clearance, clearances_of, from_parked
from shotc.planning.obstacles import flight_space
from shotc.planning.over_ground import OverGround


class Level(NamedTuple):
    """Flat ground, or the greatest height above it where ``upper``; height : z of the drone's centre, m."""

    owner: Owner
    height: float
    upper: bool


Obstacle = Clearance | OverGround | BesideMesh | Level
"""What a file's legs may come nearer to than the plan does."""


def bounds(mission: MissionIR, drone: Drone) -> tuple[Obstacle, ...]:
    """Return all that stands and binds a flight: keep-outs, zones to stay in, ground and greatest height."""
    inside = tuple(each for each in clearances_of(mission, drone) if each.inside)
    flat: list[Level] = []
    if mission.terrain is None:
        flat.append(Level(GROUND, mission.rules.over_ground(drone.radius), upper=False))
        most = mission.rules.max_height
        if most is not None and isfinite(most):
            flat.append(Level(CEILING, most, upper=True))
    return (*keep_outs(mission, drone), *inside, *flat)


def keep_outs(mission: MissionIR, drone: Drone) -> tuple[Obstacle, ...]:
    """Return zones, standing targets, parked drones, terrain and meshes, with what they are held to."""
    around = (*clearances_of(mission, drone), *from_parked(mission, drone))
    return (*(each for each in around if not each.inside), *flight_space(mission, drone).surfaces)


def owner_of(obstacle: Obstacle, place: Array) -> Owner:
    """Return whose limit is nearest to a place (3,)."""
    return obstacle.owner_at(place) if isinstance(obstacle, OverGround | BesideMesh) else obstacle.owner


def shortfall(obstacle: Obstacle, points: Array) -> Array:
    """Return by how much each point, shape (n, 3), is too near to the obstacle, metres; negative is free."""
    if isinstance(obstacle, Level):
        return points[:, 2] - obstacle.height if obstacle.upper else obstacle.height - points[:, 2]
    if not isinstance(obstacle, Clearance):
        return -obstacle.slack(points)
    solid = obstacle.solid
    if obstacle.inside:
        return np.asarray(obstacle.metres + signed_distance(solid, points))
    across = footprint_distances(solid, points[:, :2])
    above = np.maximum(np.maximum(solid.bottom - points[:, 2], points[:, 2] - solid.top), 0.0)
    return np.asarray(obstacle.metres - np.hypot(across, above))
