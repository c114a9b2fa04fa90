"""How long a leg takes, for whoever plans its geometry: roughly in a moment, or exactly."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.path import Leg
from shotc.passes.parameterize_time import time_leg
from shotc.passes.parameterize_time.grid import evened, rough_profile
from shotc.passes.parameterize_time.leg import LegMotion, fastest_moves, plan_of
from shotc.passes.parameterize_time.limits import ceiling_of
from shotc.passes.parameterize_time.marks import DueLeg
from shotc.passes.parameterize_time.move import axes_of

LEAST_SPEED = 1e-3  # m/s along the path, at rest


def rough_times(drone: Drone, leg: Leg, pace: float) -> tuple[Array, Array]:
    """Return parameters s and the seconds t at which a leg without its holds passes them; shapes (M,).

    pace : share of the limits used. No jerk limit but at the ends: the flown time is a little longer.
    """
    assert leg.curve is not None
    ceiling = ceiling_of(drone).scaled(pace)
    places, times = [np.array([leg.curve.start])], [np.zeros(1)]
    for start, end in plan_of(leg).spans:
        s, b = rough_profile(leg.curve, start, end, axes_of(leg.curve, (start, end), ceiling))
        speed = np.sqrt(evened(b))
        steps = 2 * np.diff(s) / np.maximum(speed[1:] + speed[:-1], LEAST_SPEED)
        places.append(s[1:])
        times.append(times[-1][-1] + np.cumsum(steps))
    return np.concatenate(places), np.concatenate(times)


def leg_motion(mission: MissionIR, drone: Drone, leg: Leg) -> LegMotion | None:
    """Return a leg as the time pass will fly it, from time 0; what that refuses as fast as it may be.

    None where it takes no time.
    """
    return time_leg(mission, drone, leg, ceiling_of(drone))[0]


def leg_time(mission: MissionIR, drone: Drone, leg: Leg) -> float:
    """Return the seconds of ``leg_motion``."""
    motion = leg_motion(mission, drone, leg)
    return 0.0 if motion is None else motion.duration


def lateness(drone: Drone, leg: Leg) -> float:
    """Return by which share of a time asked for the fastest flight of a leg misses it, 0 if by none."""
    ceiling, plan = ceiling_of(drone), plan_of(leg)
    fast = fastest_moves(leg, plan, ceiling)
    return DueLeg(leg, plan, fast, fast, ceiling).lateness()
