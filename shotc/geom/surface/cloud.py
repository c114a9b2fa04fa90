"""Point clouds as surfaces: each point is a triangle without size, which represents a ball around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.surface.near import within
from shotc.geom.surface.tree import Surface, surface_of

MOST_POINTS = 1_000_000
"""Most points of a surface; of larger clouds each cell of a grid keeps one."""
_SAMPLED_POINTS = 2_000  # points whose neighbours are searched
_NEIGHBOUR_POINTS = 8  # points before and after one in Morton order that are tried as neighbours
_FIRST_CELLS = 4096  # cells along the longest side of a cloud in the first attempt to thin it
_LARGER_RATIO = 1.1  # factor on the estimated size of cells


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """A point cloud as a surface.

    surface : its triangles are one point three times, metres
    moved   : largest distance from a point of the file to the one that represents it, metres
    """

    surface: Surface
    moved: float


def cloud_of(points: Array) -> Cloud:
    """Return the cloud of points (N, 3), metres; of more than MOST_POINTS each cell of a grid keeps one."""
    thinned, moved = (points, 0.0) if len(points) <= MOST_POINTS else _thinned(points, MOST_POINTS)
    return Cloud(surface_of(np.repeat(thinned[:, None, :], 3, axis=1)), moved)


@dataclass(frozen=True, slots=True, eq=False)
class Splats:
    """Points that represent a cloud: one in each occupied cell of a grid.

    middle : of the box around the points of each cell, (M, 3), metres; first : index of one of them, (M,)
    size   : of the cells, metres
    """

    middle: Array
    first: IntArray
    size: float


def splats(points: Array, size: float, most: int) -> Splats:
    """Return at most ``most`` representatives of points (N, 3), N > 0, in cells of ``size`` m or more."""
    while True:
        order, starts = _in_cells(points, size)
        if len(starts) <= most:
            lowest, highest = _boxes(points[order], starts)
            return Splats(np.asarray(0.5 * (lowest + highest)), order[starts], size)
        size *= max(
            _LARGER_RATIO, _LARGER_RATIO * float(np.sqrt(len(starts) / most))
        )  # most clouds are surfaces


def _thinned(points: Array, most: int) -> tuple[Array, float]:
    """Return the box middles of each cell's points, (M, 3), and the largest distance moved."""
    discs = splats(points, float(np.ptp(points, axis=0).max()) / _FIRST_CELLS, most)
    order, starts = _in_cells(points, discs.size)
    counts = np.diff(np.append(starts, len(points)))
    moved = np.linalg.norm(points[order] - np.repeat(discs.middle, counts, axis=0), axis=1).max()
    return discs.middle, float(moved)


def _in_cells(points: Array, size: float) -> tuple[IntArray, IntArray]:
    """Return an order of points, (N,), cell by cell, and the start of each cell in it, (M,)."""
    cell = ((points - points.min(axis=0)) / max(size, 1e-9)).astype(np.int64)
    key = (cell[:, 0] << 42) | (cell[:, 1] << 21) | cell[:, 2]
    order = np.argsort(key, kind="stable")
    return order, np.flatnonzero(np.concatenate([[True], np.diff(key[order]) > 0]))


def _boxes(ordered: Array, starts: IntArray) -> tuple[Array, Array]:
    return np.minimum.reduceat(ordered, starts), np.maximum.reduceat(ordered, starts)


def median_spacing(surface: Surface) -> float:
    """Return the median distance of a cloud's points from their nearest distinct neighbours, metres.

    It is taken over at most 2,000 points, evenly spaced in Morton order; 0 if all points coincide.
    """
    picked = np.unique(np.linspace(0, len(surface) - 1, _SAMPLED_POINTS).astype(np.intp))
    p, nearest = surface.triangles[picked, 0], _near_in_order(surface, picked)
    known = np.isfinite(nearest)
    p, nearest = p[known], nearest[known]
    pairs = within(surface, p, p, nearest)
    distance = np.linalg.norm(surface.triangles[pairs.triangle, 0] - p[pairs.item], axis=1)
    elsewhere = distance > 0.0
    np.minimum.at(nearest, pairs.item[elsewhere], distance[elsewhere])
    return float(np.median(nearest)) if len(nearest) else 0.0


def _near_in_order(surface: Surface, picked: IntArray) -> Array:
    """Return the distance of each point from the nearest distinct one of its neighbours in Morton order."""
    beside = np.clip(
        picked[:, None] + np.arange(-_NEIGHBOUR_POINTS, _NEIGHBOUR_POINTS + 1), 0, len(surface) - 1
    )
    points = surface.triangles[:, 0]
    distance = np.linalg.norm(points[beside] - points[picked][:, None], axis=2)
    return np.asarray(np.where(distance > 0.0, distance, np.inf).min(axis=1))
