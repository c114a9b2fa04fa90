"""The other drones, as what a drone keeps away from: in flight, and on their pads."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder
from shotc.ir.bodies import flying
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.timed_route.moving import Moving

POINT = Cylinder((0.0, 0.0), 0.0, 0.0, 0.0)


def other_drones(mission: MissionIR, name: str, flights: Mapping[str, DroneTrajectory]) -> tuple[Moving, ...]:
    """Return every drone but one that films something.

    flights : by drone, of those that are planned; the others count as standing on their pads
    """
    filming = {shot.drone for shot in mission.shots}
    found = []
    for drone in mission.drones:
        if drone.name == name or drone.name not in filming:
            continue
        flight = flights.get(drone.name)
        at = partial(_standing, np.array(drone.home)) if flight is None else partial(flying, flight.curve)
        found.append(Moving(f"drone {drone.name}", POINT, mission.rules.separation, at, always=True))
    return tuple(found)


def _standing(place: Array, times: Array) -> Array:
    return np.tile(place, (len(times), 1))
