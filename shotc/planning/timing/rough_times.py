"""Approximate times along a leg, where planning needs them before the leg is timed."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.path import MovingLeg
from shotc.planning.timing.grid import evened, rough_profile
from shotc.planning.timing.leg import plan_of
from shotc.planning.timing.limits import ceiling_of
from shotc.planning.timing.move import axes_of

LEAST_SPEED_M_S = 1e-3  # m/s along the path, at rest


def rough_times(drone: Drone, leg: MovingLeg, pace: float) -> tuple[Array, Array]:
    """Return parameters s and the estimated times t at which a leg without holds passes them; shapes (M,).

    Jerk is limited at the ends only, so the flown duration is slightly longer.

    pace : share of the limits used
    """
    ceiling = ceiling_of(drone).scaled(pace)
    places, times = [np.array([leg.curve.start])], [np.zeros(1)]
    for start, end in plan_of(leg).spans:
        s, b = rough_profile(leg.curve, start, end, axes_of(leg.curve, (start, end), ceiling))
        speed = np.sqrt(evened(b))
        steps = 2 * np.diff(s) / np.maximum(speed[1:] + speed[:-1], LEAST_SPEED_M_S)
        places.append(s[1:])
        times.append(times[-1][-1] + np.cumsum(steps))
    return np.concatenate(places), np.concatenate(times)
