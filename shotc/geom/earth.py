"""Arrays of WGS84 positions to points of W and back, by pymap3d; `check` uses ``geom.geodetic``."""

from __future__ import annotations

import numpy as np
import pymap3d

from shotc.geom.bernstein import Array
from shotc.geom.vec import Vec3


def to_world(places: Array, origin: Vec3) -> Array:
    """Return places (N, 3), latitude, longitude and altitude in degrees and metres, as points (N, 3) of W.

    origin : in the same form and with the same reference of altitude. The result equals
    ``geodetic.to_world``.
    """
    return np.stack(pymap3d.geodetic2enu(*places.T, *origin), axis=-1)


def of_world(points: Array, origin: Vec3) -> Array:
    """Return points of W (N, 3) as places (N, 3): latitude, longitude and altitude in degrees and metres."""
    return np.stack(pymap3d.enu2geodetic(*points.T, *origin), axis=-1)
