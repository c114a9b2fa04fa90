"""How near flown drones come, straight in between the places where they were recorded.

Of a plan this is proved (``geom.separation``); a simulation is one flight of many, and its records are close
enough: over a period a drone leaves the straight line by millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array

NARROWINGS = 30
"""Times that two thirds of an interval are kept; the distance of two drones is convex over it."""


@dataclass(frozen=True, slots=True)
class Near:
    """The nearest that two drones came, metres of horizontal distance as in ``geom.separation``.

    first, second : their rows; time : when, s; below : how many pairs came nearer than was asked about
    """

    distance: float
    first: int
    second: int
    time: float
    below: int


def nearest(times: Array, position: Array, apart: Distances, limit: float) -> Near:
    """Return the nearest of all pairs; position : shape (n, T, 3), two drones or more, two times or more.

    limit : metres of horizontal distance, for ``Near.below``
    """
    seen = np.moveaxis(position * [1.0, 1.0, stretch(apart)], 1, 0)
    upright = apart.shape == "cylinder"
    best = Near(np.inf, 0, 0, 0.0, 0)
    low: set[tuple[int, int]] = set()
    for k in range(len(times) - 1):
        start, end = (each - each.mean(axis=0) for each in seen[k : k + 2])
        pairs = _candidates(start, end, max(limit, best.distance), upright)
        if not len(pairs):
            continue
        one, other = start[pairs[:, 0]] - start[pairs[:, 1]], end[pairs[:, 0]] - end[pairs[:, 1]]
        least, share = _least(one, other, upright)
        low.update((int(i), int(j)) for i, j in pairs[least < limit])
        m = int(np.argmin(least))
        if least[m] < best.distance:
            when = float(times[k] + share[m] * (times[k + 1] - times[k]))
            best = Near(float(least[m]), int(pairs[m, 0]), int(pairs[m, 1]), when, 0)
    return Near(best.distance, best.first, best.second, best.time, len(low))


def _candidates(start: Array, end: Array, reach: float, upright: bool) -> Array:
    """Return the pairs of rows that may come within reach of each other, shape (K, 2)."""
    middle = 0.5 * (start + end)
    tree = cKDTree(middle)
    if not np.isfinite(reach):
        reach = float(tree.query(middle, k=2)[0][:, 1].min())
    moved = float(np.linalg.norm(end - start, axis=1).max())
    # A ball holds the cylinder: what is near in its sense is near in the tree's.
    far = reach * (np.sqrt(2.0) if upright else 1.0) + moved
    return np.asarray(tree.query_pairs(far * (1.0 + 1e-9), output_type="ndarray"))


def _least(one: Array, other: Array, upright: bool) -> tuple[Array, Array]:
    """Return the least distance between straight moves and at which share of them, shape (K,) each."""
    low, high = np.zeros(len(one)), np.ones(len(one))
    for _ in range(NARROWINGS):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        nearer = _size(one, other, left, upright) < _size(one, other, right, upright)
        low, high = np.where(nearer, low, left), np.where(nearer, right, high)
    share = 0.5 * (low + high)
    return _size(one, other, share, upright), share


def _size(one: Array, other: Array, share: Array, upright: bool) -> Array:
    away = one + share[:, None] * (other - one)
    if upright:
        return np.asarray(np.maximum(np.linalg.norm(away[:, :2], axis=1), np.abs(away[:, 2])))
    return np.asarray(np.linalg.norm(away, axis=1))
