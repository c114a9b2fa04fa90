"""Conversion between W (East, North, Up) and a flight plan's coordinates: WGS84 and height above home."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.earth import of_world, to_world
from shotc.ir.limits import Vec3
from shotc.ir.mission import GeoOrigin

Array = NDArray[np.float64]
DEGREE_DECIMALS = 9  # a tenth of a millimetre
METRE_DECIMALS = 4


@dataclass(frozen=True, slots=True)
class GeoPosition:
    """A global position: latitude and longitude in degrees, metres above home."""

    lat: float
    lon: float
    alt: float


@dataclass(frozen=True, slots=True)
class Geo:
    """The relation between W and the globe for one drone.

    Heights above sea level are treated as ellipsoidal heights, because only their differences are used.

    home_lat, home_lon : degrees
    home_alt : metres above mean sea level
    """

    origin: GeoOrigin
    home_lat: float
    home_lon: float
    home_alt: float

    def places(self, points: Array) -> list[GeoPosition]:
        """Return the global positions of points of W, shape (n, 3), rounded as in the files."""
        return [
            GeoPosition(
                round(float(a), DEGREE_DECIMALS),
                round(float(o), DEGREE_DECIMALS),
                round(float(h) - self.home_alt, METRE_DECIMALS) + 0.0,
            )
            for a, o, h in of_world(points, self.origin)
        ]

    def place(self, point: Vec3) -> GeoPosition:
        """Return the global position of one point of W."""
        return self.places(np.array([point]))[0]

    def point(self, place: GeoPosition) -> Array:
        """Return the point of W, shape (3,), metres, of a global position."""
        where = np.array([[place.lat, place.lon, place.alt + self.home_alt]])
        return np.asarray(to_world(where, self.origin)[0])


def tie(origin: GeoOrigin, home: Vec3) -> Geo:
    """Return the relation for a drone whose pad is at ``home`` in W."""
    lat, lon, alt = (float(c) for c in of_world(np.array([home]), origin)[0])
    return Geo(
        origin,
        round(lat, DEGREE_DECIMALS),
        round(lon, DEGREE_DECIMALS),
        round(alt, METRE_DECIMALS),
    )
