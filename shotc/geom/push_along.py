"""Goals that stay on thin strokes: pushed apart along them, and those for which no room is left taken out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.push_apart import BEYOND, PATIENCE, ROUNDS, Hold, grain, leashed, pushes

FELL = 0.5
"""Goals that go at a time, for each least distance that all pairs lack together; the rest may part then."""
ASUNDER = 4.0
"""How far apart those are, in least distances: what they leave is shared by all around."""

Numbers = NDArray[np.intp]


def push_along(goals: Array, shape: Array, least: float, slack: float, hold: Hold) -> Array | None:
    """Return goals on a shape, none nearer than ``least`` to another, or None where they find no room.

    goals : shape (n, D); shape : points (M, D) that are to be shown, in the metric of the fleet, both
    slack : metres that a goal may be off the shape, to which the gaps between its points are added. Goals
    are drawn that near first, wherever they come from: a centroid of two strokes lies between them.
    """
    tree = cKDTree(shape)
    leash = slack + grain(tree)
    goals = _settled(_drawn(goals, tree, leash), tree, least, leash, hold)
    return None if len(_in_the_way(goals, least)) else goals


def thinned(goals: Array, shape: Array, least: float, slack: float, hold: Hold) -> Array:
    """Return as many of the goals as find room, (m, D), pushed as by ``push_along``, the worst taken out."""
    tree = cKDTree(shape)
    leash = slack + grain(tree)
    goals = _drawn(goals, tree, leash)
    while True:
        goals = _settled(goals, tree, least, leash, hold)
        felled = _in_the_way(goals, least)
        if not len(felled):
            return goals
        goals = np.delete(goals, felled, axis=0)


def _drawn(goals: Array, tree: cKDTree, leash: float) -> Array:
    return leashed(goals, tree, np.full(len(goals), leash))


def _settled(goals: Array, tree: cKDTree, least: float, leash: float, hold: Hold) -> Array:
    """Push goals apart until they are, or until that leads no further."""
    missing = float("inf")
    for done in range(ROUNDS):
        push, lacking = pushes(goals, least, BEYOND * (1.0 + done / 20))
        if not lacking:
            break
        if done % PATIENCE == 0:
            if lacking > 0.95 * missing:
                break
            missing = lacking
        moving = np.flatnonzero(np.any(push != 0.0, axis=1))
        wanted = _drawn(goals[moving] + push[moving], tree, leash)
        goals = goals.copy()
        goals[moving] = hold(goals[moving], wanted)
    return goals


def _in_the_way(goals: Array, least: float) -> Numbers:
    """Return a few goals that are too near to others, far from each other, the worst first."""
    pairs = cKDTree(goals).query_pairs(least * (1.0 - 1e-12), output_type="ndarray")
    lack = least - np.linalg.norm(goals[pairs[:, 0]] - goals[pairs[:, 1]], axis=1)
    lacks = np.bincount(pairs.T.ravel(), np.tile(lack, 2), len(goals))
    most = int(np.ceil(FELL * float(lack.sum()) / least))
    found: list[int] = []
    for k in np.argsort(-lacks, kind="stable")[: int((lacks > 0).sum())]:
        if len(found) == most:
            break
        if (np.linalg.norm(goals[found] - goals[k], axis=1) >= ASUNDER * least).all():
            found.append(int(k))
    return np.array(found, dtype=np.intp)
