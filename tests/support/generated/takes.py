"""A shot as it is drawn: its YAML, and where it wants the camera when."""

from __future__ import annotations

from itertools import pairwise
from math import radians, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.support.generated.cameras import Camera

Array = NDArray[np.float64]

CENTRE = (0.0, 0.0)
PLACES = {
    "center": CENTRE,
    "left-third": (-1 / 3, 0.0),
    "right-third": (1 / 3, 0.0),
    "lower-third": (0.0, -1 / 3),
    "upper-third": (0.0, 1 / 3),
}
ONE_OF = {**PLACES, "thirds-lines": PLACES["upper-third"]}
"""A place on screen of compositions that do not hold the centre."""

GROUND_ROOM = 0.2  # metres over the ground clearance that no shot goes below
TARGET_ROOM = 1.0  # metres beside the target clearance


class Take(NamedTuple):
    """One shot.

    places : where it wants the camera, (n, 3); of a shot with a known time, at ``times`` of the mission
    times : (n,), None where the time is left to the compiler
    lasts : seconds it takes at most
    why_cropped : why no plan shows the whole subject in every frame, empty where one does
    """

    id: str
    drone: str
    subjects: tuple[str, ...]
    wanted: dict[str, Any]
    places: Array
    times: Array | None
    lasts: float
    why_cropped: str = ""


class Rules(NamedTuple):
    """Clearances, metres, and the composition of a mission."""

    ground: float
    target: float
    separation: float
    composition: str

    def floor(self, camera: Camera) -> float:
        """Return the lowest z that a shot asks for."""
        return self.ground + camera.radius + GROUND_ROOM


def bearing(azimuth_deg: float) -> Array:
    """Return the level unit vector of a compass bearing."""
    return np.array([np.sin(radians(azimuth_deg)), np.cos(radians(azimuth_deg)), 0.0])


def least_time(camera: Camera, places: Array, share: float = 1.0) -> float:
    """Return the seconds that a way takes at a share of the limits, from rest to rest."""
    total = 0.0
    for a, b in pairwise(places):
        level, rise = float(np.hypot(*(b - a)[:2])), float((b - a)[2])
        up = camera.climb if rise > 0 else camera.descent
        for way, speed in ((level, camera.speed), (abs(rise), up)):
            fast = speed * share
            total += way / fast
    length = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    return total + min(2 * sqrt(length / camera.acceleration), 2 * camera.speed / camera.acceleration)
