"""The reader of elevation models, chosen by the file ending, and that of SRTM tiles."""

from __future__ import annotations

import re

import numpy as np

from shotc.geom.terrain.posts import Posts, TerrainFault, posts_of
from shotc.geom.terrain.systems import GEOGRAPHIC, WGS84_EPSG
from shotc.kinds.elevation.ascii_grid import read_ascii_grid
from shotc.kinds.elevation.csv_posts import read_csv_posts
from shotc.kinds.elevation.geotiff import read_geotiff

ENDINGS = (".tif", ".tiff", ".asc", ".hgt", ".csv")
SIDES = (1201, 3601)
"""Posts along a side, for three arc seconds and for one."""
VOID_HEIGHT = -32768
_NAME = re.compile(r"(?:^|[/\\])([NS])(\d{2})([EW])(\d{3})[^/\\]*$", re.IGNORECASE)


def read_elevation(name: str, data: bytes, system: int | None = None) -> Posts | TerrainFault:
    """Return the posts of a file, or its first fault. The bytes may be anything.

    name   : of the file; for SRTM it gives the position
    system : EPSG code in the mission, for files without one
    """
    ending = "." + name.rsplit(".", 1)[-1].lower()
    if ending in (".tif", ".tiff"):
        return read_geotiff(data, system)
    if ending == ".asc":
        return read_ascii_grid(data, system)
    if ending == ".hgt":
        return read_srtm(name, data, system)
    if ending == ".csv":
        return read_csv_posts(data, system)
    return TerrainFault(
        "format", f"`{ending[:20]}` is no elevation model that is read", None, f"one of {', '.join(ENDINGS)}"
    )


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
