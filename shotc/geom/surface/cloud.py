"""Clouds of points made a surface: each point a triangle without size, which stands for a ball about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.surface.near import within
from shotc.geom.surface.tree import Surface, surface_of

MOST_POINTS = 1_000_000
"""Points of a surface; of more, each cell of a grid keeps one."""
_SAMPLE = 2_000  # points whose neighbours are looked for
_BESIDE = 8  # points before and after one in Morton order, of which one is near
_FIRST_CELLS = 4096  # along the longest side of a cloud that is thinned, to begin with
_LARGER = 1.1  # times the size of cells that should do


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """Points, and how far they reach.

    surface : of triangles each of which is three times one point, metres
    moved   : the largest distance from a point of the file to the one that stands for it, metres
    """

    surface: Surface
    moved: float


def cloud_of(points: Array) -> Cloud:
    """Return points (N, 3), metres, or of more than MOST_POINTS one in each cell of a grid."""
    kept, moved = (points, 0.0) if len(points) <= MOST_POINTS else _thinned(points, MOST_POINTS)
    return Cloud(surface_of(np.repeat(kept[:, None, :], 3, axis=1)), moved)


@dataclass(frozen=True, slots=True, eq=False)
class Splats:
    """Few places that stand for a cloud: one in each cell of a grid that has points.

    middle : of the boxes round the points of each cell, (M, 3), metres; first : one of its points, (M,)
    size   : of the cells, metres
    """

    middle: Array
    first: IntArray
    size: float


def splats(points: Array, size: float, most: int) -> Splats:
    """Return at most so many places for points (N, 3), one at least, in cells of a size or larger, metres."""
    while True:
        order, begins = _in_cells(points, size)
        if len(begins) <= most:
            lowest, highest = _boxes(points[order], begins)
            return Splats(np.asarray(0.5 * (lowest + highest)), order[begins], size)
        size *= max(_LARGER, _LARGER * float(np.sqrt(len(begins) / most)))  # most clouds are of faces


def _thinned(points: Array, most: int) -> tuple[Array, float]:
    """Return the middles of the boxes round the points of each cell, and how far a point is from its own."""
    kept = splats(points, float(np.ptp(points, axis=0).max()) / _FIRST_CELLS, most)
    order, begins = _in_cells(points, kept.size)
    counts = np.diff(np.append(begins, len(points)))
    moved = np.linalg.norm(points[order] - np.repeat(kept.middle, counts, axis=0), axis=1).max()
    return kept.middle, float(moved)


def _in_cells(points: Array, size: float) -> tuple[IntArray, IntArray]:
    """Return an order of points, (N,), cell by cell, and where each cell begins in it."""
    cell = ((points - points.min(axis=0)) / max(size, 1e-9)).astype(np.int64)
    key = (cell[:, 0] << 42) | (cell[:, 1] << 21) | cell[:, 2]
    order = np.argsort(key, kind="stable")
    return order, np.flatnonzero(np.concatenate([[True], np.diff(key[order]) > 0]))


def _boxes(ordered: Array, begins: IntArray) -> tuple[Array, Array]:
    return np.minimum.reduceat(ordered, begins), np.maximum.reduceat(ordered, begins)


def median_spacing(surface: Surface) -> float:
    """Return the median distance of a cloud's points from their nearest neighbours elsewhere, metres.

    It is taken over at most 2,000 points, evenly picked in Morton order; 0 where all lie at one place.
    """
    picked = np.unique(np.linspace(0, len(surface) - 1, _SAMPLE).astype(np.intp))
    p, nearest = surface.triangles[picked, 0], _near_in_order(surface, picked)
    known = np.isfinite(nearest)
    p, nearest = p[known], nearest[known]
    pairs = within(surface, p, p, nearest)
    away = np.linalg.norm(surface.triangles[pairs.triangle, 0] - p[pairs.item], axis=1)
    elsewhere = away > 0.0
    np.minimum.at(nearest, pairs.item[elsewhere], away[elsewhere])
    return float(np.median(nearest)) if len(nearest) else 0.0


def _near_in_order(surface: Surface, picked: IntArray) -> Array:
    """Return how far each point is from the nearest of those beside it in Morton order, elsewhere."""
    beside = np.clip(picked[:, None] + np.arange(-_BESIDE, _BESIDE + 1), 0, len(surface) - 1)
    points = surface.triangles[:, 0]
    away = np.linalg.norm(points[beside] - points[picked][:, None], axis=2)
    return np.asarray(np.where(away > 0.0, away, np.inf).min(axis=1))
