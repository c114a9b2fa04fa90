"""Candidate transfers from one pose to another: direct, around moving obstacles, and above them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.solid_arrays.rings import ring
from shotc.geom.solids import Cylinder, Prism, Solid, convex_hull
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import MovingLeg, Pose
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.shot import OtherVehicles
from shotc.planning.free_space import FreeSpace, Obstacle
from shotc.planning.obstacles import FreeSpaces
from shotc.planning.path.legs import LegContext, end_of, raised, take_off, way_home, way_to

LIFTS_M = (4.0, 10.0, 20.0)  # metres above the higher end of a transfer
HULL_STEP_S = 0.5  # seconds between the samples of a hull
STILL_M = 1e-3  # metres, below which a target stands
PRISM_CORNERS = 8  # corners of the prism around a cylinder


class Meanwhile(NamedTuple):
    """The other vehicles while a drone flies a transfer; span : mission times of start and end, seconds."""

    others: OtherVehicles
    span: tuple[float, float]

    def beside(self, flight: LegContext) -> LegContext:
        """Return the flight with a free space that excludes all places of targets during that time."""
        return replace(flight, spaces=with_sweeps(flight.spaces, self.others.moving, self.span))


@dataclass(frozen=True, slots=True, eq=False)
class Transit:
    """A transfer from a pose to another, and the key path of the shot or drone that it is flown for."""

    mission: MissionIR
    flight: LegContext
    pose: Pose
    goal: Pose
    path: KeyPath


def ways_home(
    flight: LegContext, pose: Pose, direct: list[MovingLeg], meanwhile: Meanwhile
) -> Iterator[list[MovingLeg]]:
    """Yield the direct way home, the one around everything that moves, and those that first rise
    straight up.
    """
    yield direct
    around = way_home(meanwhile.beside(flight), pose)
    if isinstance(around, list):
        yield around
    for metres in LIFTS_M:
        top = _at(pose, pose[2] + metres)
        up = _through(flight, [pose, top], flight.drone.path)
        back = way_home(flight, top)
        if up is not None and isinstance(back, list):
            yield [*up, *back]


def ways_to(
    transit: Transit, start: tuple[list[MovingLeg], Pose], direct: list[MovingLeg], meanwhile: Meanwhile
) -> Iterator[list[MovingLeg]]:
    """Yield the direct transfer, the one around everything that moves, and those above it.

    start : the take-off legs where the drone is on its pad, and the shot's first pose, to which they turn
    """
    (lift, first), flight = start, transit.flight
    pose, goal, path = transit.pose, transit.goal, transit.path
    yield [*lift, *direct]
    around = way_to(meanwhile.beside(flight), pose, goal, path)
    if isinstance(around, list):
        yield [*lift, *around]
    for metres in LIFTS_M:
        high = max(pose[2], goal[2]) + metres
        # From a pad, the take-off goes straight up already.
        stops = [pose, *([] if lift else [_at(pose, high)]), _at(goal, high), goal]
        legs = _through(flight, stops, path)
        if legs is not None:
            yield [*lift, *legs]
    if lift:
        yield from _lifted(transit, first)


def _lifted(transit: Transit, first: Pose) -> Iterator[list[MovingLeg]]:
    """Yield transfers with a higher take-off, where there is free space for it."""
    for metres in LIFTS_M:
        higher = raised(transit.mission, transit.flight, metres)
        if higher is None:
            return
        lift = take_off(higher, first)
        rest = way_to(higher, end_of([lift]), transit.goal, transit.path)
        if isinstance(rest, list):
            yield [lift, *rest]


def _through(flight: LegContext, stops: list[Pose], path: KeyPath) -> list[MovingLeg] | None:
    """Return legs through a sequence of poses, or None where two of them cannot be joined."""
    legs: list[MovingLeg] = []
    for a, b in pairwise(stops):
        direct = way_to(flight, a, b, path)
        if not isinstance(direct, list):
            return None
        legs += direct
    return legs


def _at(pose: Pose, height: float) -> Pose:
    """Return a pose at another height."""
    return (*pose[:2], height, *pose[3:])


def with_sweeps(spaces: FreeSpaces, moving: Sequence[Moving], span: tuple[float, float]) -> FreeSpaces:
    """Return free spaces that exclude all places of targets between two mission times, seconds.

    Each target becomes the hull of its places in that time. A transfer around the hulls is clear whenever it
    is flown within the time, and it is the shortest one beside a target that stands until it is filmed.
    """
    swept = [(m, _swept(m, span)) for m in moving if not m.always]
    flight = (Obstacle(m.owner, part, m.clearance) for m, part in swept)
    transit = (Obstacle(m.owner, part, m.apart) for m, part in swept)
    return spaces._replace(flight=_with(spaces.flight, flight), transit=_with(spaces.transit, transit))


def _with(space: FreeSpace, more: Iterable[Obstacle]) -> FreeSpace:
    return replace(space, obstacles=(*space.obstacles, *more))


def _swept(what: Moving, span: tuple[float, float]) -> Solid:
    part, (begin, end) = what.part, span
    at = what.at(np.append(np.arange(begin, end, HULL_STEP_S), end))
    low, high = at.min(axis=0), at.max(axis=0)
    middle, bottom, top = 0.5 * (low + high), part.bottom + float(low[2]), part.top + float(high[2])
    if isinstance(part, Cylinder) and np.linalg.norm(high - low) < STILL_M:
        return Cylinder((float(middle[0]), float(middle[1])), part.radius + STILL_M, bottom, top)
    outline = ring(part.radius, PRISM_CORNERS) if isinstance(part, Cylinder) else np.array(part.points)
    corners = (at[:, None, :2] + outline).reshape(-1, 2)
    return Prism(convex_hull(tuple((float(x), float(y)) for x, y in corners)), bottom, top)
