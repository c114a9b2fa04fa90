"""Distance of the drones of a path from each other's pictures, sampled; for refiners and passes that change a
path.
"""

from __future__ import annotations

from math import inf

import numpy as np

from shotc.geom.framing import Cameras
from shotc.geom.sight import off_axis, outside
from shotc.ir.bodies import flying
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV, PathIR
from shotc.planning.clock.flights import flights

STEP_S = 0.1  # seconds between samples


def least_out(path: PathIR) -> float:
    """Return the least distance of any drone from the picture of another one that films; negative inside.

    The unit is metres; where the rules define a cone, radians outside the cone. Infinite if no drone films.
    """
    mission = path.keyframes.mission
    rules, trajectories, least = mission.rules, flights(path), inf
    if rules.visibility == "off":
        return inf
    for name, flight in trajectories.items():
        for phase in (p for p in flight.phases if p.shot is not None):
            times = np.append(np.arange(phase.start, phase.end, STEP_S), phase.end)
            pose = flight.curve(times)
            aspect = mission.drone(name).aspect
            cameras = Cameras(pose[:, :3], pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], aspect)
            for other, seen in trajectories.items():
                if other == name:
                    continue
                places, radius = flying(seen.curve, times), mission.drone(other).radius
                if rules.half_angle is None:
                    least = min(least, float(outside(cameras, places, radius).min()))
                else:
                    out = off_axis(cameras, places, radius) - rules.half_angle
                    least = min(least, float(out.min()))
    return least
