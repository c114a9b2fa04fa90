"""The free space for goals and paths: clear of zones, targets, the ground, scenes and buildings."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces
from shotc.geom.proof import box_gap, inf_distance, sup_outside
from shotc.geom.solid_arrays.points import signed_distance
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of, outward
from shotc.show.goals.surfaces import CLOSED_M, Standing, surfaces_of

FAR_M = 1000.0
"""Largest shift that is searched for."""
SHIFT_ROUNDS = 60
DIRECTION_COUNT = 16


class RoomLack(NamedTuple):
    """The largest violation of a flight, m; of : the obstacle, None for flat ground and the height limit."""

    metres: float
    of: Clearance | Standing | None


@dataclass(frozen=True, slots=True, eq=False)
class DisplaySurroundings:
    """The obstacles around a display.

    lowest : least z of a drone's centre over flat ground, m; minus infinity over terrain
    surfaces : terrain, scenes and buildings
    """

    obstacles: tuple[Clearance, ...]
    lowest: float
    surfaces: tuple[Standing, ...] = ()

    def lack(self, goals: Array) -> Array:
        """Return the missing clearance at each goal, (n,), m; at most 0 where there is enough."""
        lacks = [self.lowest - goals[:, 2], *(lack_of(o, goals) for o in self.obstacles)]
        lacks += [surface.lack(goals) for surface in self.surfaces]
        return np.asarray(np.max(lacks, axis=0))

    def worst(self, flown: FleetPieces) -> RoomLack:
        """Return a flight's largest violation, proved, of zones, targets and surfaces, but not of flat
        ground.
        """
        worst, bag = RoomLack(0.0, None), flown.bag()
        for obstacle in (*self.obstacles, *self.surfaces):
            metres = beside(obstacle, bag) if isinstance(obstacle, Clearance) else obstacle.worst(bag)
            worst = RoomLack(metres, obstacle) if metres > worst.metres else worst
        return worst

    def up(self, p: Array, *, every: bool) -> Array:
        """Return the rise that clears places (n, 3) of what is below them, (n,), m; infinite where none does.

        every : whether they must be above all that is near in the horizontal plane, or only where clearance
            is missing
        """
        rises = [np.maximum(self.lowest - p[:, 2], 0.0)]
        rises += [over(o, p, every=every) for o in self.obstacles if not o.inside]
        rises += [surface.up(p, every=every) for surface in self.surfaces]
        return np.asarray(np.max(rises, axis=0))

    def hold(self, before: Array, after: Array) -> Array:
        """Return pushed goals (n, 3), but keep the old position of those whose clearance would become too
        small.
        """
        lacking = self.lack(after)
        if not (lacking > 0).any():
            return after
        return np.where((lacking > np.maximum(self.lack(before), 0.0))[:, None], before, after)


def room_of(mission: MissionIR, fleet: Fleet) -> DisplaySurroundings:
    """Return the obstacles for a fleet's goals."""
    lowest = mission.rules.over_ground(fleet.radius) if mission.terrain is None else -inf
    return DisplaySurroundings(tuple(clearances_of(mission, fleet)), lowest, surfaces_of(mission, fleet))


def lack_of(obstacle: Clearance, goals: Array) -> Array:
    """Return the missing clearance at goals (n, 3), m; negative where there is more than needed."""
    gap = signed_distance(obstacle.solid, goals)
    return obstacle.metres + (gap if obstacle.inside else -gap)


def over(obstacle: Clearance, p: Array, *, every: bool) -> Array:
    """Return the rise that brings places (n, 3) above an obstacle; see ``DisplaySurroundings.up``."""
    solid = obstacle.solid
    beside_ = signed_distance(solid._replace(bottom=-inf, top=inf), p) < obstacle.metres
    relevant = beside_ if every else beside_ & (lack_of(obstacle, p) > 0.0)
    return np.where(relevant, np.maximum(solid.top + obstacle.metres - p[:, 2], 0.0), 0.0)


def beside(obstacle: Clearance, bag: Pieces) -> float:
    """Return the proved largest lack of clearance to an obstacle, m; at most 0 if there is none."""
    if obstacle.inside:
        return sup_outside(bag, obstacle.solid, lambda _: CLOSED_M).proven + obstacle.metres
    near = box_gap(bag.ctrl, obstacle.solid) < obstacle.metres
    if not near.any():
        return 0.0
    return obstacle.metres - inf_distance(bag.pick(near), obstacle.solid, lambda _: CLOSED_M).proven


def least_shift(goals: Array, surroundings: DisplaySurroundings) -> Array | None:
    """Return the shortest shift (3,) found that clears all goals, rounded up to centimetres, or None.

    Along each of several directions the goals move on by the missing clearance. Distances grow no faster than
    the goals move, so no free place is passed over. Heights over slopes may grow faster: there a nearer place
    may exist.
    """
    best: Array | None = None
    for direction in _directions():
        most = FAR_M if best is None else float(np.linalg.norm(best))
        length = _along(goals, surroundings, direction, most)
        if length is not None and length < most:
            x, y, z = direction * length
            shift = np.array(outward((0.0, 0.0, 0.0), (x, y, z)))
            if (surroundings.lack(goals + shift) <= ROUNDING_M).all():
                best = shift
    return best


def _along(goals: Array, surroundings: DisplaySurroundings, direction: Array, most: float) -> float | None:
    length = 0.0
    for _ in range(SHIFT_ROUNDS):
        missing = float(surroundings.lack(goals + length * direction).max())
        if missing <= ROUNDING_M:
            return length
        length += max(missing, 0.005)
        if length >= most:
            return None
    return None


def _directions() -> Array:
    """Return unit vectors: up, down, horizontal in all directions, and these tilted by 45 degrees up and
    down.
    """
    turns = 2.0 * np.pi * np.arange(DIRECTION_COUNT) / DIRECTION_COUNT
    level = np.round(np.column_stack([np.sin(turns), np.cos(turns), np.zeros(DIRECTION_COUNT)]), 12)
    slanted = [(level + np.array([0.0, 0.0, side])) / np.sqrt(2.0) for side in (1.0, -1.0)]
    return np.concatenate([np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), level, *slanted])
