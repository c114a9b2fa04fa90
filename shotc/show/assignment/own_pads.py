"""The return of every drone to its own pad from any formation, by levels.

All drones first move, matched by least squares, to columns that are the separation apart: those over the
pads, or over pads scaled outwards as far as necessary. In its column each drone climbs or descends to its
level, flies straight to over its own pad, all at the same time, and descends.

In columns no two drones come too near, whatever the heights. During the horizontal flight two drones of one
level are r0 + s (r1 - r0) apart, with a common s from 0 to 1, r0 between their columns and r1 between their
pads. Drones share a level only if they keep the horizontal separation all that time, at s = 1 as well. Levels
are the vertical separation apart. So one such flight is enough for any number of exchanges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.apart import ROUNDING_RATIO, stretch
from shotc.geom.bernstein import Array
from shotc.ir.show import Fleet
from shotc.show.assignment.order import CONTROL_DECIMALS, RiseColumns, pads_of
from shotc.show.solvers.match import matched

ROUNDING_M = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class WayToOwn:
    """Positions of all drones on their return, in the order of their numbers, shape (n, 3) each.

    columns : first goals
    raised : at their levels in the columns
    down : from there on over their own pads
    heights : of the levels above the pads, descending, metres
    step : least distance between levels, metres
    """

    columns: Array
    raised: Array
    down: RiseColumns
    heights: tuple[float, ...]
    step: float


def way_to_own(fleet: Fleet, places: Array) -> WayToOwn:
    """Return the return from positions (n, 3)."""
    pads = pads_of(fleet)
    columns = _columns(fleet, pads)
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    columns = columns[matched(places * scale, columns * scale)]
    level = levels(columns[:, :2], pads[:, :2], fleet.apart.across)
    count = int(level.max()) + 1
    step = ROUNDING_RATIO * (fleet.apart.upright + float(np.ptp(pads[:, 2])))
    heights = fleet.rise + step * np.arange(count)[::-1]
    layer = count - 1 - level
    above = pads.copy()
    above[:, 2] = np.round(pads[:, 2] + heights[layer], CONTROL_DECIMALS)
    raised = np.concatenate([columns[:, :2], above[:, 2:]], axis=1)
    return WayToOwn(columns, raised, RiseColumns(pads, above, layer), tuple(heights.tolist()), step)


def levels(starts: Array, ends: Array, least: float) -> NDArray[np.intp]:
    """Return a level, from 0, for each drone that flies straight from (n, 2) to (n, 2), all at the same time.

    Two drones of one level never come nearer than ``least`` metres. The drone with the longest path chooses
    first, the lowest free level.
    """
    chosen = np.full(len(starts), -1, dtype=np.intp)
    displacements = ends - starts
    order = np.argsort(-np.einsum("nd,nd->n", displacements, displacements), kind="stable")
    for count, i in enumerate(order):
        others = order[:count]
        taken = np.unique(chosen[others[_nearest(starts, displacements, i, others) < least - ROUNDING_M]])
        free = np.flatnonzero(taken != np.arange(len(taken)))
        chosen[i] = free[0] if len(free) else len(taken)
    return chosen


def _nearest(starts: Array, displacements: Array, one: int, others: NDArray[np.intp]) -> Array:
    """Return the least distances of one drone from others during the flight, shape (m,), metres."""
    apart, change = starts[others] - starts[one], displacements[others] - displacements[one]
    size = np.einsum("nd,nd->n", change, change)
    along = -np.einsum("nd,nd->n", apart, change)
    share = np.clip(along / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(apart + share[:, None] * change, axis=1))


def _columns(fleet: Fleet, pads: Array) -> Array:
    """Return the positions over the pads, scaled about their middle as far as the separation demands."""
    level = pads[:, :2]
    nearest = cKDTree(level).query(level, k=2)[0][:, 1].min() if len(pads) > 1 else np.inf
    wide = (
        1.0 if nearest >= fleet.apart.across - ROUNDING_M else ROUNDING_RATIO * fleet.apart.across / nearest
    )
    middle = 0.5 * (level.min(axis=0) + level.max(axis=0))
    over = np.full(len(pads), pads[:, 2].max() + fleet.rise)
    return np.round(np.column_stack([middle + wide * (level - middle), over]), CONTROL_DECIMALS)
