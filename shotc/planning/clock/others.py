"""The other drones as moving obstacles: in flight and on their pads."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from shotc.geom.solids import point
from shotc.ir.bodies import flying, standing_at
from shotc.ir.mission import MissionIR
from shotc.ir.owners import drone_owner
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clock.moving import Moving

POINT = point((0.0, 0.0, 0.0))


def other_drones(mission: MissionIR, name: str, flights: Mapping[str, DroneTrajectory]) -> tuple[Moving, ...]:
    """Return the other drones that film as moving obstacles; parked drones are part of the free space.

    name : of the drone that is planned
    flights : of the drones planned so far, by name; the others stand on their pads
    """
    parked = {drone.name for drone in mission.parked}
    motions = []
    for drone in mission.drones:
        if drone.name == name or drone.name in parked:
            continue
        flight = flights.get(drone.name)
        at = partial(standing_at, np.array(drone.home)) if flight is None else partial(flying, flight.curve)
        motions.append(Moving(drone_owner(drone), POINT, mission.rules.separation, at, always=True))
    return tuple(motions)
