"""Numbers that drones, fleets and shots share: vectors, limits of motion, times."""

from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3

__all__ = ["TILT", "Limits", "Range", "Timing", "Vec2", "Vec3", "reaches"]

Range = tuple[float, float]

TILT = 1e-6
"""Radians past a gimbal's stop that are rounding."""


class Limits(NamedTuple):
    """What a drone may do; norms as in the language definition.

    speed : horizontal speed over ground, world.wind already taken off, m/s
    climb, descent : vertical speed, both positive, m/s
    acceleration : 3D norm, m/s^2
    jerk : 3D norm, m/s^3
    yaw_rate, yaw_acceleration : of the body, rad/s, rad/s^2
    """

    speed: float
    climb: float
    descent: float
    acceleration: float
    jerk: float
    yaw_rate: float
    yaw_acceleration: float


def reaches(pitch: Range, angle: float) -> bool:
    """Tell whether a camera that pitches within a range comes to an angle, rad."""
    return pitch[0] - TILT <= angle <= pitch[1] + TILT


class Timing(NamedTuple):
    """When a shot is filmed; all None is ``auto``. Seconds; ``after`` names a shot."""

    start: float | None = None
    after: str | None = None
    duration: float | None = None
