"""Goals of one frame: centroids, adjusted for the audience, then apart; where it must be dense, a lattice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.centroids import centroids, viewpoint_centroids
from shotc.show.geom.lattice import Mould, laid, widest
from shotc.show.geom.push_along import thinned
from shotc.show.geom.push_apart import SLACK_SHARE, Hold, grain, push_apart
from shotc.show.goals.room import DisplaySurroundings

NEIGHBOUR_COUNT = 12
"""Points that tell how a surface lies near a goal."""
CROWDED_SHARE = 0.9
"""Mean distance of centroids, in the distance to be kept, below which pushing them apart is not tried."""
TRIED_DRONES = 300
"""Drones up to which it is tried all the same: some fit where the shape is small."""
SPARE_RATIO = 1.15
"""Goals with which thinning begins, for each that a shape should hold."""
FEW_GOALS, FEW_POINTS, POINTS_EACH = 48, 4000, 20
"""Centroids by which it is told how many a shape should hold, points of it for these, and for each it
holds."""

Draw = Callable[[int], Array]
"""From a number to about so many points of a shape, shape (M, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class SpacingTask:
    """What the frames of one display have in common.

    number : of drones; least : stretched distance of two goals, metres; stretch : factor for heights
    upright : whether that is the distance of upright cylinders, the larger of the level and the upright one
    straight : stretched distance at which straight moves need no proof, metres
    viewpoint : (3,) or None; weight : the paper's c-bar; room : where goals may be
    """

    number: int
    least: float
    stretch: float
    upright: bool
    straight: float
    viewpoint: Array | None
    weight: float
    room: DisplaySurroundings

    @property
    def roomy(self) -> SpacingTask:
        """Return the same with goals so far apart that all moves between them are straight."""
        return replace(self, least=self.straight, upright=False)

    @property
    def scale(self) -> Array:
        """Return the factors of the axes in the metric of the fleet, shape (3,)."""
        return np.array([1.0, 1.0, self.stretch])


class PlacedGoals(NamedTuple):
    """Goals of a frame.

    centroids : (n, 3), in space; shown : (n, 3), adjusted for the viewpoint
    points : (M, 3), what they are to show
    """

    centroids: Array
    shown: Array
    points: Array


def placed(setting: SpacingTask, points: Array, before: PlacedGoals | None, on_surface: bool) -> PlacedGoals:
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
    return PlacedGoals(goals, _onto(points, shown) if on_surface else shown, points)


def spaced(setting: SpacingTask, goals: PlacedGoals) -> Array | None:
    """Return goals as they are shown, moved apart as little as it takes, or None where they do not fit.

    Where room is short the cells of the tessellation are made as flat or tall as the drones need, too.
    """
    scale = setting.scale
    shape = goals.points * scale
    start = goals.shown * scale
    if len(start) > TRIED_DRONES and _mean_gap(goals.centroids * scale) < CROWDED_SHARE * setting.least:
        return None
    hold = _held(setting)
    apart = push_apart(start, shape, setting.least, hold, upright=setting.upright)
    if apart is start:
        return goals.shown
    if apart is None:
        even = centroids(shape, len(start), start).goals
        apart = push_apart(even, shape, setting.least, hold, upright=setting.upright)
    return None if apart is None else apart / scale


def in_lattice(setting: SpacingTask, draw: Draw) -> Array:
    """Return goals of the widest lattice that has one a drone in a volume, shape (n, 3).

    Where there is no such lattice, all places of the densest one. draw : gives points of the volume
    """
    mould = _mould(setting, drawn(setting, draw, 3))
    found = widest(mould, setting.number, setting.least)
    found = laid(mould, setting.least) if found is None else found
    goals = found / setting.scale
    return np.asarray(goals[setting.room.lack(goals) <= 0.0]) if len(goals) else goals


def thinned_out(setting: SpacingTask, draw: Draw, power: int) -> Array:
    """Return as many goals as find room on a surface or along edges, the worst placed taken out, shape (n,
    3).

    draw : gives points of it; power : 2 for surfaces, 1 for edges
    """
    scale = setting.scale
    shape = drawn(setting, draw, power) * scale
    start = centroids(shape, min(_held_about(setting, shape, power), len(shape))).goals
    slack = SLACK_SHARE * setting.least
    found = thinned(start, shape, setting.least, slack, _held(setting), upright=setting.upright)
    return evenly(found, setting.number) / scale


def evenly(goals: Array, number: int) -> Array:
    """Return so many of goals in an order of places, or all where there are no more."""
    if len(goals) <= number:
        return goals
    return np.asarray(goals[np.linspace(0, len(goals) - 1, number).round().astype(np.intp)])


def drawn(setting: SpacingTask, draw: Draw, power: int) -> Array:
    """Return points of a shape as dense as its goals can be, however many drones there are, shape (M, 3)."""
    few = draw(FEW_POINTS)
    return draw(max(FEW_POINTS, POINTS_EACH * _held_about(setting, few * setting.scale, power)))


def places_held(setting: SpacingTask, points: Array, factor: float) -> int:
    """Return how many places the densest lattice has in a volume made a number of times as large."""
    mould = _mould(setting, points)
    rough = grain(mould.shape)
    return len(laid(mould._replace(slack=(mould.slack - rough) / factor + rough), setting.least / factor))


def held_of(setting: SpacingTask, goals: PlacedGoals, power: int) -> int:
    """Return about how many goals a shape holds, by how far apart these are that are not spaced yet."""
    gap = _mean_gap(goals.centroids * setting.scale) if len(goals.centroids) > 1 else setting.least
    return ceil(len(goals.centroids) * (gap / setting.least) ** power)


def _held_about(setting: SpacingTask, shape: Array, power: int) -> int:
    """Return about how many goals a shape holds, and some more, by how far apart a few centroids of it
    are.
    """
    gap = _mean_gap(centroids(shape, FEW_GOALS).goals)
    return ceil(SPARE_RATIO * FEW_GOALS * (gap / setting.least) ** power) + 1


def _mould(setting: SpacingTask, points: Array) -> Mould:
    tree = cKDTree(points * setting.scale)
    return Mould(tree, SLACK_SHARE * setting.least + grain(tree), setting.upright)


def _held(setting: SpacingTask) -> Hold:
    scale, room = setting.scale, setting.room

    def hold(before: Array, after: Array) -> Array:
        return np.asarray(room.hold(before / scale, after / scale) * scale)

    return hold


def _mean_gap(goals: Array) -> float:
    return float(cKDTree(goals).query(goals, k=2)[0][:, 1].mean())


def _onto(points: Array, goals: Array) -> Array:
    """Draw goals along its normal into the surface of which points (M, 3) are given."""
    if len(points) < NEIGHBOUR_COUNT:
        return goals
    near = points[cKDTree(points).query(goals, k=NEIGHBOUR_COUNT)[1]]
    middle = near.mean(axis=1)
    away = near - middle[:, None]
    normal = np.linalg.eigh(np.einsum("nki,nkj->nij", away, away))[1][:, :, 0]
    off = np.einsum("ni,ni->n", goals - middle, normal)
    return np.asarray(goals - off[:, None] * normal)
