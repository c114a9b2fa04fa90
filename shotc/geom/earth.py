"""WGS84 places to points of W and back, many at once, by pymap3d; `check` has ``geom.geodetic``."""

from __future__ import annotations

import numpy as np
import pymap3d

from shotc.geom.bernstein import Array
from shotc.geom.vec import Vec3


def to_world(places: Array, origin: Vec3) -> Array:
    """Return places (N, 3), latitude, longitude and altitude in degrees and metres, as points of W.

    origin : as a place is; altitudes are measured above what its is. The same as ``geodetic.to_world``.
    """
    return np.stack(pymap3d.geodetic2enu(*places.T, *origin), axis=-1)


def of_world(points: Array, origin: Vec3) -> Array:
    """Return points of W (N, 3) as places: latitude, longitude and altitude in degrees and metres."""
    return np.stack(pymap3d.enu2geodetic(*points.T, *origin), axis=-1)
