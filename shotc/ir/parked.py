"""Drones that a plan does not fly: they stand on their pads all the time."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import Drone
from shotc.ir.path import CHANNELS, HFOV
from shotc.ir.show import Fleet
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR

ON_PAD_S = 1.0
"""Duration of a parked drone's curve, seconds; like every drone it stands before and after."""


def parked(ir: TrajectoryIR) -> tuple[DroneTrajectory, ...]:
    """Return the drones of the mission without a flight in a plan, as standing: no phases, no framing."""
    flown = {track.drone for track in ir.drones}
    return tuple(_standing(drone) for drone in ir.keyframes.mission.drones if drone.name not in flown)


def parked_fleets(ir: TrajectoryIR) -> tuple[Fleet, ...]:
    """Return the fleets of the mission without a flight in a plan; their drones stand on their pads."""
    flown = {track.fleet for track in ir.fleets}
    return tuple(fleet for fleet in ir.keyframes.mission.fleets if fleet.name not in flown)


def bodies(ir: TrajectoryIR) -> tuple[DroneTrajectory, ...]:
    """Return all drones of the mission, the flying ones first."""
    return (*ir.drones, *parked(ir))


def _standing(drone: Drone) -> DroneTrajectory:
    pose = np.zeros(len(CHANNELS))
    pose[:3], pose[HFOV] = drone.home, drone.hfov
    ctrl = np.tile(pose, (1, 6, 1))
    return DroneTrajectory(drone.name, Piecewise(np.array([0.0, ON_PAD_S]), ctrl), (), (), ())
