"""Numbers of the tables, and points of W as latitude, longitude and altitude."""

from __future__ import annotations

import numpy as np
import pymap3d

from shotc.geom.bernstein import Array
from shotc.ir.mission import GeoOrigin

NUMBER = "%.9g"
DEGREES = "%.9f"
"""Latitude and longitude: nine significant digits would be steps of decimetres East of 100 degrees."""


def geodetic(origin: GeoOrigin, position: Array) -> Array:
    """Return latitude and longitude in degrees and altitude in metres of points of W, shape (M, 3).

    ENU to WGS84 (pymap3d). The origin's altitude is the height datum: what it is measured above, the
    result is, too.
    """
    lat, lon, alt = pymap3d.enu2geodetic(
        *position.T, origin.lat_deg, origin.lon_deg, origin.alt, ell=pymap3d.Ellipsoid.from_name("wgs84")
    )
    return np.stack([lat, lon, alt], axis=-1)
