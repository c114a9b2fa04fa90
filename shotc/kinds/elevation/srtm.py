"""SRTM tiles (.hgt): big-endian 16-bit heights of one square degree, rows from the north."""

from __future__ import annotations

import re

import numpy as np

from shotc.geom.terrain.posts import Posts, TerrainFault, posts_of
from shotc.geom.terrain.systems import GEOGRAPHIC

SIDES = (1201, 3601)
"""Posts along a side, for three arc seconds and for one."""
VOID_HEIGHT = -32768
WGS84_EPSG = 4326
_NAME = re.compile(r"(?:^|[/\\])([NS])(\d{2})([EW])(\d{3})[^/\\]*$", re.IGNORECASE)


def read_srtm(name: str, data: bytes, system: int | None = None) -> Posts | TerrainFault:
    """Return the posts of a tile, or its fault; the name gives its south-west corner, such as N46E007.hgt."""
    side = next((s for s in SIDES if 2 * s * s == len(data)), None)
    if side is None:
        sizes = " or ".join(str(2 * s * s) for s in SIDES)
        return TerrainFault("truncated", f"it has {len(data)} bytes; a tile has {sizes}")
    corner = _NAME.search(name)
    if corner is None:
        help_ = "name it by its south-west corner, such as N46E007.hgt"
        return TerrainFault("format", "its name does not say where it is", None, help_)
    if system is not None and system not in GEOGRAPHIC:
        return TerrainFault("system", f"a tile is in WGS84, not in EPSG:{system}", None, "leave `epsg` out")
    lat = int(corner[2]) * (1 if corner[1].upper() == "N" else -1)
    lon = int(corner[4]) * (1 if corner[3].upper() == "E" else -1)
    if not (-90 <= lat < 90 and -180 <= lon < 180):
        return TerrainFault("number", f"its name says {lat} N, {lon} E, where no tile is")
    heights = np.frombuffer(data, dtype=">i2").reshape(side, side).astype(np.float64)
    heights[heights == VOID_HEIGHT] = np.nan
    along = np.arange(side) / (side - 1)
    return posts_of(heights, lon + along, lat + 1 - along, WGS84_EPSG)
