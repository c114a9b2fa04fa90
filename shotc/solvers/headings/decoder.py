"""The best integer points of a convex quadratic, exactly: a list sphere decoder.

Depth first over the coordinates, last one first, each in Schnorr and Euchner's zig-zag from its centre
(Closest point search in lattices, Agrell et al. 2002), within the radius of the worst of the best points
so far. Every point left out is at least as far as every point returned, unless the cap on nodes was hit.
"""

from __future__ import annotations

from bisect import insort
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array

MOST_NODES = 50_000
SLACK = 1e-12  # of the radius, so that rounding loses no point


@dataclass(frozen=True, slots=True)
class Decoded:
    """The points found, nearest first.

    points : (squared distance, coordinates); nodes : visited; capped : whether the search was cut short
    """

    points: tuple[tuple[float, tuple[int, ...]], ...]
    nodes: int
    capped: bool


def decode(gram: Array, centre: Array, count: int, most_nodes: int = MOST_NODES) -> Decoded:
    """Return the ``count`` integer points m of least (m - centre)' gram (m - centre).

    gram : shape (n, n), positive definite (LinAlgError otherwise); centre : shape (n,), n >= 1
    """
    search = _Search(np.asarray(np.linalg.cholesky(gram), dtype=np.float64).T, centre, count, most_nodes)
    search.descend(len(centre) - 1, 0.0, [0] * len(centre))
    return Decoded(tuple(search.best), search.nodes, search.nodes >= most_nodes)


class _Search:
    def __init__(self, root: Array, centre: Array, count: int, most_nodes: int) -> None:
        # Plain lists: the vectors are too short for numpy to pay.
        self.rows: list[list[float]] = root.tolist()
        self.centre: list[float] = centre.tolist()
        self.count = count
        self.most_nodes = most_nodes
        self.best: list[tuple[float, tuple[int, ...]]] = []
        self.nodes = 0

    def descend(self, level: int, spent: float, point: list[int]) -> None:
        row, size = self.rows[level], len(self.centre)
        pull = sum(row[j] * (point[j] - self.centre[j]) for j in range(level + 1, size))
        middle = self.centre[level] - pull / row[level]
        value, step = round(middle), 1 if middle >= round(middle) else -1
        while self.nodes < self.most_nodes:
            self.nodes += 1
            total = spent + (row[level] * (value - middle)) ** 2
            if len(self.best) == self.count and total > self.best[-1][0] * (1 + SLACK):
                return
            point[level] = value
            if level:
                self.descend(level - 1, total, point)
            else:
                insort(self.best, (total, tuple(point)))
                del self.best[self.count :]
            value += step
            step = -step - (1 if step > 0 else -1)
