"""Whether a motion keeps a drone's limits at every instant, and its distances: hulls of control points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.refiner_api import Drone, Surroundings

PROVED = 1e-6  # metres
ROUNDING = 1e-9  # of a limit


class Gap(NamedTuple):
    """Where a motion is not proved: mission time, what is lacking there, and by how much in ``unit``."""

    time: float
    what: str
    lack: float
    unit: str


def gap_in(drone: Drone, around: Surroundings, position: Piecewise) -> Gap | None:
    """Return the worst of what the hulls of a motion do not prove, None where they prove all."""
    lack = around.lacking(position.ctrl)
    k = int(lack.argmax())
    if lack[k] > PROVED:
        return Gap(float(position.breaks[k]), "the clearances", float(lack[k]), "m")
    limits = drone.limits
    first, second, third = (position.derivative(order).ctrl for order in (1, 2, 3))
    norm = np.linalg.norm
    uses = {
        "speed": (norm(first[:, :, :2], axis=2), limits.speed, "m/s"),
        "climb": (first[:, :, 2], limits.climb, "m/s"),
        "descent": (-first[:, :, 2], limits.descent, "m/s"),
        "acceleration": (norm(second, axis=2), limits.acceleration, "m/s^2"),
        "jerk": (norm(third, axis=2), limits.jerk, "m/s^3"),
    }
    worst: Gap | None = None
    for what, (points, limit, unit) in uses.items():
        most = points.max(axis=1)
        k = int(most.argmax())
        over = float(most[k]) - limit
        if over > ROUNDING * limit and (worst is None or over > worst.lack):
            worst = Gap(float(position.breaks[k]), f"the limit of {what}", over, unit)
    return worst
