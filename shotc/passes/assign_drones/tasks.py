"""Shots as tasks for the choice of drones: where and when each is filmed."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, dist
from typing import NamedTuple

from shotc.ir.drone import Drone
from shotc.ir.ideal import ideal_place
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.passes import PassContext
from shotc.kinds.base import Kind
from shotc.passes.resolve import Resolve
from shotc.passes.resolve.checks.motion import least_shot, least_travel
from shotc.passes.resolve.lower.names import AUTO
from shotc.spec.load import LoadedMission

SLOWER_RATIO = 2.0
"""Duration of a transfer over its least time, for smooth starts and stops and for obstacles."""


class ShotTask(NamedTuple):
    """One shot.

    number : its index in the mission
    start : seconds, None where it is free
    duration : least duration, seconds
    first, last : where the camera begins and ends
    flown_by : its drone, None where it is open
    drones : of the mission, by name
    """

    number: int
    id: str
    start: float | None
    duration: float
    first: Vec3
    last: Vec3
    flown_by: str | None
    drones: Mapping[str, Drone]

    def travel_time(self, drone: str) -> float:
        """Return the least time from a drone's home to the shot, seconds."""
        return least_travel([self.drones[drone].home, self.first], self.drones[drone].limits)

    def back(self, drone: str) -> float:
        """Return the least time from the shot to a drone's home, seconds."""
        return least_travel([self.last, self.drones[drone].home], self.drones[drone].limits)

    def to(self, other: ShotTask, drone: str) -> float:
        """Return the least time from the end of this shot to the start of another, seconds."""
        return least_travel([self.last, other.first], self.drones[drone].limits)

    def length(self, drone: str) -> float:
        """Return the distance from a drone's home to the shot, metres."""
        return dist(self.drones[drone].home, self.first)


def tasks_of(ir: LoadedMission, kinds: Mapping[str, Kind]) -> tuple[ShotTask, ...] | None:
    """Return every shot as a task; None where one is invalid.

    Each shot is resolved alone, with the first drone where that is open. Its place depends neither on the
    drone nor on obstacles, so scenes and buildings are not read.
    """
    spec = ir.spec
    world = spec.world.model_copy(update={"scene": None, "buildings": None})
    some = next(iter(spec.drones))
    tasks: list[ShotTask] = []
    for i, written in enumerate(spec.shots):
        open_ = written.drone == AUTO
        alone = written.model_copy(update={"drone": some}) if open_ else written
        timing = alone.timing.model_copy(update={"after": None})
        shots = (alone.model_copy(update={"timing": timing}),)
        one = ir._replace(spec=spec.model_copy(update={"shots": shots, "world": world}))
        mission = Resolve(kinds).run(one, PassContext()).value
        if mission is None or not mission.shots:
            return None
        tasks.append(_task(i, mission, mission.shots[0], None if open_ else written.drone))
    return tuple(tasks)


def _task(index: int, mission: MissionIR, shot: Shot, flown_by: str | None) -> ShotTask:
    drones = {drone.name: drone for drone in mission.drones}
    start = shot.timing.start
    if shot.ideal is not None:
        begin = start or 0.0
        duration = shot.timing.duration or 0.0
        first, last = (ideal_place(mission, shot, begin, t) for t in (begin, begin + duration))
    else:
        first, last = shot.keyframes[0].at, shot.keyframes[-1].at
        least = min(least_shot(shot.keyframes, drone.limits) for drone in mission.drones)
        duration = shot.timing.duration or least
    return ShotTask(index, shot.id, start, duration, first, last, flown_by, drones)


def busiest(tasks: tuple[ShotTask, ...]) -> tuple[float, list[ShotTask]]:
    """Return the time at which the most shots with a start are filmed, and these shots."""
    timed = [task for task in tasks if task.start is not None]
    if not timed:
        return 0.0, list(tasks)
    at = {t.start or 0.0: [o for o in timed if (o.start or 0.0) <= (t.start or 0.0) < _end(o)] for t in timed}
    time = max(at, key=lambda t: len(at[t]))
    return time, at[time]


def later(busy: list[ShotTask]) -> str:
    """Return when the last of several shots could start, so that a drone has filmed another one and
    arrived.
    """
    *others, last = sorted(busy, key=lambda task: task.start or 0.0)
    drones = [last.flown_by] if last.flown_by is not None else list(last.drones)
    free = min(_end(task) + SLOWER_RATIO * task.to(last, drone) for task in others for drone in drones)
    return f"start shot `{last.id}` later, by `timing: {{start: {ceil(free)} s}}`"


def _end(task: ShotTask) -> float:
    return (task.start or 0.0) + task.duration
