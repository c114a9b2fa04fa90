"""Goals of a fleet for a shape given by points: k-means in space, then adjusted for a viewpoint.

*display* Section III: the goals are the centroids of a Voronoi tessellation of the points (Eq. 2). With a
viewpoint they move in the plane perpendicular to the line of sight, with a cost on the distance from their
former positions (Eq. 1 and 3).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array

Labels = NDArray[np.intp]

MOST_STEPS = 100
"""Most iterations."""
GAIN_RATIO, LARGEST_GAIN_RATIO, STALLED_ITERATIONS = 3e-6, 3e-3, 3
"""Stopping rule: relative gain of the cost in STALLED_ITERATIONS, for each goal and at most. For many goals,
further gains are below the noise of random points. For few goals each one is visible, and iterations are
cheap.
"""
STEP_RATIO = 1.6
"""Over-relaxation of the tessellation in space. A goal's share of the cost is quadratic about its centroid,
so any factor up to 2 lowers it. This one ends 1 to 2 per cent lower than 1, at the same speed.
"""
MOMENTUM_SHARE = 0.5
"""Share of the last step that is added to the next one. It needs a third of the iterations for the same cost,
and ends about 1 per cent lower. A step that raises the cost is undone.
"""
NEIGHBOUR_COUNT = 12
"""Goals around each one whose motion is bounded individually."""


@dataclass(frozen=True, slots=True, eq=False)
class Clusters:
    """Goals (n, 3), the index of the nearest goal of each point (M,), and the cost before every iteration."""

    goals: Array
    labels: Labels
    costs: tuple[float, ...]


def centroids(points: Array, n: int, start: Array | None = None) -> Clusters:
    """Return n goals that are the centroids of the points nearest to them.

    The result depends only on the arguments. Source: *display* Section III, Eq. 2 and c -> 0 in Eq. 1.

    points : shape (M, D), M >= n, metres
    start : initial goals, shape (n, D), for example those of the frame before; without it the points are
        bisected into n groups of equal size

    Raises ValueError if there are fewer points than goals.
    """
    if n < 1 or n > len(points):
        raise ValueError(f"{len(points)} points cannot have {n} centroids")
    first = halved(points, n) if start is None else start
    return _lloyd(points, first, 0.0, STEP_RATIO)


def viewpoint_centroids(points: Array, goals: Array, viewpoint: Array, weight: float) -> Clusters:
    """Return the goals adjusted for the view from a viewpoint, at unchanged depth.

    ``costs`` is that of Eq. 1 before each iteration and never rises. Source: *display* Eq. 1 to 3.

    points : shape (M, 3), metres
    goals : their centroids, shape (n, 3)
    viewpoint : shape (3,), metres
    weight : the paper's c-bar: 0 covers the view best, infinity leaves the goals unchanged; Eq. 1 is weighted
        by c = c-bar M / n

    Raises ValueError if the viewpoint is in the middle of the points.
    """
    centre = points.mean(axis=0)
    across, normal = view_plane(centre, viewpoint)
    if isinf(weight):
        return Clusters(goals, np.asarray(cKDTree(goals).query(points)[1]), ())
    flat, start = (points - centre) @ across.T, (goals - centre) @ across.T
    clusters = _lloyd(flat, start, weight * len(points) / len(goals), 1.0)
    depth = (goals - centre) @ normal
    back = centre + clusters.goals @ across + depth[:, None] * normal
    return Clusters(back, clusters.labels, clusters.costs)


def view_plane(centre: Array, viewpoint: Array) -> tuple[Array, Array]:
    """Return two unit vectors (2, 3) perpendicular to the line of sight, and its own direction (3,).

    The first points to the viewer's right, the second up. Raises ValueError if the viewpoint is the centre.
    """
    sight = centre - viewpoint
    length = float(np.linalg.norm(sight))
    if length < 1e-9:
        raise ValueError("the viewpoint is in the middle of what is to be seen")
    normal = sight / length
    level = np.array([normal[1], -normal[0], 0.0])
    size = float(np.linalg.norm(level))
    right = level / size if size > 1e-9 else np.array([1.0, 0.0, 0.0])
    return np.array([right, np.cross(right, normal)]), normal


def halved(points: Array, n: int) -> Array:
    """Return the means (n, D) of n groups of points, bisected repeatedly across their longest side."""
    means = np.empty((n, points.shape[1]))
    groups = [(points, 0, n)]
    while groups:
        group, low, high = groups.pop()
        if high - low == 1:
            means[low] = group.mean(axis=0)
            continue
        middle = (low + high) // 2
        cut = len(group) * (middle - low) // (high - low)
        first = _lowest(group[:, int(np.argmax(np.ptp(group, axis=0)))], cut)
        groups += [(group[first], low, middle), (group[~first], middle, high)]
    return means


def _lowest(values: Array, count: int) -> NDArray[np.bool_]:
    """Return which values are the lowest ``count``, shape (M,); of equal ones the first.

    The order in which a partition leaves values, and which of equal ones it takes, depends on the processor.
    The value at its cut does not.
    """
    at_cut = np.partition(values, count)[count]
    lowest = np.asarray(values < at_cut)
    equal = np.flatnonzero(values == at_cut)
    lowest[equal[: count - np.count_nonzero(lowest)]] = True
    return lowest


def _lloyd(points: Array, start: Array, anchor: float, boldness: float) -> Clusters:
    """Lower Eq. 1 iteratively: assign the points, and move every goal to or past the minimum of Eq. 3."""
    goals, momentum = start, np.zeros_like(start)
    near = _Nearest(points, goals)
    costs: list[float] = []
    enough = min(LARGEST_GAIN_RATIO, GAIN_RATIO * len(goals))
    for _ in range(MOST_STEPS):
        # BLAS threads would cost more than such a short sum.
        cost = float(np.einsum("m,m->", near.own, near.own) + anchor * np.sum((goals - start) ** 2))
        if costs and cost > costs[-1]:
            goals, momentum = near.follow(goals, -momentum), np.zeros_like(momentum)
        else:
            costs.append(cost)
        if (
            len(costs) > STALLED_ITERATIONS
            and costs[-1 - STALLED_ITERATIONS] - costs[-1] <= enough * costs[-1]
        ):
            break
        moved = _step(near.points, near.labels, goals, (start, anchor))
        momentum = boldness * moved + MOMENTUM_SHARE * momentum
        goals = near.follow(goals, momentum)
    return Clusters(goals, near.in_order(), tuple(costs))


def _step(points: Array, labels: Labels, goals: Array, anchored: tuple[Array, float]) -> Array:
    # The step from every goal to its minimum by Eq. 3; a goal without points and anchor does not move.
    start, anchor = anchored
    n = len(goals)
    sums = np.column_stack([np.bincount(labels, column, n) for column in points.T])
    weight = np.bincount(labels, minlength=n)[:, None] + anchor
    best = (sums + anchor * start) / np.where(weight > 0, weight, 1.0)
    return np.where(weight > 0, best - goals, 0.0)


class _Nearest:
    """The nearest goal of each point, updated as goals move; only points that may change are searched.

    After Hamerly: ``own`` is the exact distance to the goal, ``_other`` a lower bound of that to any other.
    Other goals approach by at most the motion of the goal's neighbours, or from far away.
    """

    def __init__(self, points: Array, goals: Array) -> None:
        self._look(goals)
        distances, nearest = self._tree.query(points, k=2)
        # Points are sorted by goal, because searching a tree for neighbouring points is twice as fast.
        self._order: Labels = np.argsort(nearest[:, 0], kind="stable")
        self.points = points[self._order]
        self.labels: Labels = nearest[self._order, 0]
        self.own, self._other = np.ascontiguousarray(distances[self._order].T)

    def in_order(self) -> Labels:
        """Return the goals' indices in the original order of the points."""
        labels = np.empty_like(self.labels)
        labels[self._order] = self.labels
        return labels

    def follow(self, goals: Array, step: Array) -> Array:
        """Return the goals moved by steps of shape (n, D), and update the assignment."""
        moves = np.append(np.sqrt(np.einsum("nd,nd->n", step, step)), 0.0)  # the last: missing neighbours
        near = moves[self._who].max(axis=1)[self.labels]
        far = np.maximum(self._other, self._far[self.labels] - self.own) - moves.max()
        bound = np.minimum(self._other - near, far)
        goals = goals + step
        self._look(goals)
        offset = self.points - goals[self.labels]
        self.own = np.sqrt(np.einsum("md,md->m", offset, offset))
        self._other = np.maximum(bound, self._gap[self.labels] - self.own)
        which = np.flatnonzero(self.own > self._other)
        distances, nearest = self._tree.query(self.points[which], k=2)
        self.own[which], self._other[which] = distances.T
        self.labels[which] = nearest[:, 0]
        return goals

    def _look(self, goals: Array) -> None:
        """Find each goal's neighbours, itself included, and the distances of the first and the next one."""
        self._tree = cKDTree(goals)
        distances, who = self._tree.query(goals, k=NEIGHBOUR_COUNT + 2)
        self._gap, self._far, self._who = distances[:, 1], distances[:, -1], who[:, :-1]
