"""The best integer points of a convex quadratic function, exactly: a list sphere decoder.

The search is depth first over the coordinates from the last, each in Schnorr and Euchner's zig-zag from its
centre (Closest point search in lattices, Agrell et al. 2002). Its radius is that of the worst of the best
points so far. Every omitted point is at least as far as every returned one, unless the search reached its cap
on nodes.
"""

from __future__ import annotations

from bisect import insort
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array

MOST_NODES = 50_000
RADIUS_SLACK_SHARE = 1e-12  # relative tolerance of the radius, for rounding


@dataclass(frozen=True, slots=True)
class Decoded:
    """The best points, nearest first.

    points : (squared distance, coordinates); nodes : visited; capped : whether the search reached its cap
    """

    points: tuple[tuple[float, tuple[int, ...]], ...]
    nodes: int
    capped: bool


def decode(gram: Array, centre: Array, count: int, most_nodes: int = MOST_NODES) -> Decoded:
    """Return the ``count`` integer points m of least (m - centre)' gram (m - centre).

    gram : shape (n, n), positive definite, else raise LinAlgError; centre : shape (n,), n >= 1
    """
    # Lists of floats, because the vectors are too short for numpy.
    rows: list[list[float]] = np.linalg.cholesky(gram).T.tolist()
    middle: list[float] = centre.tolist()
    size, nodes, level = len(middle), 0, len(middle) - 1
    best: list[tuple[float, tuple[int, ...]]] = []
    spent, point = [0.0] * (size + 1), [0] * size
    zigzag = [_ZigZag(middle[level])] * size
    while level < size and nodes < most_nodes:
        nodes += 1
        point[level] = zigzag[level].value
        total = spent[level + 1] + (rows[level][level] * (point[level] - zigzag[level].centre)) ** 2
        if len(best) == count and total > best[-1][0] * (1 + RADIUS_SLACK_SHARE):
            level += 1
            if level < size:
                zigzag[level].step()
        elif level == 0:
            insort(best, (total, tuple(point)))
            del best[count:]
            zigzag[0].step()
        else:
            spent[level] = total
            level -= 1
            pull = sum(rows[level][j] * (point[j] - middle[j]) for j in range(level + 1, size))
            zigzag[level] = _ZigZag(middle[level] - pull / rows[level][level])
    return Decoded(tuple(best), nodes, level < size)


class _ZigZag:
    """The integers in the order of their distance from a centre."""

    def __init__(self, centre: float) -> None:
        self.centre = centre
        self.value = round(centre)
        self._next = 1 if centre >= self.value else -1

    def step(self) -> None:
        self.value += self._next
        self._next = -self._next - (1 if self._next > 0 else -1)
