"""Goals on thin strokes: pushed apart along them, with those removed for which there is no room."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.push_apart import Hold, Leash, Numbers, close_pairs, grain, leashed, settled

FALL_SHARE = 0.5
"""Goals removed in one step, over the number of least distances that all pairs lack together."""
ASUNDER_RATIO = 4.0
"""Least distance of goals removed in one step, in least distances; their neighbours share the space."""


def push_along(
    goals: Array, shape: Array, least: float, slack: float, hold: Hold, *, upright: bool = False
) -> Array | None:
    """Return goals on a shape, no two nearer than ``least``, or None if they do not fit.

    Goals are first drawn to the shape, because a centroid of two strokes lies between them.

    goals : shape (n, D), in the metric of the fleet
    shape : points (M, D) to be shown, in the metric of the fleet
    slack : largest distance of a goal from the shape, metres, to which the gaps between its points are added
    upright : whether distances are those of ``push_apart.Close``
    """
    leash = _leash(cKDTree(shape), slack, len(goals))
    goals, apart = settled(leashed(goals, leash.shape, leash.lengths), leash, least, hold, upright=upright)
    return goals if apart else None


def thinned(
    goals: Array, shape: Array, least: float, slack: float, hold: Hold, *, upright: bool = False
) -> Array:
    """Return as many goals as fit, (m, D), pushed as by ``push_along``, with the worst ones removed."""
    leash = _leash(cKDTree(shape), slack, len(goals))
    goals = leashed(goals, leash.shape, leash.lengths)
    while True:
        shorter = replace(leash, lengths=leash.lengths[: len(goals)])
        goals, _ = settled(goals, shorter, least, hold, upright=upright)
        felled = _in_the_way(goals, least, upright)
        if not len(felled):
            return goals
        goals = np.delete(goals, felled, axis=0)


def _leash(tree: cKDTree, slack: float, number: int) -> Leash:
    return Leash(tree, np.full(number, slack + grain(tree)))


def _in_the_way(goals: Array, least: float, upright: bool) -> Numbers:
    """Return a few goals that are too near to others and far from each other, the worst first."""
    close = close_pairs(goals, least, upright)
    lack = least - close.distance
    lacks = np.bincount(np.concatenate([close.first, close.second]), np.tile(lack, 2), len(goals))
    most = int(np.ceil(FALL_SHARE * float(lack.sum()) / least))
    blocking: list[int] = []
    for k in np.argsort(-lacks, kind="stable")[: int((lacks > 0).sum())]:
        if len(blocking) == most:
            break
        if (np.linalg.norm(goals[blocking] - goals[k], axis=1) >= ASUNDER_RATIO * least).all():
            blocking.append(int(k))
    return np.array(blocking, dtype=np.intp)
