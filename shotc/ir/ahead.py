"""Which headings are free: where ``rules.look_ahead`` can be kept while a shot is filmed.

A camera that films nobody, and to which no heading is written, looks the way its path goes: it is led to look
ahead with its body. Where a camera is bound by what it films, the body is free as far as the gimbal pans.
"""

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import Shot


def looks_along(shot: Shot) -> bool:
    """Tell whether nothing but its path says where a shot's camera heads."""
    return (
        shot.ideal is None
        and len(shot.keyframes) > 1
        and all(
            k.target is None and k.heading is None and k.aim is not None and len(k.aim) == 2
            for k in shot.keyframes
        )
    )


def least_off_course(drone: Drone, aside: Array) -> Array:
    """Return the least angle between a course and where the body may head, rad, of the shape of ``aside``.

    aside : camera yaw less the course, rad, any winding
    """
    if drone.body == "follow-camera":
        return np.abs(wrapped(aside))
    low, high = drone.gimbal.yaw
    return np.asarray(np.maximum(np.abs(wrapped(aside - 0.5 * (low + high))) - 0.5 * (high - low), 0.0))
