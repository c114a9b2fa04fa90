"""Distances of simulated drones, with straight motion between recorded positions.

For a plan this is proved (``geom.separation``). A simulation is only one of many flights, and its records are
dense: within a period a drone deviates from the straight line by millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array
from shotc.geom.surface.triangles import dot

Pairs = NDArray[np.intp]
Mask = NDArray[np.bool_]

MOST_NARROWINGS = 30
"""Ternary search steps, each of which keeps two thirds; the distance of two drones is convex in between."""


@dataclass(frozen=True, slots=True)
class ClosestPair:
    """The nearest pair of drones, metres of horizontal distance as in ``geom.separation``.

    first, second : their rows
    time : seconds
    below : number of pairs that came nearer than the limit
    """

    distance: float
    first: int
    second: int
    time: float
    below: int


class _BothFleets(NamedTuple):
    """Scaled positions (n, 3) and (m, 3) of two fleets at a time, seconds."""

    time: float
    one: Array
    other: Array


class Across:
    """The nearest pair of drones from different fleets, whose positions (n, 3) and (m, 3) are added over
    time.

    limit : horizontal distance for ``ClosestPair.below``, metres
    """

    def __init__(self, apart: Distances, limit: float) -> None:
        self._height = np.array([1.0, 1.0, stretch(apart)])
        self._upright = apart.shape == "cylinder"
        self._limit = limit
        self._best = ClosestPair(np.inf, 0, 0, 0.0, 0)
        self._low: set[tuple[int, int]] = set()
        self._last: _BothFleets | None = None

    def add(self, time: float, one: Array, other: Array) -> None:
        """Add the positions (n, 3) and (m, 3) of both fleets at a later time."""
        now = _BothFleets(time, one * self._height, other * self._height)
        if self._last is not None:
            self._between(self._last, now)
        self._last = now

    def nearest(self) -> ClosestPair:
        """Return the nearest pair so far; ``first`` is a row of the one fleet, ``second`` of the other."""
        return replace(self._best, below=len(self._low))

    def _between(self, start: _BothFleets, end: _BothFleets) -> None:
        (before, one, other), (after, one_end, other_end) = start, end
        trees = cKDTree(0.5 * (one + one_end)), cKDTree(0.5 * (other + other_end))
        moves = (one_end - one, other_end - other)
        moved = sum(float(np.linalg.norm(move, axis=1).max()) for move in moves)
        now = float(trees[1].query(trees[0].data)[0].min())
        # The Euclidean distance is between the cylinder's measure and sqrt(2) times it.
        wide = np.sqrt(2.0) if self._upright else 1.0
        far = wide * max(self._limit, min(self._best.distance, now)) + moved
        if now > far:
            return
        near_pairs = trees[0].sparse_distance_matrix(trees[1], far * (1.0 + 1e-9), output_type="ndarray")
        i, j = near_pairs["i"], near_pairs["j"]
        least, share = _least(one[i] - other[j], one_end[i] - other_end[j], self._upright)
        self._low.update(zip(i[least < self._limit].tolist(), j[least < self._limit].tolist(), strict=True))
        m = int(np.argmin(least))
        if least[m] < self._best.distance:
            when = float(before + share[m] * (after - before))
            self._best = ClosestPair(float(least[m]), int(i[m]), int(j[m]), when, 0)


class NearestSearch:
    """The nearest of all pairs of drones, whose positions (n, 3) are added over time.

    limit : horizontal distance for ``ClosestPair.below``, metres
    """

    def __init__(self, apart: Distances, limit: float) -> None:
        self._height = np.array([1.0, 1.0, stretch(apart)])
        self._upright = apart.shape == "cylinder"
        self._limit = limit
        self._best = ClosestPair(np.inf, 0, 0, 0.0, 0)
        self._low: set[tuple[int, int]] = set()
        self._last: tuple[float, Array] | None = None

    def add(self, time: float, places: Array, counted: Mask | None = None) -> None:
        """Add the positions of all drones at a later time.

        counted : which drones count since the time before, shape (n,); None for all
        """
        seen = places * self._height
        seen = seen - seen.mean(axis=0)
        rows = np.arange(len(seen)) if counted is None else np.flatnonzero(counted)
        if self._last is not None and len(rows) > 1:
            self._between(*self._last, (time, seen), rows)
        self._last = (time, seen)

    def nearest(self) -> ClosestPair:
        """Return the nearest pair so far."""
        return replace(self._best, below=len(self._low))

    def _between(self, before: float, start: Array, then: tuple[float, Array], rows: Pairs) -> None:
        (after, end), start = then, start[rows]
        end = end[rows]
        pairs = _candidates(start, end, max(self._limit, self._best.distance), self._upright)
        if not len(pairs):
            return
        one, other = pairs.T
        least, share = _least(start[one] - start[other], end[one] - end[other], self._upright)
        self._low.update((int(i), int(j)) for i, j in rows[pairs[least < self._limit]])
        m = int(np.argmin(least))
        if least[m] < self._best.distance:
            when = float(before + share[m] * (after - before))
            self._best = ClosestPair(float(least[m]), int(rows[one[m]]), int(rows[other[m]]), when, 0)


def _candidates(start: Array, end: Array, reach: float, upright: bool) -> Pairs:
    """Return the pairs of rows that may come within reach of each other, shape (K, 2)."""
    middle = 0.5 * (start + end)
    tree = cKDTree(middle)
    if not np.isfinite(reach):
        reach = float(tree.query(middle, k=2)[0][:, 1].min())
    moved = float(np.linalg.norm(end - start, axis=1).max())
    # The Euclidean distance is at most sqrt(2) times the cylinder's measure.
    far = reach * (np.sqrt(2.0) if upright else 1.0) + moved
    return np.asarray(tree.query_pairs(far * (1.0 + 1e-9), output_type="ndarray"))


def _least(one: Array, other: Array, upright: bool) -> tuple[Array, Array]:
    """Return the least distance between straight motions, and the share of the motion there,
    shape (K,) each.
    """
    if upright:
        share = _least_upright(one, other)
    else:
        displacement = other - one
        length = np.maximum(dot(displacement, displacement), np.finfo(float).tiny)
        share = np.clip(-dot(one, displacement) / length, 0.0, 1.0)
    return _size(one, other, share, upright), share


def _least_upright(one: Array, other: Array) -> Array:
    """Return the share of the motion at which the larger of the two distances is least, shape (K,)."""
    low, high = np.zeros(len(one)), np.ones(len(one))
    for _ in range(MOST_NARROWINGS):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        nearer = _size(one, other, left, upright=True) < _size(one, other, right, upright=True)
        low, high = np.where(nearer, low, left), np.where(nearer, right, high)
    return np.asarray(0.5 * (low + high))


def _size(one: Array, other: Array, share: Array, upright: bool) -> Array:
    offset = one + share[:, None] * (other - one)
    if upright:
        return np.asarray(np.maximum(np.linalg.norm(offset[:, :2], axis=1), np.abs(offset[:, 2])))
    return np.asarray(np.linalg.norm(offset, axis=1))
