"""Between the mission's East-North-Up frame and what a flight plan carries: WGS84 and height above home."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pymap3d import enu2geodetic, geodetic2enu

from shotc.emit.mavlink.items import Place
from shotc.ir.limits import Vec3
from shotc.ir.mission import GeoOrigin

Array = NDArray[np.float64]
DEGREE_DECIMALS = 9  # a tenth of a millimetre
METRE_DECIMALS = 4


@dataclass(frozen=True, slots=True)
class Geo:
    """The tie between W and the globe for one drone.

    home_lat, home_lon : degrees; home_alt : metres above mean sea level
    Heights above sea level are treated as ellipsoidal ones: only differences of them are used.
    """

    origin: GeoOrigin
    home_lat: float
    home_lon: float
    home_alt: float

    def places(self, points: Array) -> list[Place]:
        """Return the global places of points of W, shape (n, 3), rounded as the files carry them."""
        lat, lon, alt = _to_global(self.origin, points)
        return [
            Place(
                round(float(a), DEGREE_DECIMALS),
                round(float(o), DEGREE_DECIMALS),
                round(float(h) - self.home_alt, METRE_DECIMALS) + 0.0,
            )
            for a, o, h in zip(lat, lon, alt, strict=True)
        ]

    def place(self, point: Vec3) -> Place:
        """Return the global place of one point of W."""
        return self.places(np.array([point]))[0]

    def point(self, place: Place) -> Array:
        """Return the point of W, shape (3,), of a global place."""
        origin = self.origin
        enu = geodetic2enu(
            place.lat, place.lon, place.alt + self.home_alt, origin.lat_deg, origin.lon_deg, origin.alt
        )
        return np.array([float(c) for c in enu])


def tie(origin: GeoOrigin, home: Vec3) -> Geo:
    """Return the tie for a drone whose pad is at ``home`` in W."""
    lat, lon, alt = _to_global(origin, np.array([home]))
    return Geo(
        origin,
        round(float(lat[0]), DEGREE_DECIMALS),
        round(float(lon[0]), DEGREE_DECIMALS),
        round(float(alt[0]), METRE_DECIMALS),
    )


def _to_global(origin: GeoOrigin, points: Array) -> tuple[Array, Array, Array]:
    east, north, up = np.asarray(points, dtype=np.float64).T
    lat, lon, alt = enu2geodetic(east, north, up, origin.lat_deg, origin.lon_deg, origin.alt)
    return np.atleast_1d(lat), np.atleast_1d(lon), np.atleast_1d(alt)
