"""WGS84 places to points of W and back, many at once; the array counterpart of ``geom.geodetic``."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.geodetic import FLATTENING, SEMI_MAJOR_M
from shotc.geom.vec import Vec3

_E2 = FLATTENING * (2 - FLATTENING)
_ROUNDS = 5  # of the way back to latitudes; each gains two digits and more


def to_world(places: Array, origin: Vec3) -> Array:
    """Return places (..., 3), latitude, longitude and altitude in degrees and metres, as points of W.

    origin : as a place is. Exact, as ``geodetic.to_world``.
    """
    offset = _earth_centred(places) - _earth_centred(np.array(origin))
    return np.asarray(offset @ _axes(origin).T)


def of_world(points: Array, origin: Vec3) -> Array:
    """Return points of W (..., 3) as places: latitude, longitude and altitude in degrees and metres."""
    x, y, z = np.moveaxis(points @ _axes(origin) + _earth_centred(np.array(origin)), -1, 0)
    ring = np.hypot(x, y)
    lat = np.arctan2(z, ring * (1 - _E2))
    for _ in range(_ROUNDS):
        normal = SEMI_MAJOR_M / np.sqrt(1 - _E2 * np.sin(lat) ** 2)
        lat = np.arctan2(z + _E2 * normal * np.sin(lat), ring)
    altitude = ring * np.cos(lat) + z * np.sin(lat) - SEMI_MAJOR_M * np.sqrt(1 - _E2 * np.sin(lat) ** 2)
    return np.stack([np.degrees(lat), np.degrees(np.arctan2(y, x)), altitude], axis=-1)


def _axes(origin: Vec3) -> Array:
    """Return East, North and Up of a place, the rows, in the earth-centred frame."""
    lat, lon = radians(origin[0]), radians(origin[1])
    return np.array(
        [
            [-sin(lon), cos(lon), 0.0],
            [-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat)],
            [cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat)],
        ]
    )


def _earth_centred(places: Array) -> Array:
    lat, lon, alt = np.radians(places[..., 0]), np.radians(places[..., 1]), places[..., 2]
    normal = SEMI_MAJOR_M / np.sqrt(1 - _E2 * np.sin(lat) ** 2)
    ring = (normal + alt) * np.cos(lat)
    return np.stack([ring * np.cos(lon), ring * np.sin(lon), (normal * (1 - _E2) + alt) * np.sin(lat)], -1)
