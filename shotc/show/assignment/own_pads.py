"""The way home to its own pad for every drone, whatever the formation: at heights of their own.

From where they rest all go, matched by least squares, to columns that are the separation apart: those over
the pads, or over pads drawn out as far as that takes. There each climbs or sinks upright to a level, flies
over its own pad, straight and all at once, and comes down. In columns nobody comes nearer, whatever the
heights. On the way two of one level are r0 + s (r1 - r0) apart, s from 0 to 1 for all, where their columns
are r0 apart and their pads r1. Only those share a level that are the horizontal separation apart all that
while, s = 1 included; levels are the vertical one apart. So however many change places, it is one flight.
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
    """Places of all drones on their way, in the order of their numbers, shape (n, 3) each.

    columns : to which they go first; raised : at their levels there; down : from there on over their own pads
    heights : of the levels over the pads, falling, metres; step : by which one is above the next, at least
    """

    columns: Array
    raised: Array
    down: RiseColumns
    heights: tuple[float, ...]
    step: float


def way_to_own(fleet: Fleet, places: Array) -> WayToOwn:
    """Return the way home from places of shape (n, 3)."""
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
    """Return a level for everybody who goes straight from (n, 2) to (n, 2), all at once, from 0 on.

    Two of one level never come nearer than ``least`` metres. Who goes farthest chooses first, the lowest
    level that is free.
    """
    found = np.full(len(starts), -1, dtype=np.intp)
    ways = ends - starts
    order = np.argsort(-np.einsum("nd,nd->n", ways, ways), kind="stable")
    for count, i in enumerate(order):
        others = order[:count]
        taken = np.unique(found[others[_nearest(starts, ways, i, others) < least - ROUNDING_M]])
        free = np.flatnonzero(taken != np.arange(len(taken)))
        found[i] = free[0] if len(free) else len(taken)
    return found


def _nearest(starts: Array, ways: Array, one: int, others: NDArray[np.intp]) -> Array:
    """Return how near one comes to others on their ways, shape (m,)."""
    apart, change = starts[others] - starts[one], ways[others] - ways[one]
    size = np.einsum("nd,nd->n", change, change)
    along = -np.einsum("nd,nd->n", apart, change)
    share = np.clip(along / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(apart + share[:, None] * change, axis=1))


def _columns(fleet: Fleet, pads: Array) -> Array:
    """Return the places over the pads, drawn out about their middle as far as the separation asks for."""
    level = pads[:, :2]
    nearest = cKDTree(level).query(level, k=2)[0][:, 1].min() if len(pads) > 1 else np.inf
    wide = (
        1.0 if nearest >= fleet.apart.across - ROUNDING_M else ROUNDING_RATIO * fleet.apart.across / nearest
    )
    middle = 0.5 * (level.min(axis=0) + level.max(axis=0))
    over = np.full(len(pads), pads[:, 2].max() + fleet.rise)
    return np.round(np.column_stack([middle + wide * (level - middle), over]), CONTROL_DECIMALS)
