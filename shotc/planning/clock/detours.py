"""The unfilmed ways that are tried from one pose to another: direct, round what passes, and over it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import MovingLeg, Pose
from shotc.planning.clock.shot import OtherVehicles
from shotc.planning.clock.sweeps import with_sweeps
from shotc.planning.path.legs import Flight, end_of, raised, take_off, way_home, way_to

LIFTS_M = (4.0, 10.0, 20.0)  # metres over the higher end of a way


class Meanwhile(NamedTuple):
    """What goes on while a drone is on its way; span : from when to when that is, mission time, seconds."""

    others: OtherVehicles
    span: tuple[float, float]

    def beside(self, flight: Flight) -> Flight:
        """Return the flight in the free space that targets leave wherever they go meanwhile."""
        return replace(flight, spaces=with_sweeps(flight.spaces, self.others.moving, self.span))


@dataclass(frozen=True, slots=True, eq=False)
class Transit:
    """A way from a pose to another, and the YAML path of what it is flown for."""

    mission: MissionIR
    flight: Flight
    pose: Pose
    goal: Pose
    path: KeyPath


def ways_home(
    flight: Flight, pose: Pose, direct: list[MovingLeg], meanwhile: Meanwhile
) -> Iterator[list[MovingLeg]]:
    """Return the direct way home, the one round everything, and those first straight up."""
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
    wanted: Transit, start: tuple[list[MovingLeg], Pose], direct: list[MovingLeg], meanwhile: Meanwhile
) -> Iterator[list[MovingLeg]]:
    """Return the direct way, the one round everything, and those over what is met.

    start : the take-off where the drone is on its pad, and the shot's first pose, which that turns to
    """
    (lift, first), flight = start, wanted.flight
    pose, goal, path = wanted.pose, wanted.goal, wanted.path
    yield [*lift, *direct]
    around = way_to(meanwhile.beside(flight), pose, goal, path)
    if isinstance(around, list):
        yield [*lift, *around]
    for metres in LIFTS_M:
        high = max(pose[2], goal[2]) + metres
        # Straight up from a pad there is the take-off already.
        stops = [pose, *([] if lift else [_at(pose, high)]), _at(goal, high), goal]
        found = _through(flight, stops, path)
        if found is not None:
            yield [*lift, *found]
    if lift:
        yield from _lifted(wanted, first)


def _lifted(wanted: Transit, first: Pose) -> Iterator[list[MovingLeg]]:
    """Return ways from the pad that rise higher straight up, where there is room for it."""
    for metres in LIFTS_M:
        higher = raised(wanted.mission, wanted.flight, metres)
        if higher is None:
            return
        lift = take_off(higher, first)
        rest = way_to(higher, end_of([lift]), wanted.goal, wanted.path)
        if isinstance(rest, list):
            yield [lift, *rest]


def _through(flight: Flight, stops: list[Pose], path: KeyPath) -> list[MovingLeg] | None:
    """Return the legs from each of some poses to the next."""
    legs: list[MovingLeg] = []
    for a, b in pairwise(stops):
        way = way_to(flight, a, b, path)
        if not isinstance(way, list):
            return None
        legs += way
    return legs


def _at(pose: Pose, height: float) -> Pose:
    """Return a pose moved straight up or down to a height."""
    return (*pose[:2], height, *pose[3:])
