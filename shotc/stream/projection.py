"""The local frames of autopilots: how each of them lays latitude and longitude out in metres.

An autopilot flies to a local setpoint by its own map, not by the ellipsoid. On a sphere of its own radius a
metre to the East is up to 0.3 % off: 0.9 m at 300 m from the origin. So a setpoint is the plan's place on
the globe, laid out as the autopilot itself does it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.stream.messages import GlobeFix

PX4_RADIUS_M = 6371000.0
ARDUPILOT_RADIUS_M = 6378100.0
Layout = Callable[[Array, Array, GlobeFix], tuple[Array, Array]]


def azimuthal(lat: Array, lon: Array, origin: GlobeFix) -> tuple[Array, Array]:
    """Return North and East, metres, as PX4 does: azimuthal equidistant on a sphere.

    lat, lon : degrees, shape (N,). PX4 ``MapProjection::project`` (lib/geo); the angle from the origin comes
    of its sine here, which keeps millimetres where the arc cosine loses them.
    """
    phi, phi0 = np.radians(lat), np.radians(origin.lat)
    turn = np.radians(lon - origin.lon)
    half = np.sin((phi - phi0) / 2) ** 2 + np.cos(phi) * np.cos(phi0) * np.sin(turn / 2) ** 2
    angle = 2 * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0)))
    stretch = PX4_RADIUS_M / np.sinc(angle / np.pi)
    north = np.sin(phi - phi0) + 2 * np.sin(phi0) * np.cos(phi) * np.sin(turn / 2) ** 2
    return stretch * north, stretch * np.cos(phi) * np.sin(turn)


def equirectangular(lat: Array, lon: Array, origin: GlobeFix) -> tuple[Array, Array]:
    """Return North and East, metres, as ArduPilot does: by the cosine of the mean latitude.

    lat, lon : degrees, shape (N,). ArduPilot ``Location::get_distance_NE``.
    """
    scale = np.cos(np.radians((lat + origin.lat) / 2))
    return (
        ARDUPILOT_RADIUS_M * np.radians(lat - origin.lat),
        ARDUPILOT_RADIUS_M * np.radians(lon - origin.lon) * scale,
    )


class LocalFrame(NamedTuple):
    """The local frame of one vehicle.

    layout : of its autopilot; origin : of the frame
    raised : metres that heights of the plan are raised by, for its pad to be as high as the vehicle's home
    """

    layout: Layout
    origin: GlobeFix
    raised: float = 0.0

    def of_places(self, places: Array) -> Array:
        """Return places (N, 3), degrees and metres, as North, East, Down, metres, shape (N, 3)."""
        north, east = self.layout(places[:, 0], places[:, 1], self.origin)
        return np.stack([north, east, self.origin.alt - places[:, 2] - self.raised], axis=-1)
