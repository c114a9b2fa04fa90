"""Types that drones, fleets and shots share: vectors, limits of motion, times."""

from math import hypot, inf, sin, sqrt
from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3

__all__ = ["G_M_S2", "PITCH_ROUNDING_RAD", "Limits", "Range", "Timing", "Vec2", "Vec3", "reaches"]

Range = tuple[float, float]

PITCH_ROUNDING_RAD = 1e-6
"""Tolerance at a gimbal's stop for rounding, rad."""


G_M_S2 = 9.80665
"""Standard gravity."""


class Limits(NamedTuple):
    """The limits of a drone's motion; norms as in the language definition.

    The thrust of a quadrotor makes the acceleration a + g e_z along its own upward axis (Alcantara et al.,
    Eq. 2 and 4; air drag is neglected there and here).

    speed : horizontal airspeed, m/s; a wind of unknown direction is already subtracted
    climb, descent : vertical speed, both positive, m/s
    acceleration : 3D norm, m/s^2
    jerk : 3D norm, m/s^3
    yaw_rate, yaw_acceleration : of the body, rad/s, rad/s^2
    tilt : angle between a + g e_z and the vertical, rad; inf if unknown
    thrust_to_weight : |a + g e_z| / g; inf if unknown
    wind : velocity of the air over ground to the East and North, m/s, if known; slower than ``speed``
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
        """All positive limits by name: every field but the wind."""
        return {name: float(getattr(self, name)) for name in self._fields if name != "wind"}

    def speed_along(self, east: float, north: float) -> float:
        """Return the largest speed over ground in a direction, m/s, with the wind.

        It is the largest k with |k u - w| <= speed for the unit vector u of the direction and the wind w.
        """
        length = hypot(east, north)
        if self.wind == (0.0, 0.0) or length == 0.0:
            return self.speed
        along = (east * self.wind[0] + north * self.wind[1]) / length
        across = (east * self.wind[1] - north * self.wind[0]) / length
        return along + sqrt(self.speed**2 - across**2)

    def airspeed(self, east: float, north: float) -> float:
        """Return the airspeed of a velocity over ground, m/s."""
        return hypot(east - self.wind[0], north - self.wind[1])

    @property
    def fastest(self) -> float:
        """The largest speed over ground with the wind, m/s."""
        return self.speed + hypot(*self.wind)

    @property
    def slowest(self) -> float:
        """The largest speed over ground against the wind, m/s."""
        return self.speed - hypot(*self.wind)

    @property
    def acceleration_bounds(self) -> dict[str, float]:
        """The largest acceleration in every direction that each limit allows, m/s^2, by the limit's name.

        The largest ball about 0 in the cone |a_xy| <= tan(tilt) (a_z + g) has the radius g sin(tilt), and
        that in the ball |a + g e_z| <= k g has the radius (k - 1) g.
        """
        return {
            "acceleration": self.acceleration,
            "tilt": inf if self.tilt == inf else G_M_S2 * sin(self.tilt),
            "thrust_to_weight": G_M_S2 * (self.thrust_to_weight - 1.0),
        }

    @property
    def usable_acceleration(self) -> float:
        """The planner's bound, m/s^2: in all directions within the acceleration, tilt and thrust limits."""
        return min(self.acceleration_bounds.values())


def reaches(pitch: Range, angle: float) -> bool:
    """Return whether an angle, rad, is within a pitch range."""
    return pitch[0] - PITCH_ROUNDING_RAD <= angle <= pitch[1] + PITCH_ROUNDING_RAD


class Timing(NamedTuple):
    """When a shot is filmed; all None is ``auto``. Seconds; ``after`` names a shot."""

    start: float | None = None
    after: str | None = None
    duration: float | None = None
