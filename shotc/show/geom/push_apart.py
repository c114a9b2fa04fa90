"""Pushes goals apart to a least distance, with small moves and near the shape that they show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array

MOST_ROUNDS = 400
"""Most iterations; goals that fit are apart after 5 to 100."""
BEYOND_SHARE = 1e-3
"""Share of the distance by which a push exceeds it, so that the last pairs are apart after finitely many
steps.
"""
SLACK_SHARE = 0.25
"""Distance of a goal from the shape over the least distance; it is not visible between two lights."""
LOOSER_SHARE = 0.2
"""Growth of that distance up to the last iteration, so that one pair cannot block a thousand drones."""
STALLED_ROUNDS = 25
"""Iterations in which the total lack has to fall by a twentieth, or else the goals do not fit."""

Numbers = NDArray[np.intp]
Hold = Callable[[Array, Array], Array]
"""From goals (n, 3) and their pushed positions to the allowed positions."""


def push_apart(
    goals: Array, shape: Array, least: float, hold: Hold, *, upright: bool = False
) -> Array | None:
    """Return goals of which no two are nearer than ``least``, shape (n, D), or None if they do not fit.

    Every pair that is too near is pushed apart along its own line, all pairs at once, each goal by half of
    the lack. No goal goes farther than ``SLACK_SHARE`` from the shape, or where ``hold`` does not allow it.

    goals : shape (n, D)
    shape : points (M, D) to be shown, as dense as for k-means; both in the metric of the fleet
    upright : whether distances are those of ``Close``
    """
    tree = cKDTree(shape)
    # A centroid that is off its shape at first, as inside a curved surface, may stay at that distance.
    leash = np.maximum(SLACK_SHARE * least + grain(tree), tree.query(goals)[0])
    goals, apart = settled(goals, Leash(tree, leash, LOOSER_SHARE), least, hold, upright=upright)
    return goals if apart else None


@dataclass(frozen=True, slots=True, eq=False)
class Leash:
    """The allowed distance of goals from a shape.

    shape : its points
    lengths : of every goal, shape (n,), metres
    looser : relative growth up to the last iteration
    """

    shape: cKDTree
    lengths: Array
    looser: float = 0.0

    def drawn(self, goals: Array, which: Numbers, iterations: int) -> Array:
        """Return goals (m, D), numbers ``which``, with those that are too far drawn back, after some
        iterations.
        """
        return leashed(
            goals, self.shape, self.lengths[which] * (1.0 + self.looser * iterations / MOST_ROUNDS)
        )


def settled(
    goals: Array, leash: Leash, least: float, hold: Hold, *, upright: bool = False
) -> tuple[Array, bool]:
    """Return goals (n, D) pushed apart until they are or no progress is made, and whether they are apart."""
    missing = float("inf")
    for iteration in range(MOST_ROUNDS):
        push, lacking = _pushes(goals, least, BEYOND_SHARE * (1.0 + iteration / 20), upright)
        if not lacking:
            return goals, True
        if iteration % STALLED_ROUNDS == 0:
            if lacking > 0.95 * missing:
                return goals, False
            missing = lacking
        moving = np.flatnonzero(np.any(push != 0.0, axis=1))
        pushed = leash.drawn(goals[moving] + push[moving], moving, iteration)
        goals = goals.copy()
        goals[moving] = hold(goals[moving], pushed)
    return goals, not _pushes(goals, least, BEYOND_SHARE, upright)[1]


def nearest_pair(goals: Array) -> float:
    """Return the least distance of two goals (n, D); infinite for a single one."""
    if len(goals) < 2:
        return float("inf")
    return float(cKDTree(goals).query(goals, k=2)[0][:, 1].min())


class Close(NamedTuple):
    """Pairs of goals that are too near.

    first, second : their indices, (P,)
    apart : vector from the second to the first, (P, D); for cylinders only its horizontal or vertical part,
        whichever is larger
    distance : length of that vector, (P,)
    """

    first: Numbers
    second: Numbers
    apart: Array
    distance: Array


def close_pairs(goals: Array, least: float, upright: bool) -> Close:
    """Return the pairs of goals (n, D) nearer than a distance.

    upright : whether distances are those of cylinders
    """
    least *= 1.0 - 1e-12
    pairs = cKDTree(goals).query_pairs(least * (np.sqrt(2.0) if upright else 1.0), output_type="ndarray")
    first, second = pairs[np.lexsort(pairs.T[::-1])].T
    apart = goals[first] - goals[second]
    if upright:
        level = np.sqrt(np.einsum("pd,pd->p", apart[:, :-1], apart[:, :-1])) >= np.abs(apart[:, -1])
        apart[level, -1] = 0.0
        apart[~level, :-1] = 0.0
    distance = np.sqrt(np.einsum("pd,pd->p", apart, apart))
    if upright:
        near = distance < least
        return Close(first[near], second[near], apart[near], distance[near])
    return Close(first, second, apart, distance)


def _pushes(goals: Array, least: float, beyond: float, upright: bool) -> tuple[Array, float]:
    """Return the push of each goal, (n, D), and the lack of distance of all pairs together.

    beyond : share of the least distance by which a push exceeds it
    """
    first, second, apart, distance = close_pairs(goals, least, upright)
    if not len(first):
        return np.zeros_like(goals), 0.0
    apart[distance < 1e-9] = np.eye(goals.shape[1])[0]  # coinciding goals: any direction will do
    share = (least * (1.0 + beyond) - distance) / 2.0 / np.maximum(distance, 1e-9)
    share[distance < 1e-9] = least / 2.0
    push = share[:, None] * apart
    both, halves = np.concatenate([first, second]), np.concatenate([push, -push])
    pushes = np.column_stack([np.bincount(both, column, len(goals)) for column in halves.T])
    return np.asarray(pushes, dtype=np.float64), float((least - distance).sum())


def grain(tree: cKDTree) -> float:
    """Return the width of the gaps between drawn points, which belong to the shape as well."""
    if tree.n < 2:
        return 0.0
    sample = np.asarray(tree.data)[:: max(1, tree.n // 5000)]
    return float(np.quantile(tree.query(sample, k=2)[0][:, 1], 0.95))


def leashed(goals: Array, tree: cKDTree, leash: Array) -> Array:
    """Return goals with those beyond their allowed distance from the shape drawn back."""
    off, nearest = tree.query(goals)
    foot = np.asarray(tree.data)[nearest]
    share = np.minimum(1.0, leash / np.maximum(off, 1e-12))
    return np.asarray(foot + share[:, None] * (goals - foot))
