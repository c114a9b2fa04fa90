"""The densest places of a shape: lattices, and how many of their points it holds.

In the metric of a fleet whose drones keep a ball free, points of space are densest as face-centred cubic,
sqrt 2 of them in a cube of their distance, and those of a plane as hexagons, 2 / sqrt 3 in a square. Upright
cylinders are densest in layers of hexagons, each above the other. So no volume V holds more than about
sqrt 2 V / s^3, no area A more than 2 A / (sqrt 3 s^2), no line L more than L / s. Near its border a shape
holds more, so they are counted.
"""

from __future__ import annotations

from math import floor, sqrt
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array

MOST_BISECTIONS = 10
"""Halvings by which the widest lattice is found that has points enough."""
MOST_POINTS = 4_000_000
"""Points of a lattice round a shape beyond which the shape is too thin for one to be laid."""
PHASES = (0.0, 0.5)
"""Shares of the step by which a lattice is shifted along all axes, to have the most points in the shape."""


class Mould(NamedTuple):
    """What a lattice is laid in.

    shape : points (M, D) of a shape, as densely as they are drawn, heights last, in the metric of the fleet
    slack : how far a point of the lattice may be off them, metres; upright : whether drones keep cylinders
    free
    """

    shape: cKDTree
    slack: float
    upright: bool


def lattice(low: Array, high: Array, step: float, upright: bool) -> Array:
    """Return the points of a lattice of a step in a box given by two corners of shape (D,), shape (K, D)."""
    if len(low) == 2:
        return rows_of(low, high, step, upright)
    wide, tall = step, step * sqrt(3.0) / 2.0
    deep = step * (1.0 if upright else sqrt(2.0 / 3.0))
    size = high - low
    # Layers lie in the hollows of those below, which comes round after three of them; rows after two.
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
    """Return the points of a lattice of squares or hexagons in a rectangle of corners (2,), shape (K, 2)."""
    tall, size = step * (1.0 if square else sqrt(3.0) / 2.0), high - low
    j, i = np.meshgrid(
        np.arange(floor(size[1] / tall) + 1), np.arange(-1, floor(size[0] / step) + 1), indexing="ij"
    )
    x = step * (i + (0.0 if square else 0.5 * (j % 2)))
    return _within(low, size, np.stack([x, tall * j], axis=-1).reshape(-1, 2))


def _within(low: Array, size: Array, points: Array) -> Array:
    return np.asarray(low + points[((points >= 0.0) & (points <= size)).all(axis=1)])


def laid(mould: Mould, step: float) -> Array:
    """Return the points of a lattice in a mould, shape (K, D), those nearest to the shape first."""
    points = np.asarray(mould.shape.data)
    low, high = points.min(axis=0) - mould.slack, points.max(axis=0) + mould.slack
    dimensions = len(low)
    if np.prod(np.ceil((high - low) / step) + 1.0) > MOST_POINTS:
        return np.zeros((0, dimensions))
    best, off = np.zeros((0, dimensions)), np.zeros(0)
    for phase in PHASES:
        shift = np.full(dimensions, phase * step)
        places = lattice(low - shift, high, step, mould.upright)
        away = mould.shape.query(places, distance_upper_bound=mould.slack)[0]
        inside = np.isfinite(away)
        if inside.sum() > len(best):
            best, off = places[inside], away[inside]
    return best[np.argsort(off, kind="stable")]


def widest(mould: Mould, number: int, least: float) -> Array | None:
    """Return so many points of the widest lattice that has them in a mould; None where it is finer than
    ``least``.
    """
    best = laid(mould, least)
    if len(best) < number:
        return None
    low, high = least, 1.1 * least * (len(best) / number) ** (1.0 / best.shape[1])
    for _ in range(MOST_BISECTIONS):
        middle = 0.5 * (low + high)
        found = laid(mould, middle)
        if len(found) >= number:
            low, best = middle, found
        else:
            high = middle
    return best[:number]
