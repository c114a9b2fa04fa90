"""Posts: heights on a grid, in the system of coordinates of the file that they are of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array

MOST_POSTS = 20_000_000
"""Posts of a file; 3601 x 3601 are 13 million."""
LOWEST, HIGHEST = -500.0, 9000.0
"""Metres: no land is lower or higher, so that such a height is a mark of something else."""

FaultKind = Literal[
    "format",  # it is not what its name says, or no format that is read
    "truncated",  # it ends too soon, or is longer than its header says
    "number",  # a height or a place that cannot be
    "grid",  # its posts are no grid, or one that is turned
    "size",  # it has more posts than are read, or the mission's part of it more triangles
    "system",  # its system of coordinates is not said, not known, or said twice
    "pyproj",  # its system takes pyproj, which is not installed
    "origin",  # it lies on the earth, and the mission has no origin
    "outside",  # nothing of it is where the mission is
    "empty",  # it has no heights
]


class TerrainFault(NamedTuple):
    """What is wrong with an elevation model; line : of the file, from 1, where one is to blame."""

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
    system : EPSG code of x and y; None where they are metres of W
    """

    heights: Array
    x: Array
    y: Array
    system: int | None


def posts_of(heights: Array, x: Array, y: Array, system: int | None) -> Posts | TerrainFault:
    """Return posts whose rows and columns run either way, or why they cannot be.

    heights : (R, C), NaN where there is none; x : (C,); y : (R,)
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
    no_land = np.argwhere(known & ~((heights >= LOWEST) & (heights <= HIGHEST)))
    if len(no_land):
        i, j = no_land[0]
        message = f"{len(no_land)} of its {_posts(heights.shape)} have heights that no land has"
        where = f"such as {heights[i, j]:g} m at {x[j]:.10g}, {y[i]:.10g}"
        help_ = "name the value that stands for no height in the file (`NODATA_value`, or the tag of GDAL)"
        return TerrainFault("number", f"{message}, {where}", None, help_)
    return Posts(np.ascontiguousarray(heights, dtype=np.float64), x.copy(), y.copy(), system)


def _posts(shape: tuple[int, ...]) -> str:
    return f"{shape[0]} x {shape[1]} posts"
