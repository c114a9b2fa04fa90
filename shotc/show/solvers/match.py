"""Assigns drones to goals: with least squared distance, or at least with no pair that gains by a swap.

Two drones with straight moves from x_i, x_j to g_i, g_j never come nearer than sqrt(1/2) of the lesser of
their first and last distances if (x_i - x_j).(g_i - g_j) >= 0 (``geom.apart``). The least sum of squares
satisfies this for all pairs, because a pair with a negative product would gain by a swap. So does any
matching in which no pair gains by a swap.

Up to ``EXACT_DRONES`` the sum is the least (``scipy.optimize.linear_sum_assignment``). Larger fleets are
halved repeatedly, drones and goals alike, matched exactly within the parts, and then improved by swaps until
no pair gains. Drones wait in a queue to be compared with all others. A drone that gains by a swap swaps at
once, and both wait again. In each pair, the drone that was compared last has seen the other's present goal.
So an empty queue proves that no pair gains.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from shotc.geom.bernstein import Array

Index = NDArray[np.intp]

EXACT_DRONES = 300
"""Up to this number of drones the sum of squares is the least. For a ball that becomes a text, the result is
0.2 per cent above it, in 0.02 s for 1000 drones (0.6 s for the least) and 0.3 s for 5000 (98 s).
"""

PART_DRONES = 100
"""Most drones in a part of a larger fleet."""

BLOCK_DRONES = 256
"""Drones whose pairs with all others are evaluated together."""

TOLERANCE_SHARE = 1e-9
"""Products above minus this share of the fleet's squared size count as rounding."""


def matched(starts: Array, goals: Array) -> Index:
    """Return the goal of each drone.

    starts, goals : shape (n, 3), m, in the metric of the fleet (``geom.apart.stretch``)
    result : shape (n,), a permutation: drone i goes to goals[result[i]]
    """
    near = np.asarray(cKDTree(goals).query(starts)[1])
    if len(np.unique(near)) == len(near):
        return near  # each has its nearest goal, so the sum is the least
    if len(starts) <= EXACT_DRONES:
        return _least(starts, goals)
    order = np.empty(len(starts), dtype=np.intp)
    everything = np.arange(len(starts))
    for drones, places in _parts(starts, goals, everything, everything):
        order[drones] = places[_least(starts[drones], goals[places])]
    return _untangled(starts, goals, order)


class Crossing(NamedTuple):
    """The least product of two drones' displacements, m^2, and these two drones."""

    product: float
    first: int
    second: int


def crossing(starts: Array, goals: Array) -> Crossing:
    """Return the least (x_i - x_j).(g_i - g_j) of all pairs, m^2, and the pair; infinite for a single drone.

    starts, goals : shape (n, 3), in the order of the drones
    """
    rows = np.arange(len(starts))
    least, other = _least_products(starts, goals, rows)
    i = int(np.argmin(least))
    return Crossing(float(least[i]), i, int(other[i]))


def _least(starts: Array, goals: Array) -> Index:
    return np.asarray(linear_sum_assignment(cdist(starts, goals, "sqeuclidean"))[1])


def _parts(starts: Array, goals: Array, drones: Index, places: Index) -> list[tuple[Index, Index]]:
    """Halve drones and goals alike along their common principal axis, into parts that are matched."""
    if len(drones) <= PART_DRONES:
        return [(drones, places)]
    x, g = starts[drones] - starts[drones].mean(axis=0), goals[places] - goals[places].mean(axis=0)
    widest = np.linalg.eigh(x.T @ x + g.T @ g)[1][:, -1]
    half = len(drones) // 2
    drones = drones[np.argsort(x @ widest, kind="stable")]
    places = places[np.argsort(g @ widest, kind="stable")]
    return [
        *_parts(starts, goals, drones[:half], places[:half]),
        *_parts(starts, goals, drones[half:], places[half:]),
    ]


def _untangled(starts: Array, goals: Array, order: Index) -> Index:
    """Swap the goals of pairs that gain by it, until there is none.

    Each swap reduces the sum of squares, so the loop ends.
    """
    order = order.copy()
    scale = TOLERANCE_SHARE * float(np.ptp(starts, axis=0).max() * np.ptp(goals, axis=0).max() + 1e-9)
    own = np.einsum("nd,nd->n", starts, goals[order])
    both = np.concatenate([starts.T, goals[order].T])  # one product per row
    waiting, queued = deque(range(len(starts))), np.ones(len(starts), dtype=bool)
    while waiting:
        i = waiting.popleft()
        queued[i] = False
        row = own - np.concatenate([both[3:, i], both[:3, i]]) @ both
        row[i] = np.inf
        j = int(row.argmin())
        if row[j] + own[i] >= -scale:
            continue
        order[[i, j]] = order[[j, i]]
        both[3:, [i, j]] = both[3:, [j, i]]
        for k in (i, j):
            own[k] = both[:3, k] @ both[3:, k]
            if not queued[k]:
                queued[k] = True
                waiting.append(k)
    return order


def _least_products(starts: Array, goals: Array, rows: Index) -> tuple[Array, Index]:
    """Return for some drones the least product with any other drone, and that drone."""
    own = np.einsum("nd,nd->n", starts, goals)
    least, other = np.empty(len(rows)), np.empty(len(rows), dtype=np.intp)
    for at in range(0, len(rows), BLOCK_DRONES):
        some = rows[at : at + BLOCK_DRONES]
        products = own[some, None] + own - starts[some] @ goals.T - goals[some] @ starts.T
        products[np.arange(len(some)), some] = np.inf
        other[at : at + BLOCK_DRONES] = products.argmin(axis=1)
        least[at : at + BLOCK_DRONES] = products.min(axis=1)
    return least, other
