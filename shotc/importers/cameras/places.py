"""Convert geodetic places to W, and bring values into the range of the language."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees, hypot
from statistics import median

from shotc.geom.geodetic import above_ground, to_world
from shotc.geom.vec import Vec3
from shotc.importers.cameras.takes import Take
from shotc.importers.notes import Notes
from shotc.importers.xml_tree import Node
from shotc.ir.mission import GeoOrigin

FAR_M = 20_000.0
"""Distance from the median of all cameras beyond which a camera belongs to no flight, metres."""
LOWEST_PITCH_DEG, HIGHEST_PITCH_DEG = -90.0, 30.0  # degrees, of the gimbal of the drone in the mission
NARROWEST_DEG, WIDEST_DEG = 1.01, 169.9
"""Fields of view just inside the range of the language, because focal lengths are rounded."""
LARGEST_COORDINATE_M = 1e9
ROLLED_DEG = 0.5
"""Largest roll that is not visible, degrees."""


def origin_at(lat: float, lon: float, alt: float) -> GeoOrigin:
    """Return the origin of W at a place, rounded as in the text of the mission."""
    return GeoOrigin(round(lat, 7), round(lon, 7), round(alt, 3))


def world(origin: GeoOrigin, lat: float, lon: float, height: float, *, absolute: bool) -> Vec3:
    """Return a geodetic place in W, metres. ``height``: metres above sea level, or above the ground z = 0."""
    return to_world((lat, lon, height), origin) if absolute else above_ground((lat, lon, height), origin)


def is_place(lat: float | None, lon: float | None) -> bool:
    """Return whether two numbers are a latitude and a longitude, degrees."""
    return lat is not None and lon is not None and abs(lat) < 89.9 and abs(lon) <= 360.0


def aim(at: Vec3, to: Vec3) -> tuple[float, float]:
    """Return heading and pitch of the direction from one place in W to another, degrees."""
    x, y, z = (b - a for a, b in zip(at, to, strict=True))
    return degrees(atan2(x, y)) % 360.0, degrees(atan2(z, hypot(x, y)))


def without_far(takes: Sequence[Take], notes: Notes) -> tuple[Take, ...]:
    """Return the takes without cameras far from most others: a tour often begins high above the continent."""
    cameras = [camera for take in takes for camera in take.cameras]
    if not cameras:
        return ()
    middle = [median(camera.at[k] for camera in cameras) for k in range(3)]
    near_takes = []
    for take in takes:
        near = []
        for camera in take.cameras:
            distance = hypot(*(a - b for a, b in zip(camera.at, middle, strict=True)))
            if distance < FAR_M:
                near.append(camera)
            else:
                notes.assume(
                    camera.node,
                    f"a camera that is {distance / 1000:.0f} km from most others",
                    "it is left out",
                )
        near_takes.append(take._replace(cameras=tuple(near)))
    return tuple(near_takes)


def reached(node: Node, pitch: float, notes: Notes) -> float:
    """Return the pitch clamped to the range of the drone's gimbal, degrees, with a note if it changes."""
    nearest = max(LOWEST_PITCH_DEG, min(HIGHEST_PITCH_DEG, pitch))
    if abs(nearest - pitch) > 1e-6:
        notes.assume(node, f"a pitch of {pitch:.1f} deg is out of a gimbal's range", f"{nearest:g} deg")
    return nearest


def clamped_hfov(hfov: float) -> float:
    """Return the field of view clamped to the range of the language, degrees."""
    return max(NARROWEST_DEG, min(WIDEST_DEG, hfov))


def level(node: Node, roll: float, notes: Notes) -> None:
    """Note an assumption if a camera is rolled."""
    if abs(roll) > ROLLED_DEG:
        notes.assume(node, f"the camera is rolled by {roll:.1f} deg", "a level horizon")


def number(text: str) -> float | None:
    """Return a number that can be a place, a time or an angle, None for any other text."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) < LARGEST_COORDINATE_M and "_" not in text else None
