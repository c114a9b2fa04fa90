"""The headings to which ``rules.look_ahead`` applies while a shot is filmed.

A camera without a target and without a written heading looks along its path, and the rule applies to the
camera. A camera with a target is bound by it; then the rule applies to the body, which is free within the
gimbal's yaw range.
"""

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import Shot


def looks_along(shot: Shot) -> bool:
    """Return whether the path alone determines the heading of a shot's camera."""
    return (
        shot.ideal is None
        and len(shot.keyframes) > 1
        and all(
            k.target is None and k.heading is None and k.aim is not None and len(k.aim) == 2
            for k in shot.keyframes
        )
    )


def least_off_course(drone: Drone, off_course: Array) -> Array:
    """Return the least angle between course and admissible body heading, rad, shaped as ``off_course``.

    off_course : camera yaw less the course, (...), rad, any winding
    """
    if drone.body == "follow-camera":
        return np.abs(wrapped(off_course))
    low, high = drone.gimbal.yaw
    return np.asarray(np.maximum(np.abs(wrapped(off_course - 0.5 * (low + high))) - 0.5 * (high - low), 0.0))
