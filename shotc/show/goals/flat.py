"""Flat vertical pictures: filled polygons, and lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.ir.effects import Color
from shotc.ir.fleet import Colors
from shotc.show.geom.columns import (
    ColumnPieces,
    Columns,
    Numbers,
    columns_below,
    drawn,
    spans,
    through_edges,
    united,
    volume,
)
from shotc.show.goals.body import Fill, upright_axes

COLUMNS_PER_POINT = 0.25
"""Columns drawn for each point: most columns carry several points, and thin strokes are hit often enough."""

FINE_COLUMNS, MOST_POINTS = 2000, 200_000
"""Columns, and points of each shape's edges and of all edges, to determine the visible shape at a place."""
UNPAINTED: Color = (255, 255, 255)


@dataclass(frozen=True, slots=True, eq=False)
class FlatPart:
    """A part of a flat picture.

    edges : shape (E, 2, 2), from (right, up) to (right, up), metres from the picture's middle
    filled : whether its inside is visible
    parity : whether the inside follows the even-odd rule
    width : of its lines, metres, which are drawn with the fills if it has no visible inside
    color : its paint; None if a light cannot show it
    """

    edges: Array
    filled: bool
    parity: bool
    width: float
    color: Color | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FlatBody:
    """Shapes in a vertical plane, perpendicular to a heading; axes as in ``upright_axes``."""

    shapes: tuple[FlatPart, ...]
    centre: Array
    axes: Array

    def draw(self, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
        """Return points of the filled areas or of the edges, shape (count, 3); None if it has none."""
        lines = [s for s in self.shapes if fill == "outline" or not s.filled]
        edges = np.concatenate([s.edges for s in lines]) if lines else np.zeros((0, 2, 2))
        if fill == "outline":
            return self.standing(_along(edges, count, rng))
        columns, inside = self._inside(count, rng)
        area = volume(columns, inside)
        strokes = float(sum(_lengths(s.edges).sum() * s.width for s in lines))
        on_lines = round(count * strokes / (area + strokes)) if area + strokes > 0 else 0
        parts = [_along(edges, on_lines, rng)] if on_lines else []
        if count > on_lines and len(inside.low):
            parts.append(drawn(columns, inside, count - on_lines, rng))
        return self.standing(np.concatenate(parts)) if parts else None

    def encloses(self, place: Array) -> bool:
        """Return False for a place (3,), because it has no inside."""
        return False

    def colors(self, places: Array) -> Colors | None:
        """Return the colours of the visible shapes at places, or of the nearest edges, shape (n, 3)."""
        if all(shape.color is None for shape in self.shapes):
            return None
        seen = _seen(self.shapes, self.flat(places))
        return np.array([self.shapes[k].color or UNPAINTED for k in seen], dtype=np.uint8)

    @property
    def outlines(self) -> float:
        """Length of all edges, metres."""
        return float(sum(_lengths(s.edges).sum() for s in self.shapes))

    @property
    def stroke(self) -> float:
        """Width of strokes with this area and these edges, metres."""
        columns, inside = self._inside(FINE_COLUMNS, np.random.default_rng(0))
        return 2.0 * volume(columns, inside) / self.outlines

    def _inside(self, count: int, rng: np.random.Generator) -> tuple[Columns, ColumnPieces]:
        corners = np.concatenate([s.edges.reshape(-1, 2) for s in self.shapes])
        low, high = corners[:, :1].min(axis=0), corners[:, :1].max(axis=0)
        columns = columns_below(low, high, max(50, round(COLUMNS_PER_POINT * count)), rng)
        intervals = [spans(through_edges(columns, s.edges), s.parity) for s in self.shapes if s.filled]
        return columns, united(intervals)

    def flat(self, places: Array) -> Array:
        """Return the (right, up) coordinates of places (n, 3) in the picture's plane, shape (n, 2)."""
        return np.asarray(((places - self.centre) @ self.axes.T)[:, [0, 2]])

    def standing(self, flat: Array) -> Array:
        """Return the places in W of (right, up), (n, 2), shape (n, 3)."""
        return np.asarray(self.centre + flat[:, :1] * self.axes[0] + flat[:, 1:] * self.axes[2])


def standing(shapes: Sequence[FlatPart], centre: Sequence[float], heading: float) -> FlatBody:
    """Return shapes at their place.

    centre : of their middle, W, metres
    heading : of the reader, rad
    """
    return FlatBody(tuple(shapes), np.array(centre), upright_axes(heading))


def closed(corners: Array) -> Array:
    """Return the edges (E, 2, 2) of a closed polygon with corners (E, 2)."""
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def chain(corners: Array) -> Array:
    """Return the edges (E, 2, 2) of a line through corners (E + 1, 2)."""
    return np.stack([corners[:-1], corners[1:]], axis=1)


def _lengths(edges: Array) -> Array:
    return np.asarray(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1))


def _along(edges: Array, count: int, rng: np.random.Generator) -> Array:
    ends = np.cumsum(_lengths(edges))
    place = (np.arange(count) + rng.random(count)) / count * ends[-1]
    k = np.minimum(np.searchsorted(ends, place, side="right"), len(ends) - 1)
    length = np.maximum(ends[k] - np.concatenate([[0.0], ends])[k], 1e-300)
    share = 1.0 - (ends[k] - place) / length
    return np.asarray(edges[k, 0] + share[:, None] * (edges[k, 1] - edges[k, 0]))


def _seen(shapes: Sequence[FlatPart], places: Array) -> Numbers:
    """Return the visible shape at places (n, 2): the last filled one there, or else the nearest."""
    rng = np.random.default_rng(0)
    count = max(4, min(FINE_COLUMNS, MOST_POINTS // len(shapes)))
    points = np.concatenate([_along(s.edges, count, rng) for s in shapes])
    numbers: Numbers = np.asarray(cKDTree(points).query(places)[1], dtype=np.intp) // count
    corners = np.concatenate([places, *(s.edges.reshape(-1, 2) for s in shapes)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    columns = columns_below(low[:1], high[:1], FINE_COLUMNS, rng)
    column = np.clip((places[:, 0] - low[0]) / columns.cell[0], 0, len(columns.places) - 1).astype(np.intp)
    tall = 2.0 * float(high[1] - low[1])
    for k, shape in enumerate(shapes):
        if shape.filled:
            inside = spans(through_edges(columns, shape.edges), shape.parity)
            # The spans of all columns are laid on one line, with an interval for each column.
            ends = inside.column * tall + inside.low - low[1]
            below = np.searchsorted(ends, column * tall + places[:, 1] - low[1], side="right") - 1
            some = np.flatnonzero(below >= 0)
            at = below[some]
            held = (inside.column[at] == column[some]) & (places[some, 1] <= inside.high[at])
            numbers[some[held]] = k
    return numbers
