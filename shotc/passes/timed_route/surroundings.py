"""All that a shot on its own clock is flown clear of, as half-spaces over time and as a proof.

For refiners: they put their motion beside the same solids as the convex guide, and prove it the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.corridor import Room, kept, shortfall
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.path import PathIR, TimedLeg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.parameterize_time.estimate import leg_motion
from shotc.passes.parameterize_time.flight import Flight
from shotc.passes.solve_path_qp.room import flight_room
from shotc.passes.timed_route.moving import Even, evened, moving_targets, shortfalls, sides, standing
from shotc.passes.timed_route.others import other_drones

LATE = 1e-6  # seconds


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What is near a motion over mission time.

    breaks : of the motion's pieces, shape (P + 1,), seconds
    walls : the room without its obstacles; motions : its obstacles and what moves, even on those pieces
    """

    breaks: Array
    walls: Room
    motions: tuple[Even, ...]

    def lacking(self, hulls: Array) -> Array:
        """Return by how much pieces fail to prove their clearances, metres; shape (P,), <= 0 is proved.

        hulls : shape (P, 6, 3), Bernstein points
        """
        return np.maximum(shortfall(self.walls, hulls), shortfalls(self.motions, hulls))

    def half_spaces(self, hulls: Array, reach: float, share: float) -> Planes:
        """Put half-spaces between pieces and what is near them.

        hulls : as in ``lacking``; reach : metres beyond its clearance within which a wall counts
        share : of the room that a piece has beyond a wall, kept
        """
        beside = sides(self.motions, hulls)
        found = [(beside.piece, beside.normal, beside.offset[:, [0, -1]])]
        for normals, offsets in self._bounds(hulls):
            slack = np.einsum("pmd,pd->pm", hulls, normals).min(axis=1) - offsets
            near = np.flatnonzero(slack < reach)
            ends = np.repeat((offsets[near] + kept(slack[near], share))[:, None], 2, axis=1)
            found.append((near, normals[near], ends))
        pieces, every, borders = zip(*found, strict=True)
        return Planes(np.concatenate(pieces), np.concatenate(every), np.concatenate(borders))

    def _bounds(self, hulls: Array) -> Sequence[tuple[Array, Array]]:
        """Return normals (P, 3) and offsets (P,) of walls, and of the tangents of discs beside pieces."""
        found = []
        for wall in self.walls.walls:
            n = np.tile(np.array(wall.normal), (len(hulls), 1))
            found.append((n, np.full(len(hulls), wall.offset)))
        for disc in self.walls.discs:
            centre = np.array(disc.centre)
            away = hulls[:, :, :2].mean(axis=1) - centre
            away /= np.maximum(np.linalg.norm(away, axis=1), 1e-9)[:, None]
            n = np.column_stack([-away, np.zeros(len(hulls))])
            found.append((n, n[:, :2] @ centre - disc.radius))
        return found


@dataclass(frozen=True, slots=True, eq=False)
class Planes:
    """Half-spaces n.p >= border for all Bernstein points of pieces.

    piece : shape (R,); normal : (R, 3), units
    border : (R, 2), metres, at the piece's start and end and even between them
    """

    piece: IntArray
    normal: Array
    border: Array


def surroundings(path: PathIR, drone: Drone, breaks: Array) -> Surroundings:
    """Return what a drone of a path keeps clear of on pieces of mission time."""
    mission, room = path.keyframes.mission, flight_room(path.keyframes.mission, drone)
    moving = (
        *standing(room),
        *moving_targets(mission, drone),
        *other_drones(mission, drone.name, flights(path)),
    )
    return Surroundings(
        breaks, Room((), room.walls, room.discs), tuple(evened(what, breaks) for what in moving)
    )


def flights(path: PathIR) -> dict[str, DroneTrajectory]:
    """Return the flights of the drones of a path on the clock, by name; one has no others."""
    if len(path.timed) < 2:
        return {}
    ends: dict[str, float] = {}
    return {flown.drone: flight(path.keyframes.mission, flown, ends) for flown in path.timed}


def flight(mission: MissionIR, flown: TimedPath, ends: dict[str, float]) -> DroneTrajectory:
    """Return a drone's flight as the time pass will fly it, up to a shot that it would be late for.

    ends : of the shots of drones before it, by id, seconds; its own are added
    """
    drone, made = mission.drone(flown.drone), Flight(flown.drone)
    after = {shot.id: shot.timing.after for shot in mission.shots}
    for leg in flown.legs:
        if isinstance(leg, TimedLeg):
            if made.clock > leg.curve.start + LATE:
                break
            made.wait(float(leg.curve.start), leg.pose)
            made.film(leg)
            ends[leg.shot] = leg.end
            continue
        motion = leg_motion(mission, drone, leg)
        waited = ends.get(after.get(leg.shot or "") or "", 0.0)
        made.wait(max(made.clock, leg.start or 0.0, waited), leg.pose)
        if motion is not None:
            made.fly(leg, motion)
        if leg.shot is not None:
            ends[leg.shot] = made.clock
    return made.trajectory()
