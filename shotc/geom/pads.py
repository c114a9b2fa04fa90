"""The search for pads that are too near to each other, in one fleet or in two. Plain Python."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from itertools import product
from math import dist, floor, hypot
from typing import NamedTuple

from shotc.geom.apart import Distances
from shotc.geom.vec import Vec3

ROUNDING_TOLERANCE = 1e-6  # metres, or shares of the separation
_AROUND = tuple(product((-1, 0, 1), repeat=3))
Cell = tuple[int, int, int]


class Pair(NamedTuple):
    """Two pads by index; share : their distance over the separation, 1 if it is just kept."""

    one: int
    other: int
    share: float


def nearest_pair(pads: Sequence[Vec3], apart: Distances) -> Pair | None:
    """Return the two pads nearest to each other in the fleet's metric; None if all keep the separation.

    Points are inserted one by one into cells as wide as the least distance so far. The cells are rebuilt if a
    nearer pair is found, which is rare (Golin et al., randomized data structures for closest pairs).
    """
    points = [(x / apart.across, y / apart.across, z / apart.upright) for x, y, z in pads]
    measure = _measure(apart)
    best = Pair(0, 0, 1.0 - ROUNDING_TOLERANCE)
    cells: dict[Cell, list[int]] = defaultdict(list)
    order = sorted(range(len(points)), key=lambda i: i * 2654435761 % 2**32)  # a shuffled order
    for index, i in enumerate(order):
        near = [(measure(points[i], points[j]), j) for j in _around(cells, points[i], best.share)]
        share, j = min(near, default=(1.0, 0))
        if share < best.share:
            best = Pair(min(i, j), max(i, j), share)
            if share <= ROUNDING_TOLERANCE:
                return best
            cells = defaultdict(list)
            for k in order[: index + 1]:
                cells[_cell(points[k], share)].append(k)
        else:
            cells[_cell(points[i], best.share)].append(i)
    return best if best.one != best.other else None


def first_nearer(one: Sequence[Vec3], other: Sequence[Vec3], reach: float) -> Pair | None:
    """Return the first pad of the second fleet that is nearer than a distance to one of the first fleet.

    reach : that distance, metres; ``share`` of the result refers to it
    """
    cells: dict[Cell, list[int]] = defaultdict(list)
    for i, pad in enumerate(one):
        cells[_cell(pad, reach)].append(i)
    for j, pad in enumerate(other):
        distance, i = min(((dist(one[i], pad), i) for i in _around(cells, pad, reach)), default=(reach, 0))
        if distance < reach - ROUNDING_TOLERANCE:
            return Pair(i, j, distance / reach)
    return None


def _measure(apart: Distances) -> Callable[[Vec3, Vec3], float]:
    """Return the metric in shares of the separation, for points in units of it."""
    if apart.shape == "ellipsoid":
        return dist
    return lambda p, q: max(hypot(p[0] - q[0], p[1] - q[1]), abs(p[2] - q[2]))


def _cell(p: Vec3, width: float) -> Cell:
    return (floor(p[0] / width), floor(p[1] / width), floor(p[2] / width))


def _around(cells: dict[Cell, list[int]], p: Vec3, width: float) -> Iterator[int]:
    """Yield the points in the cell of ``p`` and in its neighbours."""
    a, b, c = _cell(p, width)
    for i, j, k in _AROUND:
        yield from cells.get((a + i, b + j, c + k), ())
