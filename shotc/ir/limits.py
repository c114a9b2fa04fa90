"""Numbers that drones, fleets and shots share: vectors, limits of motion, times."""

from math import inf, sin
from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3

__all__ = ["G_M_S2", "TILT", "Limits", "Range", "Timing", "Vec2", "Vec3", "reaches"]

Range = tuple[float, float]

TILT = 1e-6
"""Radians past a gimbal's stop that are rounding."""


G_M_S2 = 9.80665
"""Standard gravity."""


class Limits(NamedTuple):
    """What a drone may do; norms as in the language definition.

    The rotors of a quadrotor make the acceleration a + g e_z, along its own upward axis (Alcantara et al.,
    Eq. 2 and 4; air drag is neglected there, and here).

    speed : horizontal speed over ground, world.wind already taken off, m/s
    climb, descent : vertical speed, both positive, m/s
    acceleration : 3D norm, m/s^2
    jerk : 3D norm, m/s^3
    yaw_rate, yaw_acceleration : of the body, rad/s, rad/s^2
    tilt : angle between a + g e_z and the vertical, rad; inf where nobody says
    thrust_to_weight : |a + g e_z| / g; inf where nobody says
    """

    speed: float
    climb: float
    descent: float
    acceleration: float
    jerk: float
    yaw_rate: float
    yaw_acceleration: float
    tilt: float = inf
    thrust_to_weight: float = inf

    @property
    def acceleration_bounds(self) -> dict[str, float]:
        """How large an acceleration of any direction each limit allows, m/s^2, by the limit's name.

        The ball about 0 in the cone |a_xy| <= tan(tilt) (a_z + g) has the radius g sin(tilt), that in the
        ball |a + g e_z| <= k g the radius (k - 1) g.
        """
        return {
            "acceleration": self.acceleration,
            "tilt": inf if self.tilt == inf else G_M_S2 * sin(self.tilt),
            "thrust_to_weight": G_M_S2 * (self.thrust_to_weight - 1.0),
        }

    @property
    def usable_acceleration(self) -> float:
        """What motions are planned with, m/s^2: in every direction it keeps acceleration, tilt and thrust."""
        return min(self.acceleration_bounds.values())


def reaches(pitch: Range, angle: float) -> bool:
    """Tell whether a camera that pitches within a range comes to an angle, rad."""
    return pitch[0] - TILT <= angle <= pitch[1] + TILT


class Timing(NamedTuple):
    """When a shot is filmed; all None is ``auto``. Seconds; ``after`` names a shot."""

    start: float | None = None
    after: str | None = None
    duration: float | None = None
