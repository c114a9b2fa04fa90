"""What files of cameras have in common: the ticks of a drone's flight, and the word on those without one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.sampling import clock
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR


class Ticks(NamedTuple):
    """A flight at the ticks of the output clock, as in trajectory.csv.

    times : seconds, (M,); pose, rate, acceleration : channels ir.path.CHANNELS and their derivatives, (M, 7)
    """

    times: Array
    pose: Array
    rate: Array
    acceleration: Array


def ticks(plan: VerifiedIR, drone: DroneTrajectory) -> Ticks:
    """Return a flight at its ticks; at the last one the drone stands on its pad."""
    times = clock(plan.trajectory.keyframes.mission.rate, drone.curve.end)
    pose, rate, push = (drone.curve.derivative(k)(times) for k in range(3))
    rate[-1] = push[-1] = 0.0
    return Ticks(times, pose, rate, push)


def hertz(plan: VerifiedIR) -> str:
    """Return how many ticks a second there are, for a note."""
    return f"{plan.trajectory.keyframes.mission.rate:g}"


def without_fleets(plan: VerifiedIR, what: str) -> tuple[str, ...]:
    """Return the note that fleets are not in a file of cameras, nothing where there are none."""
    if not plan.trajectory.fleets:
        return ()
    return (f"{what}: drones of fleets have no cameras and are left out; trajectory.csv has them",)


def turned(quantity: Array) -> Array:
    """Return places or rates (M, 3) along North, East, Down that are given along East, North, Up."""
    return np.stack([quantity[:, 1], quantity[:, 0], -quantity[:, 2]], axis=-1)
