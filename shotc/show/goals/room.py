"""Where goals may be: clear of zones, of targets that stand, and of the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import signed_distance
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of, outward

FAR_M = 1000.0
"""Metres beyond which no shift is looked for."""
SHIFT_ROUNDS = 60
DIRECTION_COUNT = 16


@dataclass(frozen=True, slots=True, eq=False)
class DisplaySurroundings:
    """What stands around; lowest : z that the centre of a drone may have, metres."""

    obstacles: tuple[Clearance, ...]
    lowest: float

    def lack(self, goals: Array) -> Array:
        """Return by how many metres room is missing at each goal, (n,), at most 0 where there is enough."""
        lacks = [self.lowest - goals[:, 2], *(lack_of(o, goals) for o in self.obstacles)]
        return np.asarray(np.max(lacks, axis=0))

    def hold(self, before: Array, after: Array) -> Array:
        """Return goals where a push takes them, or where they were if there is less room than needed."""
        lacking = self.lack(after)
        if not (lacking > 0).any():
            return after
        return np.where((lacking > np.maximum(self.lack(before), 0.0))[:, None], before, after)


def room_of(mission: MissionIR, fleet: Fleet) -> DisplaySurroundings:
    """Return what a fleet's goals keep clear of."""
    return DisplaySurroundings(tuple(clearances_of(mission, fleet)), mission.rules.over_ground(fleet.radius))


def lack_of(obstacle: Clearance, goals: Array) -> Array:
    """Return by how many metres room is missing at goals (n, 3), negative where there is more."""
    gap = signed_distance(obstacle.solid, goals)
    return obstacle.metres + (gap if obstacle.inside else -gap)


def least_shift(goals: Array, room: DisplaySurroundings) -> Array | None:
    """Return the shortest shift (3,) found that gives all goals room, rounded up to centimetres, or None.

    Along each of a number of directions the goals go on by what is missing; as no distance grows faster
    than they move, no place with room is passed over.
    """
    best: Array | None = None
    for way in _ways():
        most = FAR_M if best is None else float(np.linalg.norm(best))
        length = _along(goals, room, way, most)
        if length is not None and length < most:
            x, y, z = way * length
            shift = np.array(outward((0.0, 0.0, 0.0), (x, y, z)))
            if (room.lack(goals + shift) <= ROUNDING_M).all():
                best = shift
    return best


def _along(goals: Array, room: DisplaySurroundings, way: Array, most: float) -> float | None:
    length = 0.0
    for _ in range(SHIFT_ROUNDS):
        missing = float(room.lack(goals + length * way).max())
        if missing <= ROUNDING_M:
            return length
        length += max(missing, 0.005)
        if length >= most:
            return None
    return None


def _ways() -> Array:
    """Return unit vectors: up and down, level all round, and half-way up and down between."""
    turns = 2.0 * np.pi * np.arange(DIRECTION_COUNT) / DIRECTION_COUNT
    level = np.round(np.column_stack([np.sin(turns), np.cos(turns), np.zeros(DIRECTION_COUNT)]), 12)
    slanted = [(level + np.array([0.0, 0.0, side])) / np.sqrt(2.0) for side in (1.0, -1.0)]
    return np.concatenate([np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), level, *slanted])
