"""Moves that rise over obstacles between two formations: rising ground, buildings, zones, targets.

The required rise of a fleet is evaluated at points of its path. The flown splines are then proved clear. If
the proof fails, the fleet rises higher.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.planning.clearances import ROUNDING_M
from shotc.show.assignment.score import Motion
from shotc.show.assignment.swell import Ends, Heights, flown_of
from shotc.show.goals.room import DisplaySurroundings, RoomLack
from shotc.show.solvers.lifted_move import LEAST_M, Course, LiftedMove, lifted

TRIES = ((1.0, 0.0, False), (1.1, 0.2, False), (1.25, 0.6, False), (1.0, 0.2, True), (1.15, 0.6, True))
"""Factor on the required heights, additional height in metres, and whether the fleet rises over all that is
near.
"""


class LiftedCandidate(NamedTuple):
    """A lifted move, and its largest remaining violation."""

    move: LiftedMove
    lack: RoomLack


class MoveSurroundings(NamedTuple):
    """The allowed space of moves: clear of the obstacles of a room, and between two heights."""

    room: DisplaySurroundings
    heights: Heights

    def lack(self, ends: Ends, move: Motion) -> RoomLack:
        """Return a move's largest violation, proved; excess height of the formations themselves is not
        counted.
        """
        flown = flown_of(ends, move)
        worst = self.room.worst(flown)
        high = max(self.heights.high, *(float(e[:, 2].max()) for e in ends))
        above = float(flown.ctrl[..., 2].max()) - high
        return RoomLack(above, None) if above > worst.metres else worst


@dataclass(frozen=True, slots=True, eq=False)
class MoveTask:
    """The requirements of a move: its allowed space, the limits, the pace, and the easing of
    straight moves.
    """

    sky: MoveSurroundings
    limits: Limits
    pace: float
    easing: Easing


def over(ends: Ends, asked: MoveTask, course: Course) -> LiftedCandidate | None:
    """Return the fastest move found that rises over the obstacles, or that with the least violation.

    The result is None if rising does not help.

    course : its path, as seen from above
    """
    best: LiftedCandidate | None = None
    for factor, more, every in TRIES:

        def need(places: Array, by: tuple[float, float, bool] = (factor, more, every)) -> Array:
            needed = _need(ends, course.pivot, places, asked.sky.room, every=by[2])
            return np.where(needed > LEAST_M, by[0] * needed + by[1], 0.0)

        found = lifted(ends, course, need, (asked.limits, asked.pace, asked.easing))
        if found is None:
            continue
        lack = asked.sky.lack(ends, found)
        if best is None or lack.metres < best.lack.metres:
            best = LiftedCandidate(found, lack)
        if lack.metres <= ROUNDING_M:
            break
    return best


def _need(ends: Ends, pivot: Array, places: Array, room: DisplaySurroundings, *, every: bool) -> Array:
    """Return the required rise of a fleet with (a, b) at places (T, 2), m, shape (T,).

    Each value includes those of its neighbours, because steep obstacles such as walls may start between two
    places.
    """
    away, there = ends[0] - pivot, ends[1] - pivot
    # The order is drone by drone, because consecutive places are looked up together.
    ways = pivot + places[:, :1] * away[:, None] + places[:, 1:] * there[:, None]
    need = room.up(ways.reshape(-1, 3), every=every).reshape(len(away), -1).max(axis=0)
    need[1:-1] = np.maximum(need[1:-1], np.maximum(need[:-2], need[2:]))
    return np.asarray(need)
