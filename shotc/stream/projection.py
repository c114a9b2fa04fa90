"""The local frames of autopilots: how each projects latitude and longitude to metres.

An autopilot flies to a local setpoint by its own projection, not on the ellipsoid. It uses a sphere, and on
it an eastward distance is wrong by up to 0.3 %: 0.9 m at 300 m from the origin. Therefore the plan's
positions are taken on the globe, and projected by the autopilot's own formula.
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
    """Return North and East as PX4 computes them: azimuthal equidistant on a sphere, shapes (N,), m.

    lat, lon : degrees, shape (N,)
    The formula is PX4's ``MapProjection::project`` (lib/geo), except that the angle from the origin comes
    from its sine: this keeps millimetres, which the arc cosine loses.
    """
    phi, phi0 = np.radians(lat), np.radians(origin.lat)
    turn = np.radians(lon - origin.lon)
    half = np.sin((phi - phi0) / 2) ** 2 + np.cos(phi) * np.cos(phi0) * np.sin(turn / 2) ** 2
    angle = 2 * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0)))
    stretch = PX4_RADIUS_M / np.sinc(angle / np.pi)
    north = np.sin(phi - phi0) + 2 * np.sin(phi0) * np.cos(phi) * np.sin(turn / 2) ** 2
    return stretch * north, stretch * np.cos(phi) * np.sin(turn)


def equirectangular(lat: Array, lon: Array, origin: GlobeFix) -> tuple[Array, Array]:
    """Return North and East as ArduPilot computes them: by the cosine of the mean latitude, shapes (N,), m.

    lat, lon : degrees, shape (N,)
    The formula is ArduPilot's ``Location::get_distance_NE``.
    """
    scale = np.cos(np.radians((lat + origin.lat) / 2))
    return (
        ARDUPILOT_RADIUS_M * np.radians(lat - origin.lat),
        ARDUPILOT_RADIUS_M * np.radians(lon - origin.lon) * scale,
    )


class LocalFrame(NamedTuple):
    """The local frame of one vehicle.

    layout : the projection of its autopilot
    origin : the frame's origin
    raised : what is added to the plan's heights, so that the pad is as high as the vehicle's home, m
    """

    layout: Layout
    origin: GlobeFix
    raised: float = 0.0

    def of_places(self, places: Array) -> Array:
        """Return places (N, 3) in degrees and metres as North, East, Down, m, shape (N, 3)."""
        north, east = self.layout(places[:, 0], places[:, 1], self.origin)
        return np.stack([north, east, self.origin.alt - places[:, 2] - self.raised], axis=-1)
