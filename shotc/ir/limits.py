"""Numbers that drones, fleets and shots share: vectors, limits of motion, times."""

from math import hypot, inf, sin, sqrt
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

    speed : horizontal speed through the air, m/s; a wind of which nobody says where it comes from is taken
        off already
    climb, descent : vertical speed, both positive, m/s
    acceleration : 3D norm, m/s^2
    jerk : 3D norm, m/s^3
    yaw_rate, yaw_acceleration : of the body, rad/s, rad/s^2
    tilt : angle between a + g e_z and the vertical, rad; inf where nobody says
    thrust_to_weight : |a + g e_z| / g; inf where nobody says
    wind : velocity of the air over ground to the East and North, m/s, where that is known; slower than speed
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
    wind: Vec2 = (0.0, 0.0)

    @property
    def bounds(self) -> dict[str, float]:
        """All that is positive, by name: every field but the wind."""
        return {name: float(getattr(self, name)) for name in self._fields if name != "wind"}

    def speed_along(self, east: float, north: float) -> float:
        """Return the largest speed over ground in a direction, m/s: the wind pushes, or is flown against.

        The largest k with |k u - w| <= speed for the unit vector u of the direction.
        """
        way = hypot(east, north)
        if self.wind == (0.0, 0.0) or way == 0.0:
            return self.speed
        along = (east * self.wind[0] + north * self.wind[1]) / way
        across = (east * self.wind[1] - north * self.wind[0]) / way
        return along + sqrt(self.speed**2 - across**2)

    def airspeed(self, east: float, north: float) -> float:
        """Return the horizontal speed through the air of a velocity over ground, m/s."""
        return hypot(east - self.wind[0], north - self.wind[1])

    @property
    def fastest(self) -> float:
        """The speed over ground with the wind, m/s."""
        return self.speed + hypot(*self.wind)

    @property
    def slowest(self) -> float:
        """The largest speed over ground against the wind, m/s."""
        return self.speed - hypot(*self.wind)

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
