"""Esri ASCII grids (.asc): a header of names and numbers, then rows of heights from the north."""

from __future__ import annotations

import io
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.terrain.posts import MOST_POSTS, Posts, TerrainFault, posts_of
from shotc.geom.terrain.systems import WGS84_EPSG
from shotc.kinds.files import finite

NEEDED = ("ncols", "nrows")
CORNERS = (("xllcorner", "xllcenter"), ("yllcorner", "yllcenter"))
STEPS = ("dx", "dy")
NAMES = {*NEEDED, "cellsize", *STEPS, "nodata_value", *(name for both in CORNERS for name in both)}
NO_HEIGHT_VALUE = -9999.0  # default no-data value
LARGEST_CELL_DEG = 0.1
"""Largest cell in degrees, for coordinates that may be degrees; no grid has smaller cells in metres."""


class GridHeader(NamedTuple):
    """Names and numbers, and the number of header lines."""

    values: dict[str, float]
    lines: int


class Steps(NamedTuple):
    """Distances of posts, East and North, in metres or degrees, and the number of columns and rows."""

    x: float
    y: float
    columns: int
    rows: int


def read_ascii_grid(data: bytes, system: int | None = None) -> Posts | TerrainFault:
    """Return the posts of a grid (the middles of its cells), or its fault.

    Grids in degrees are taken as WGS84.
    """
    try:
        lines = data.decode("ascii").splitlines()
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        return TerrainFault("format", "the file is no ASCII text", line)
    header = _header(lines)
    if isinstance(header, TerrainFault):
        return header
    steps = _steps(header.values)
    if isinstance(steps, TerrainFault):
        return steps
    heights = _heights(lines, header.lines, (steps.rows, steps.columns))
    if isinstance(heights, TerrainFault):
        return heights
    heights[heights == header.values.get("nodata_value", NO_HEIGHT_VALUE)] = np.nan
    x = np.asarray(_first(header.values, 0, steps.x) + steps.x * np.arange(steps.columns))
    y = np.asarray(_first(header.values, 1, steps.y) + steps.y * np.arange(steps.rows)[::-1])
    if system is None and steps.x < LARGEST_CELL_DEG and abs(x).max() <= 360.0 and abs(y).max() <= 90.0:
        system = WGS84_EPSG
    if system is None:
        help_ = (
            "give its `epsg` beside `file`, such as `epsg: 32632`; the .prj file beside it names the system"
        )
        return TerrainFault(
            "system", "the file does not say in which system of coordinates it is", None, help_
        )
    return posts_of(heights, x, y, system)


def _header(lines: list[str]) -> GridHeader | TerrainFault:
    values: dict[str, float] = {}
    for number, line in enumerate(lines, 1):
        words = line.split()
        name = words[0].lower() if words else ""
        if name not in NAMES:
            return _complete(values, number)
        if name in values:
            return TerrainFault("format", f"`{words[0]}` stands twice in the header", number)
        value = finite(words[1]) if len(words) == 2 else None
        if value is None:
            return TerrainFault("format", f"`{line.strip()[:40]}` is not a name and a number", number)
        values[name] = value
    return _complete(values, len(lines) + 1)


def _complete(values: dict[str, float], line: int) -> GridHeader | TerrainFault:
    step = ("cellsize",) if "cellsize" in values else STEPS
    corners = [next((name for name in both if name in values), both[0]) for both in CORNERS]
    lacking = [name for name in (*NEEDED, *corners, *step) if name not in values]
    if lacking:
        names = ", ".join(f"`{name}`" for name in lacking)
        return TerrainFault("format", f"its header lacks {names}", line)
    return GridHeader(values, line - 1)


def _steps(values: dict[str, float]) -> Steps | TerrainFault:
    columns, rows = values["ncols"], values["nrows"]
    if columns % 1 or rows % 1 or min(columns, rows) < 1:
        return TerrainFault("format", f"its header says {columns:g} columns and {rows:g} rows")
    if columns * rows > MOST_POSTS:
        return TerrainFault(
            "size",
            f"its header says {columns:g} x {rows:g} posts; {MOST_POSTS} are the most",
            None,
            "thin it",
        )
    x, y = values.get("cellsize", values.get("dx", 0.0)), values.get("cellsize", values.get("dy", 0.0))
    if min(x, y) <= 0.0:
        return TerrainFault("format", f"its header says cells of {x:g} by {y:g}")
    return Steps(x, y, int(columns), int(rows))


def _first(values: dict[str, float], axis: int, step: float) -> float:
    corner, centre = CORNERS[axis]
    return values[centre] if centre in values else values[corner] + 0.5 * step


def _heights(lines: list[str], skipped: int, shape: tuple[int, int]) -> Array | TerrainFault:
    body = lines[skipped:]
    try:  # fast path: one line for each row, and only numbers
        heights = np.loadtxt(io.StringIO("\n".join(body)), dtype=np.float64, ndmin=2, comments=None)
    except ValueError:
        heights = np.zeros((0, 0))
    if heights.shape == shape and np.isfinite(heights).all():
        return heights
    return _word_by_word(body, skipped, shape)


def _word_by_word(body: list[str], skipped: int, shape: tuple[int, int]) -> Array | TerrainFault:
    """Return heights with line breaks anywhere, or the first fault with its line."""
    values: list[float] = []
    for number, line in enumerate(body, skipped + 1):
        for word in line.split():
            value = finite(word)
            if value is None:
                help_ = "decimals have a point"
                return TerrainFault("number", f"`{word[:30]}` is not a height", number, help_)
            values.append(value)
    if len(values) != shape[0] * shape[1]:
        message = f"it has {len(values)} heights; its header says {shape[0]} rows of {shape[1]}"
        return TerrainFault("truncated", message)
    return np.array(values).reshape(shape)
