"""The reader of elevation models, chosen by the file ending."""

from __future__ import annotations

from shotc.geom.terrain.posts import Posts, TerrainFault
from shotc.kinds.elevation.ascii_grid import read_ascii_grid
from shotc.kinds.elevation.csv_posts import read_csv_posts
from shotc.kinds.elevation.geotiff import read_geotiff
from shotc.kinds.elevation.srtm import read_srtm

ENDINGS = (".tif", ".tiff", ".asc", ".hgt", ".csv")


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
