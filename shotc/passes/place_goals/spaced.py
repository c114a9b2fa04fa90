"""Goals of one frame: centroids, adjusted for the audience, then apart; and how many of them would fit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.centroids import centroids, viewpoint_centroids
from shotc.geom.push_apart import push_apart
from shotc.passes.place_goals.room import Room

NEIGHBOURS = 12
"""Points that tell how a surface lies near a goal."""
LOWEST = 0.02
"""Share of the spacing below which no fit is looked for."""
CLOSE = 1.02
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


def spaced(setting: Setting, goals: Placed, room: Room | None = None) -> Array | None:
    """Return goals as they are shown, moved apart as little as it takes, or None where they do not fit.

    Where room is short the cells of the tessellation are made as flat or tall as the drones need, too.
    room : where goals may be, of the setting's unless given
    """
    scale = np.array([1.0, 1.0, setting.stretch])
    free = setting.room if room is None else room

    def hold(before: Array, after: Array) -> Array:
        return np.asarray(free.hold(before / scale, after / scale) * scale)

    shape = goals.points * scale
    apart = push_apart(goals.shown * scale, shape, setting.least, hold)
    if apart is None and len(goals.shown) > 1:
        apart = push_apart(centroids(shape, len(goals.shown)).goals, shape, setting.least, hold)
    return None if apart is None else apart / scale


def what_fits(setting: Setting, goals: Placed) -> Fit:
    """Return how many drones fit, and at what share of the spacing all of them do, by halving intervals."""
    anywhere = Room((), -np.inf)

    def at_share(share: float) -> bool:
        tighter = Setting(setting.number, setting.least * share, setting.stretch, None, 0.0, anywhere)
        return spaced(tighter, goals) is not None

    share = _halved(at_share, LOWEST, 1.0)

    def at_number(number: int) -> bool:
        fewer = Setting(number, setting.least, setting.stretch, None, 0.0, anywhere)
        return spaced(fewer, placed(fewer, goals.points, None, False)) is not None

    # In a volume the number goes with the third power of the share, along a line with the first.
    low, high = max(1, round(0.7 * setting.number * share**3)), setting.number
    while low > 1 and not at_number(low):
        low //= 2
    while high - low > max(1, low // 50):
        middle = round((low * high) ** 0.5)
        middle = min(max(middle, low + 1), high - 1)
        low, high = (middle, high) if at_number(middle) else (low, middle)
    return Fit(low, share)


def _halved(fits: Callable[[float], bool], low: float, high: float) -> float:
    while high > CLOSE * low:
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
