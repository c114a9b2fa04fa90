"""Goals of one frame: centroids, adjusted for the viewpoint, then pushed apart; a lattice if it must be
dense.
"""

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
"""Points from which the surface near a goal is estimated."""
CROWDED_SHARE = 0.9
"""Mean distance of centroids over the required distance, below which pushing them apart is not tried."""
TRIED_DRONES = 300
"""Up to this number of drones it is tried nevertheless: some fit where the shape is small."""
SPARE_RATIO = 1.15
"""Goals at the start of thinning over the estimated number that a shape holds."""
FEW_GOALS, FEW_POINTS, POINTS_EACH = 48, 4000, 20
"""To estimate how many goals a shape holds: the number of centroids, of its points, and of points per goal
held.
"""

Draw = Callable[[int], Array]
"""From a number to about that many points of a shape, shape (M, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class SpacingTask:
    """What the frames of one display have in common.

    number : number of drones
    least : required distance of two goals in the metric of the fleet, m
    stretch : factor for heights in that metric
    upright : whether the distance is that of vertical cylinders, the larger of the horizontal and the
        vertical one
    straight : distance above which straight moves need no proof, in the metric of the fleet, m
    viewpoint : shape (3,), or None
    weight : the paper's c-bar
    surroundings : the free space for goals
    """

    number: int
    least: float
    stretch: float
    upright: bool
    straight: float
    viewpoint: Array | None
    weight: float
    surroundings: DisplaySurroundings

    @property
    def roomy(self) -> SpacingTask:
        """Return the same task with goals so far apart that all moves between them are straight."""
        return replace(self, least=self.straight, upright=False)

    @property
    def scale(self) -> Array:
        """Return the factors of the axes in the metric of the fleet, shape (3,)."""
        return np.array([1.0, 1.0, self.stretch])


class PlacedGoals(NamedTuple):
    """Goals of a frame.

    centroids : in space, shape (n, 3)
    shown : adjusted for the viewpoint, shape (n, 3)
    points : the shape to show, shape (M, 3)
    """

    centroids: Array
    shown: Array
    points: Array


def placed(setting: SpacingTask, points: Array, before: PlacedGoals | None, on_surface: bool) -> PlacedGoals:
    """Return the goals that show points (M, 3) best, not yet pushed apart.

    before : the goals of the frame before, which these follow
    on_surface : whether goals stay in the surface of the points
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
    """Return goals moved apart as little as necessary, (n, 3), or None if they do not fit.

    If room is short, the cells of the tessellation are also made as flat or tall as the drones need.
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
    """Return goals of the widest lattice that has a place for each drone in a volume, shape (n, 3).

    If there is none, return all places of the densest lattice.

    draw : gives points of the volume
    """
    mould = _mould(setting, drawn(setting, draw, 3))
    lattice = widest(mould, setting.number, setting.least)
    lattice = laid(mould, setting.least) if lattice is None else lattice
    goals = lattice / setting.scale
    return np.asarray(goals[setting.surroundings.lack(goals) <= 0.0]) if len(goals) else goals


def thinned_out(setting: SpacingTask, draw: Draw, power: int) -> Array:
    """Return as many goals as fit on a surface or along edges, the worst placed removed, shape (n, 3).

    draw : gives points of the shape
    power : 2 for surfaces, 1 for edges
    """
    scale = setting.scale
    shape = drawn(setting, draw, power) * scale
    start = centroids(shape, min(_held_about(setting, shape, power), len(shape))).goals
    slack = SLACK_SHARE * setting.least
    goals = thinned(start, shape, setting.least, slack, _held(setting), upright=setting.upright)
    return evenly(goals, setting.number) / scale


def evenly(goals: Array, number: int) -> Array:
    """Return ``number`` of the ordered goals (n, 3), evenly chosen, or all if there are no more."""
    if len(goals) <= number:
        return goals
    return np.asarray(goals[np.linspace(0, len(goals) - 1, number).round().astype(np.intp)])


def drawn(setting: SpacingTask, draw: Draw, power: int) -> Array:
    """Return points of a shape as dense as its goals can be, for any number of drones, shape (M, 3)."""
    few = draw(FEW_POINTS)
    return draw(max(FEW_POINTS, POINTS_EACH * _held_about(setting, few * setting.scale, power)))


def places_held(setting: SpacingTask, points: Array, factor: float) -> int:
    """Return the number of places of the densest lattice in a volume enlarged by a factor.

    points : of the volume, (M, 3)
    """
    mould = _mould(setting, points)
    rough = grain(mould.shape)
    return len(laid(mould._replace(slack=(mould.slack - rough) / factor + rough), setting.least / factor))


def held_of(setting: SpacingTask, goals: PlacedGoals, power: int) -> int:
    """Return about how many goals a shape holds, from the mean distance of goals not yet pushed apart."""
    gap = _mean_gap(goals.centroids * setting.scale) if len(goals.centroids) > 1 else setting.least
    return ceil(len(goals.centroids) * (gap / setting.least) ** power)


def _held_about(setting: SpacingTask, shape: Array, power: int) -> int:
    """Return slightly more than the number of goals that a shape holds, from the distances of a few
    centroids.
    """
    gap = _mean_gap(centroids(shape, FEW_GOALS).goals)
    return ceil(SPARE_RATIO * FEW_GOALS * (gap / setting.least) ** power) + 1


def _mould(setting: SpacingTask, points: Array) -> Mould:
    tree = cKDTree(points * setting.scale)
    return Mould(tree, SLACK_SHARE * setting.least + grain(tree), setting.upright)


def _held(setting: SpacingTask) -> Hold:
    scale, surroundings = setting.scale, setting.surroundings

    def hold(before: Array, after: Array) -> Array:
        return np.asarray(surroundings.hold(before / scale, after / scale) * scale)

    return hold


def _mean_gap(goals: Array) -> float:
    return float(cKDTree(goals).query(goals, k=2)[0][:, 1].mean())


def _onto(points: Array, goals: Array) -> Array:
    """Move goals along the surface normal onto the surface given by points (M, 3)."""
    if len(points) < NEIGHBOUR_COUNT:
        return goals
    near = points[cKDTree(points).query(goals, k=NEIGHBOUR_COUNT)[1]]
    middle = near.mean(axis=1)
    offset = near - middle[:, None]
    normal = np.linalg.eigh(np.einsum("nki,nkj->nij", offset, offset))[1][:, :, 0]
    off = np.einsum("ni,ni->n", goals - middle, normal)
    return np.asarray(goals - off[:, None] * normal)
