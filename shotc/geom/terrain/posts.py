"""Posts: heights on a grid, in the coordinate system of their file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array

MOST_POSTS = 20_000_000
"""Most posts of a file; 3601 x 3601 are 13 million."""
LOWEST_M, HIGHEST_M = -500.0, 9000.0
"""Range of heights on land, metres; a height beyond it is a marker for something else."""

FaultKind = Literal[
    "format",  # its content does not match its name, or is in no supported format
    "truncated",  # it ends too early, or is longer than its header states
    "number",  # an impossible height or position
    "grid",  # its posts are no grid, or a rotated one
    "size",  # it has too many posts, or the mission's part has too many triangles
    "system",  # its coordinate system is missing, unknown, or stated twice
    "pyproj",  # its system needs pyproj, which is not installed
    "origin",  # it is georeferenced, and the mission has no origin
    "outside",  # it does not cover the mission
    "empty",  # it has no heights
]


class TerrainFault(NamedTuple):
    """A fault of an elevation model; line : of the file, from 1, if one line has the fault."""

    kind: FaultKind
    message: str
    line: int | None = None
    help: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Posts:
    """Heights on a grid.

    heights : shape (R, C), metres; NaN where the file has none
    x : shape (C,), increasing: metres East, or degrees of longitude
    y : shape (R,), increasing: metres North, or degrees of latitude
    system : EPSG code of x and y; None for metres of W
    """

    heights: Array
    x: Array
    y: Array
    system: int | None


def posts_of(heights: Array, x: Array, y: Array, system: int | None) -> Posts | TerrainFault:
    """Return posts from rows and columns in either direction, or their fault.

    heights : (R, C), NaN where there is none; x : (C,); y : (R,); system : as in ``Posts``
    """
    if min(heights.shape) < 2:
        return TerrainFault("grid", f"it has {_posts(heights.shape)}; two rows and two columns are the least")
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return TerrainFault("number", "its posts have no finite places")
    if x[0] > x[-1]:
        x, heights = x[::-1], heights[:, ::-1]
    if y[0] > y[-1]:
        y, heights = y[::-1], heights[::-1]
    for name, values in (("columns", x), ("rows", y)):
        wrong = np.flatnonzero(np.diff(values) <= 0.0)
        if len(wrong):
            where = f"{values[wrong[0]]:g} to {values[wrong[0] + 1]:g}"
            return TerrainFault("grid", f"the places of its {name} do not go one way: {where}")
    known = ~np.isnan(heights)
    if not known.any():
        return TerrainFault("empty", f"none of its {_posts(heights.shape)} has a height")
    no_land = np.argwhere(known & ~((heights >= LOWEST_M) & (heights <= HIGHEST_M)))
    if len(no_land):
        i, j = no_land[0]
        message = f"{len(no_land)} of its {_posts(heights.shape)} have heights that no land has"
        where = f"such as {heights[i, j]:g} m at {x[j]:.10g}, {y[i]:.10g}"
        help_ = "name the value that stands for no height in the file (`NODATA_value`, or the tag of GDAL)"
        return TerrainFault("number", f"{message}, {where}", None, help_)
    return Posts(np.ascontiguousarray(heights, dtype=np.float64), x.copy(), y.copy(), system)


def _posts(shape: tuple[int, ...]) -> str:
    return f"{shape[0]} x {shape[1]} posts"
