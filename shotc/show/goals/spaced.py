"""Goals of one frame: centroids, adjusted for the audience, then apart; and how many of them would fit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.centroids import centroids, viewpoint_centroids
from shotc.show.geom.push_apart import push_apart
from shotc.show.goals.room import Room

NEIGHBOURS = 12
"""Points that tell how a surface lies near a goal."""
LOWEST_SHARE = 0.02
"""Share of the spacing below which no fit is looked for."""
ENOUGH = 12
"""Points a goal with which the searches do."""
CLOSE_RATIO = 1.04
"""Factor between what fits and what does not at which the searches end."""


@dataclass(frozen=True, slots=True, eq=False)
class Setting:
    """What the frames of one display have in common.

    number : of drones; least : stretched distance of two goals, metres; stretch : factor for heights
    viewpoint : (3,) or None; weight : the paper's c-bar; room : where goals may be
    """

    number: int
    least: float
    stretch: float
    viewpoint: Array | None
    weight: float
    room: Room


class Placed(NamedTuple):
    """Goals of a frame.

    centroids : (n, 3), in space; shown : (n, 3), adjusted for the viewpoint
    points : (M, 3), what they are to show
    """

    centroids: Array
    shown: Array
    points: Array


class Fit(NamedTuple):
    """What would fit: the number of drones, and the share of the spacing at which all of them do."""

    number: int
    share: float


def placed(setting: Setting, points: Array, before: Placed | None, on_surface: bool) -> Placed:
    """Return the goals that show points (M, 3) best, spaced or not.

    before : the frame before, whose goals these follow; on_surface : that they stay in the points' surface
    """
    start = None
    if before is not None:
        start = before.centroids + points.mean(axis=0) - before.points.mean(axis=0)
    goals = centroids(points, setting.number, start).goals
    shown = goals
    if setting.viewpoint is not None:
        shown = viewpoint_centroids(points, goals, setting.viewpoint, setting.weight).goals
    return Placed(goals, _onto(points, shown) if on_surface else shown, points)


def spaced(setting: Setting, goals: Placed) -> Array | None:
    """Return goals as they are shown, moved apart as little as it takes, or None where they do not fit.

    Where room is short the cells of the tessellation are made as flat or tall as the drones need, too.
    """
    scale = np.array([1.0, 1.0, setting.stretch])
    shape = goals.points * scale

    def hold(before: Array, after: Array) -> Array:
        return np.asarray(setting.room.hold(before / scale, after / scale) * scale)

    start = goals.shown * scale
    apart = push_apart(start, shape, setting.least, hold)
    if apart is start:
        return goals.shown
    if apart is None:
        apart = push_apart(centroids(shape, len(start), start).goals, shape, setting.least, hold)
    return None if apart is None else apart / scale


def what_fits(setting: Setting, goals: Placed) -> Fit:
    """Return how many drones fit, and at what share of the spacing all of them do, found by trying."""
    shape = goals.points * np.array([1.0, 1.0, setting.stretch])
    full = setting.number
    even = centroids(shape, full).goals

    def fits(number: int, share: float) -> bool:
        few = shape[:: max(1, len(shape) // (ENOUGH * number))]
        start = even if number == full else centroids(few, number).goals
        return push_apart(start, shape, setting.least * share, _anywhere) is not None

    share = _most(lambda s: fits(full, s), LOWEST_SHARE, 1.0)
    # In a volume the number goes with the third power of the share, along a line with the first.
    low = max(1.0, 0.7 * full * share**3)
    while low > 1.0 and not fits(round(low), 1.0):
        low /= 2.0
    return Fit(round(_most(lambda n: fits(round(n), 1.0), low, float(full))), share)


def _anywhere(_: Array, after: Array) -> Array:
    return after


def _most(fits: Callable[[float], bool], low: float, high: float) -> float:
    """Return about the most that fits, between ``low``, which does, and ``high``, which does not."""
    while high > CLOSE_RATIO * low:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _onto(points: Array, goals: Array) -> Array:
    """Draw goals along its normal into the surface of which points (M, 3) are given."""
    if len(points) < NEIGHBOURS:
        return goals
    near = points[cKDTree(points).query(goals, k=NEIGHBOURS)[1]]
    middle = near.mean(axis=1)
    away = near - middle[:, None]
    normal = np.linalg.eigh(np.einsum("nki,nkj->nij", away, away))[1][:, :, 0]
    off = np.einsum("ni,ni->n", goals - middle, normal)
    return np.asarray(goals - off[:, None] * normal)
