"""Draws points uniformly inside closed meshes and outlines, from vertical lines through them.

A column is a vertical line. Its spans lie between its crossings with the shape's surface. Points drawn
uniformly from the spans of uniformly spread columns are uniform in the shape.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array

Numbers = NDArray[np.intp]

CHUNK_FACES = 1_000_000
"""Pairs of faces and columns that are processed together: some hundred megabytes."""


class Columns(NamedTuple):
    """Columns, one in every cell of a grid.

    low, cell : (D,), corner and cell size of the grid; D = 2 for meshes and 1 for outlines
    counts : number of cells along each axis
    places : (C, D), in the order of the cells, the last axis fastest
    """

    low: Array
    cell: Array
    counts: tuple[int, ...]
    places: Array


class Crossings(NamedTuple):
    """Crossings of columns with a surface: columns (K,), heights (K,), and sign, +1 to enter, -1 to leave."""

    column: Numbers
    height: Array
    sign: Numbers


class ColumnPieces(NamedTuple):
    """Spans of columns inside a shape: columns (K,), lower and upper ends (K,)."""

    column: Numbers
    low: Array
    high: Array


def columns_below(low: Array, high: Array, count: int, rng: np.random.Generator) -> Columns:
    """Return about ``count`` columns spread uniformly over a box with two corners of shape (D,)."""
    size = np.maximum(high - low, 1e-9 * max(1.0, float((high - low).max())))
    side = (float(size.prod()) / count) ** (1.0 / len(size))
    counts = tuple(int(min(max(1, round(s / side)), count)) for s in size)
    cell = size / np.array(counts)
    index = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), axis=-1)
    index = index.reshape(-1, len(size))
    return Columns(low, cell, counts, low + (index + rng.random(index.shape)) * cell)


def column_at(place: Array) -> Columns:
    """Return a single column, at a place of shape (D,)."""
    return Columns(place - 0.5, np.ones(len(place)), (1,) * len(place), place[None, :])


def through_triangles(columns: Columns, corners: Array) -> Crossings:
    """Return the crossings of columns with triangles (T, 3, 3), counter-clockwise seen from outside."""
    crossings = [_through(columns, corners[part], cells) for part, cells in _chunks(columns, corners)]
    return _joined(crossings)


def through_edges(columns: Columns, edges: Array) -> Crossings:
    """Return the crossings of columns in a plane with directed edges (E, 2, 2)."""
    crossings = []
    for part, cells in _chunks(columns, edges):
        a, b = edges[part, 0], edges[part, 1]
        x = columns.places[cells, 0]
        met = (x >= np.minimum(a[:, 0], b[:, 0])) & (x < np.maximum(a[:, 0], b[:, 0]))
        a, b, x = a[met], b[met], x[met]
        y = a[:, 1] + (x - a[:, 0]) / (b[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
        crossings.append(Crossings(cells[met], y, np.where(b[:, 0] > a[:, 0], 1, -1)))
    return _joined(crossings)


def spans(crossings: Crossings, parity: bool) -> ColumnPieces:
    """Return the spans inside: by non-zero winding number, or by an odd number of crossings if ``parity``.

    A column through an edge between two faces may count it twice or not at all; such columns are left out.
    """
    order = np.lexsort((crossings.height, crossings.column))
    column, height = crossings.column[order], crossings.height[order]
    sign = np.ones(len(order), dtype=np.intp) if parity else crossings.sign[order]
    ends = np.bincount(column, sign, minlength=1) if len(column) else np.zeros(1)
    whole = (ends % 2 == 0) if parity else (ends == 0)
    chosen = whole[column]
    column, height, winding = column[chosen], height[chosen], np.cumsum(sign[chosen])
    inside = np.flatnonzero((winding % 2 != 0) if parity else (winding != 0))
    return ColumnPieces(column[inside], height[inside], height[inside + 1])


def united(shapes: list[ColumnPieces]) -> ColumnPieces:
    """Return the spans inside any of several shapes."""
    entered = [Crossings(s.column, s.low, np.ones(len(s.column), dtype=np.intp)) for s in shapes]
    left = [Crossings(s.column, s.high, -np.ones(len(s.column), dtype=np.intp)) for s in shapes]
    return spans(_joined([*entered, *left]), False)


def volume(columns: Columns, inside: ColumnPieces) -> float:
    """Return the volume (or area) inside, estimated from the columns, m^3 (m^2)."""
    return float((inside.high - inside.low).sum() * columns.cell.prod())


def drawn(columns: Columns, inside: ColumnPieces, count: int, rng: np.random.Generator) -> Array:
    """Return ``count`` points drawn uniformly from at least one span, shape (count, D + 1)."""
    ends = np.cumsum(inside.high - inside.low)
    along = (np.arange(count) + rng.random(count)) / count * ends[-1]
    k = np.minimum(np.searchsorted(ends, along, side="right"), len(ends) - 1)
    height = inside.high[k] - (ends[k] - along)
    return np.column_stack([columns.places[inside.column[k]], height])


def _through(columns: Columns, corners: Array, cells: Numbers) -> Crossings:
    # Barycentric coordinates of the columns in each triangle, seen from above.
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac, ap = (b - a)[:, :2], (c - a)[:, :2], columns.places[cells] - a[:, :2]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    safe = np.where(area == 0, 1.0, area)
    u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / safe
    v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / safe
    met = (area != 0) & (u >= 0) & (v >= 0) & (u + v <= 1)
    height = a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2]
    return Crossings(cells[met], height[met], np.where(area[met] > 0, -1, 1))


def candidates(columns: Columns, corners: Array) -> tuple[Numbers, Numbers]:
    """Return the first cell below the box of each face (T, D), and the number of covered cells (T, D).

    The product of the latter measures the work.

    corners : shape (T, 3, 3), or (E, 2, 2) for edges
    """
    width = len(columns.counts)
    low, high = corners.min(axis=1)[:, :width], corners.max(axis=1)[:, :width]
    most = np.array(columns.counts) - 1
    first = np.clip((low - columns.low) // columns.cell, 0, most).astype(np.intp)
    last = np.clip((high - columns.low) // columns.cell, 0, most).astype(np.intp)
    return first, last - first + 1


def _chunks(columns: Columns, corners: Array) -> Iterator[tuple[Numbers, Numbers]]:
    """Yield pairs of faces and cells below their boxes, in parts of limited size."""
    width = len(columns.counts)
    first, across = candidates(columns, corners)
    each = across.prod(axis=1)
    bounds = np.searchsorted(np.cumsum(each), np.arange(CHUNK_FACES, each.sum() + CHUNK_FACES, CHUNK_FACES))
    begin = 0
    for end in np.unique(np.append(np.minimum(bounds + 1, len(each)), len(each))):
        faces = np.repeat(np.arange(begin, end), each[begin:end])
        step = np.arange(len(faces)) - np.repeat(
            np.cumsum(each[begin:end]) - each[begin:end], each[begin:end]
        )
        cell = first[faces, 0] + (step if width == 1 else step // across[faces, 1])
        if width == 2:
            cell = cell * columns.counts[1] + first[faces, 1] + step % across[faces, 1]
        yield faces, cell
        begin = int(end)


def _joined(parts: list[Crossings]) -> Crossings:
    if not parts:
        return Crossings(np.zeros(0, np.intp), np.zeros(0), np.zeros(0, np.intp))
    return Crossings(*(np.concatenate(column) for column in zip(*parts, strict=True)))
