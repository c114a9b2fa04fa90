"""Posts in a table (.csv): x, y, z in metres of W, or lat, lon, alt; one row for each post, in any order."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.terrain.posts import MOST_POSTS, Posts, TerrainFault, posts_of
from shotc.geom.terrain.systems import GEOGRAPHIC, WGS84_EPSG
from shotc.kinds.files import FileFault, read_table

LAYOUTS = (("x", "y", "z"), ("lat", "lon", "alt"))
MOST_ROWS = 1_000_000
FULL_SHARE = 0.5
"""Least share of a grid's places with a post; with fewer, the points are no grid."""
SAME_PLACE_SHARE = 1e-6
"""Tolerance of equal coordinates, as a share of the axis's extent, because tables are rounded."""
USUAL_GAP_SHARE = 0.25
"""Quantile of the gaps between columns or rows that is the step of the grid; larger gaps lack some."""


def read_csv_posts(data: bytes, system: int | None = None) -> Posts | TerrainFault:
    """Return the posts of a table, or its fault.

    Omitted places of the grid, and omitted rows, have no height.
    """
    table = read_table(data, LAYOUTS, most=MOST_ROWS)
    if isinstance(table, FileFault):
        return TerrainFault("format", *table)
    columns = {name: i for i, name in enumerate(table.columns)}
    on_earth = "lat" in columns
    if system is not None and not (on_earth and system in GEOGRAPHIC):
        message = f"its columns say where its posts are, not EPSG:{system}"
        return TerrainFault("system", message, None, "leave `epsg` out")
    rows = np.array(table.rows)
    names = ("lon", "lat", "alt") if on_earth else LAYOUTS[0]
    x, y, z = (rows[:, columns[name]] for name in names)
    (x_places, column), (y_places, row) = _places(x), _places(y)
    shape = (len(y_places), len(x_places))
    if shape[0] * shape[1] > MOST_POSTS or len(rows) < FULL_SHARE * shape[0] * shape[1]:
        message = f"its {len(rows)} points lie on {shape[0]} rows and {shape[1]} columns"
        help_ = "export a grid: every row of it has a point on every column"
        return TerrainFault("grid", f"{message}, so that they are no grid", None, help_)
    place = row * shape[1] + column
    _, first, count = np.unique(place, return_index=True, return_counts=True)
    if (count > 1).any():
        again = int(np.setdiff1d(np.arange(len(place)), first)[0])
        return TerrainFault("grid", "a point lies where another does", table.lines[again])
    heights = np.full(shape, np.nan)
    heights[row, column] = z
    return posts_of(heights, x_places, y_places, WGS84_EPSG if on_earth else None)


def _places(values: Array) -> tuple[Array, IntArray]:
    """Return the increasing coordinates along an axis, gaps filled, and the index of each value."""
    order = np.argsort(values, kind="stable")
    ordered = values[order]
    is_first = np.concatenate([[True], np.diff(ordered) > SAME_PLACE_SHARE * (ordered[-1] - ordered[0])])
    number = np.empty(len(values), dtype=np.intp)
    number[order] = np.cumsum(is_first) - 1
    there = ordered[is_first]
    gaps = np.diff(there)
    if not len(gaps):
        return there, number
    steps = np.rint(gaps / np.quantile(gaps, USUAL_GAP_SHARE, method="lower"))
    at = np.concatenate([[0.0], np.cumsum(np.maximum(steps, 1.0))])
    if at[-1] > MOST_POSTS:
        return there, number  # no grid, as its count of places says
    return np.interp(np.arange(at[-1] + 1.0), at, there), at.astype(np.intp)[number]
