"""Moves that rise over obstacles between two formations: rising ground, buildings, zones, targets.

The required rise of a fleet is evaluated at points of its path. The flown splines are then proved clear. If
the proof fails, the fleet rises higher by what it lacks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.planning.clearances import ROUNDING_M
from shotc.planning.over_ground import OUTSIDE_M
from shotc.show.assignment.score import Motion
from shotc.show.assignment.swell import Ends, Heights, flown_of
from shotc.show.goals.room import DisplaySurroundings, RoomLack
from shotc.show.solvers.lifted_move import Course, Drive, LiftedMove, lifted, rising_paths

HEIGHT_TRIES = 6
"""Most heights that are tried, each higher by what the one before lacks."""
LACK_RATIO, BEYOND_M = 1.1, 0.02
"""Rise for each metre of a missing clearance in the first round, and beyond it, metres."""
GROWTH_RATIO = 1.5
"""Growth of that ratio from round to round: beside a steep obstacle a rise gains less clearance."""


class LiftedCandidate(NamedTuple):
    """A lifted move, and its largest remaining violation."""

    move: LiftedMove
    lack: RoomLack


class MoveSurroundings(NamedTuple):
    """The allowed space of moves: clear of the obstacles of a room, and between two heights."""

    surroundings: DisplaySurroundings
    heights: Heights

    def lack(self, ends: Ends, move: Motion) -> RoomLack:
        """Return a move's largest violation, proved; excess height of the formations themselves is not
        counted.
        """
        flown = flown_of(ends, move)
        worst = self.surroundings.worst(flown)
        _, high = self.heights.beside(ends)
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


def over(ends: Ends, task: MoveTask, course: Course) -> LiftedCandidate | None:
    """Return the fastest move found that rises over the obstacles, or that with the least violation.

    The result is None if rising does not help.

    course : its path, as seen from above
    """
    best: LiftedCandidate | None = None
    drive = Drive(task.limits, task.pace, task.easing)
    for every in (False, True):
        need = partial(_need, ends, course.pivot, task.sky.surroundings, every=every)
        paths, higher = rising_paths(ends, course, need), 0.0
        for k in range(HEIGHT_TRIES):
            shape = lifted(ends, course, [path.higher(higher) for path in paths], drive)
            if shape is None:
                break
            lack = task.sky.lack(ends, shape)
            if best is None or lack.metres < best.lack.metres:
                best = LiftedCandidate(shape, lack)
            if lack.metres <= ROUNDING_M:
                return best
            if lack.of is None or lack.metres >= OUTSIDE_M:  # a greater height does not help
                break
            higher += LACK_RATIO * GROWTH_RATIO**k * lack.metres + BEYOND_M
    return best


def _need(
    ends: Ends, pivot: Array, surroundings: DisplaySurroundings, places: Array, *, every: bool
) -> Array:
    """Return the required rise of a fleet with (a, b) at places (T, 2), m, shape (T,).

    Each value includes those of its neighbours, because steep obstacles such as walls may start between two
    places.

    every : whether the fleet rises over all that is near, or only over what it comes too near to
    """
    away, there = ends[0] - pivot, ends[1] - pivot
    # The order is drone by drone, because consecutive places are looked up together.
    points = pivot + places[:, :1] * away[:, None] + places[:, 1:] * there[:, None]
    need = surroundings.up(points.reshape(-1, 3), every=every).reshape(len(away), -1).max(axis=0)
    need[1:-1] = np.maximum(need[1:-1], np.maximum(need[:-2], need[2:]))
    return np.asarray(need)
