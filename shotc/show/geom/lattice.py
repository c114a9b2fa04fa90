"""Lattices: the densest formations in a shape, and their number of points in it.

For drones that keep a ball free, the densest packing in space is face-centred cubic, with sqrt 2 points in a
cube of their distance. In a plane it is hexagonal, with 2 / sqrt 3 points in a square. For vertical cylinders
it is hexagonal layers, each directly above the other. So a volume V holds at most about sqrt 2 V / s^3
points, an area A 2 A / (sqrt 3 s^2), a line L L / s. Shapes hold more near their border, so the points are
counted.
"""

from __future__ import annotations

from math import floor, sqrt
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array

MOST_BISECTIONS = 10
"""Bisection steps of the search for the widest lattice with enough points."""
MOST_POINTS = 4_000_000
"""Most points of a lattice around a shape; a shape that needs more is too thin for a lattice."""
PHASE_SHARES = (0.0, 0.5)
"""Shifts of a lattice along all axes, over its step, of which the one with most points is taken."""


class Mould(NamedTuple):
    """The region that a lattice fills.

    shape : points (M, D) of a shape, heights last, in the metric of the fleet
    slack : largest distance of a lattice point from them, metres
    upright : whether drones keep cylinders free
    """

    shape: cKDTree
    slack: float
    upright: bool


def lattice(low: Array, high: Array, step: float, upright: bool) -> Array:
    """Return the points of a lattice in a box with two corners of shape (D,), shape (K, D)."""
    if len(low) == 2:
        return rows_of(low, high, step, upright)
    wide, tall = step, step * sqrt(3.0) / 2.0
    deep = step * (1.0 if upright else sqrt(2.0 / 3.0))
    size = high - low
    # Layers repeat after three, because each lies in the hollows of the one below; rows repeat after two.
    k, j, i = np.meshgrid(
        np.arange(floor(size[2] / deep) + 1),
        np.arange(-1, floor(size[1] / tall) + 1),
        np.arange(-2, floor(size[0] / wide) + 1),
        indexing="ij",
    )
    hollow = 0.0 if upright else k % 3
    x = wide * (i + 0.5 * (j % 2) + 0.5 * hollow)
    y = tall * (j + hollow / 3.0)
    return _within(low, size, np.stack([x, y, deep * k], axis=-1).reshape(-1, 3))


def rows_of(low: Array, high: Array, step: float, square: bool) -> Array:
    """Return the points of a square or hexagonal lattice in a rectangle with corners (2,), shape (K, 2)."""
    tall, size = step * (1.0 if square else sqrt(3.0) / 2.0), high - low
    j, i = np.meshgrid(
        np.arange(floor(size[1] / tall) + 1), np.arange(-1, floor(size[0] / step) + 1), indexing="ij"
    )
    x = step * (i + (0.0 if square else 0.5 * (j % 2)))
    return _within(low, size, np.stack([x, tall * j], axis=-1).reshape(-1, 2))


def _within(low: Array, size: Array, points: Array) -> Array:
    return np.asarray(low + points[((points >= 0.0) & (points <= size)).all(axis=1)])


def laid(mould: Mould, step: float) -> Array:
    """Return the points of a lattice in a mould, shape (K, D), the nearest to the shape first."""
    points = np.asarray(mould.shape.data)
    low, high = points.min(axis=0) - mould.slack, points.max(axis=0) + mould.slack
    dimensions = len(low)
    if np.prod(np.ceil((high - low) / step) + 1.0) > MOST_POINTS:
        return np.zeros((0, dimensions))
    best, off = np.zeros((0, dimensions)), np.zeros(0)
    for phase in PHASE_SHARES:
        shift = np.full(dimensions, phase * step)
        places = lattice(low - shift, high, step, mould.upright)
        distances = mould.shape.query(places, distance_upper_bound=mould.slack)[0]
        inside = np.isfinite(distances)
        if inside.sum() > len(best):
            best, off = places[inside], distances[inside]
    return best[np.argsort(off, kind="stable")]


def widest(mould: Mould, number: int, least: float) -> Array | None:
    """Return ``number`` points of the widest lattice with enough points in a mould, (number, D); None if it
    is finer than ``least``.
    """
    best = laid(mould, least)
    if len(best) < number:
        return None
    low, high = least, 1.1 * least * (len(best) / number) ** (1.0 / best.shape[1])
    for _ in range(MOST_BISECTIONS):
        middle = 0.5 * (low + high)
        goals = laid(mould, middle)
        if len(goals) >= number:
            low, best = middle, goals
        else:
            high = middle
    return best[:number]
