"""What the camera file formats share: a flight sampled at the output clock, and the note on fleets."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.sampling import clock
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR


class Ticks(NamedTuple):
    """A flight at the ticks of the output clock, as in trajectory.csv.

    times : mission times, seconds, shape (M,)
    pose, rate, acceleration : channels ir.path.CHANNELS and their derivatives, shape (M, 7) each
    """

    times: Array
    pose: Array
    rate: Array
    acceleration: Array


def ticks(plan: VerifiedIR, drone: DroneTrajectory) -> Ticks:
    """Return a flight at its ticks.

    Rates and accelerations are zero at the last tick, where the drone stands on its pad.
    """
    times = clock(plan.trajectory.keyframes.mission.rate, drone.curve.end)
    pose, rate, push = (drone.curve.derivative(k)(times) for k in range(3))
    rate[-1] = push[-1] = 0.0
    return Ticks(times, pose, rate, push)


def without_fleets(plan: VerifiedIR, what: str) -> tuple[str, ...]:
    """Return the note that fleets are left out of camera files; empty if the plan has no fleets."""
    if not plan.trajectory.fleets:
        return ()
    return (f"{what}: drones of fleets have no cameras and are left out; trajectory.csv has them",)


def turned(quantity: Array) -> Array:
    """Return vectors (M, 3) along North, East, Down from vectors (M, 3) along East, North, Up."""
    return np.stack([quantity[:, 1], quantity[:, 0], -quantity[:, 2]], axis=-1)
