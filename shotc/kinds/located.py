"""Positions from the rows of a file as points of W, for routes and for tracks."""

from shotc.diag.model import Diagnostic
from shotc.geom.geodetic import above_ground, to_world
from shotc.ir.limits import Vec3
from shotc.ir.mission import GeoOrigin
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.earth import stray
from shotc.kinds.files import NumberTable


def in_world(
    table: NumberTable, name: str, origin: GeoOrigin | None, origins: OriginMap, path: KeyPath
) -> list[Vec3] | Diagnostic:
    """Return a table's places as points of W, or a diagnostic.

    A `height` is z; an `ele` is above the sea. Without a height z is 0.
    name : of the file, which the mission names at ``path``
    """
    if "x" in table.columns:
        i, j = (table.columns.index(column) for column in ("x", "y"))
        return list(zip(_column(table, i), _column(table, j), _heights(table, "z"), strict=True))
    label = (origins.value(path),)
    if origin is None:
        message = f"`{name}` gives latitudes and longitudes, but the mission has no origin"
        return Diagnostic(
            "G015", message, label, help="add `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
        )
    above_sea = "ele" in table.columns
    if above_sea and ("world", "origin", "alt") not in origins.values:
        message = f"`{name}` gives elevations above sea level, but the origin has no altitude"
        return Diagnostic(
            "G015", message, label, help="add `alt`, its height above sea level, to `world.origin`"
        )
    i, j = (table.columns.index(column) for column in ("lat", "lon"))
    heights = _heights(table, "ele" if above_sea else "height")
    for number, row in enumerate(table.rows, 1):
        outlier = stray(origin, row[i], row[j])
        if outlier is not None:
            line = table.lines[number - 1]
            notes = (f"point {number} of {len(table.rows)} in `{name}`, line {line}", outlier.note)
            return Diagnostic("G017", outlier.message, label, notes, outlier.help)
    base = (origin.lat_deg, origin.lon_deg, origin.alt)
    put = to_world if above_sea else above_ground
    return [put((row[i], row[j], height), base) for row, height in zip(table.rows, heights, strict=True)]


def _column(table: NumberTable, i: int) -> list[float]:
    return [row[i] for row in table.rows]


def _heights(table: NumberTable, name: str) -> list[float]:
    """Return a column of heights, metres; 0 for a table without one."""
    return _column(table, table.columns.index(name)) if name in table.columns else [0.0] * len(table.rows)
