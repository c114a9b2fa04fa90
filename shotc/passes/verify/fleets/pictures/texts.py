"""Texts as figures: the outlines of matplotlib's text paths, in the font that it brings."""

from __future__ import annotations

from math import sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.show import Lettering
from shotc.passes.verify.fleets.pictures.figure import Figure, evenly, turned

FONT = "DejaVu Sans"
"""The font of a text without one; it comes with matplotlib."""

CAPITAL_POINTS = 60
"""Points in the height of a capital."""

BLOCK_PAIRS = 2_000_000
"""Most pairs of places and edges at once."""


def text_figure(source: Lettering, *, outline: bool) -> Figure | None:
    """Return a text, its inside or its edges; None where the font is not matplotlib's own.

    A text whose drones may stand on either is judged by its inside, whose border the edges are.
    """
    if source.font is not None:
        return None
    rings = _rings(source)
    edges = np.concatenate([np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings])
    axes, centre = turned(source.heading), np.array(source.centre)
    step = source.height / CAPITAL_POINTS
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    area = abs(sum(_area(ring) for ring in rings))
    flat = _along(edges, lengths, step) if outline else _inside(edges, step)
    strokes = float(lengths.sum()) * (1.0 if outline else 0.5)

    def off(places: Array) -> Array:
        right, ahead, up = ((places - centre) @ axes.T).T
        there = np.column_stack([right, up])
        aside = _from_edges(there, edges)
        if not outline:
            aside = np.where(_turns(there, edges) != 0, 0.0, aside)
        return np.asarray(np.hypot(aside, ahead))

    def part(n: int) -> float:
        return max(strokes / n, 0.0 if outline else sqrt(area / n))

    points = centre + flat[:, :1] * axes[0] + flat[:, 1:] * axes[2]
    return Figure(points, evenly(len(points)), off, part)


def _rings(source: Lettering) -> list[Array]:
    """Return the closed outlines of a text about the middle of its box, metres, without their last point."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family=FONT)
    capital = np.ptp(np.asarray(TextPath((0.0, 0.0), "H", size=100.0, prop=font).vertices)[:, 1])
    # A dollar sign is a letter here, and no mathematics.
    path = TextPath((0.0, 0.0), source.text.replace("$", r"\$"), size=100.0, prop=font)
    polygons = [np.asarray(ring, dtype=np.float64) for ring in path.to_polygons(closed_only=True)]
    rings = [ring[:-1] for ring in polygons if len(ring) > 3]
    corners = np.concatenate(rings)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    return [np.asarray((ring - middle) * (source.height / capital)) for ring in rings]


def _area(ring: Array) -> float:
    """Return the signed area of a polygon; holes go round the other way (the shoelace formula)."""
    x, y = ring.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _along(edges: Array, lengths: Array, step: float) -> Array:
    """Return points along edges, a step apart."""
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    way = np.arange(0.5 * step, ends[-1], step)
    k = np.minimum(np.searchsorted(ends, way, side="right") - 1, len(edges) - 1)
    share = (way - ends[k]) / np.maximum(lengths[k], 1e-12)
    return np.asarray(edges[k, 0] + share[:, None] * (edges[k, 1] - edges[k, 0]))


def _inside(edges: Array, step: float) -> Array:
    """Return the points of a grid that are within outlines."""
    corners = edges.reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes = [np.arange(a + 0.5 * step, b, step) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(grid[_turns(grid, edges) != 0])


def _turns(places: Array, edges: Array) -> Array:
    """Return how often outlines go round places (n, 2), shape (n,): edges that pass on their right count."""
    parts = []
    for some in _blocks(places, len(edges)):
        x, y = some[:, :1], some[:, 1:]
        (ax, ay), (bx, by) = edges[:, 0].T, edges[:, 1].T
        side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        up, down = (ay <= y) & (by > y) & (side > 0.0), (ay > y) & (by <= y) & (side < 0.0)
        parts.append(up.sum(axis=1) - down.sum(axis=1))
    return np.concatenate(parts)


def _from_edges(places: Array, edges: Array) -> Array:
    """Return the distances of places (n, 2) from the nearest edge, shape (n,)."""
    first, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    square = np.maximum((along**2).sum(axis=1), 1e-12)
    parts = []
    for some in _blocks(places, len(edges)):
        there = some[:, None] - first
        share = np.clip((there * along).sum(axis=2) / square, 0.0, 1.0)
        parts.append(np.linalg.norm(there - share[..., None] * along, axis=2).min(axis=1))
    return np.concatenate(parts)


def _blocks(places: Array, edges: int) -> list[Array]:
    return np.array_split(places, max(1, len(places) * edges // BLOCK_PAIRS))
