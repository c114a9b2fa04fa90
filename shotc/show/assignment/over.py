"""Moves led over what lies between two formations: ground that rises, houses, zones, targets.

How much higher a fleet has to be is read at places along its way; that all of it is clear then is proved of
the flown splines, and where it is not, the fleet rises higher.
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
"""Factors of the heights that are needed, metres beyond them, and whether all is passed over that is near."""


class LiftedCandidate(NamedTuple):
    """A move that is lifted, and what it lacks most all the same."""

    move: LiftedMove
    lack: RoomLack


class MoveSurroundings(NamedTuple):
    """Where moves may be: clear of what is in a room, and between two heights."""

    room: DisplaySurroundings
    heights: Heights

    def lack(self, ends: Ends, move: Motion) -> RoomLack:
        """Return what a move lacks most, proved, but for the height that formations themselves lack."""
        flown = flown_of(ends, move)
        worst = self.room.worst(flown)
        high = max(self.heights.high, *(float(e[:, 2].max()) for e in ends))
        above = float(flown.ctrl[..., 2].max()) - high
        return RoomLack(above, None) if above > worst.metres else worst


@dataclass(frozen=True, slots=True, eq=False)
class MoveTask:
    """What a move is to keep: where it may be, the limits, the pace, and the easing of straight ways."""

    sky: MoveSurroundings
    limits: Limits
    pace: float
    easing: Easing


def over(ends: Ends, asked: MoveTask, course: Course) -> LiftedCandidate | None:
    """Return the fastest move found that rises over what is in the way; if none is clear, what lacks least.

    course : the way that it goes, seen from above
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
    """Return by how much a fleet has to rise where (a, b) is at places (T, 2), metres, shape (T,).

    Between two places it is the more of both: what is steep, as a wall, begins between two of them.
    """
    away, there = ends[0] - pivot, ends[1] - pivot
    # Drone by drone, for places that follow one another are looked up together.
    ways = pivot + places[:, :1] * away[:, None] + places[:, 1:] * there[:, None]
    need = room.up(ways.reshape(-1, 3), every=every).reshape(len(away), -1).max(axis=0)
    need[1:-1] = np.maximum(need[1:-1], np.maximum(need[:-2], need[2:]))
    return np.asarray(need)
