"""Shots as tasks for the choice of drones: where and when each is filmed, and which drones can film it."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, dist
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.ir.drone import Drone
from shotc.ir.ideal import ideal_place
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.kinds.base import Kind
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.resolve import Resolve
from shotc.passes.resolve.checks.motion import least_shot, least_travel
from shotc.passes.resolve.lower.names import AUTO
from shotc.spec.load import LoadedMission

SLOWER_RATIO = 2.0
"""Duration of a transfer over its least time, for smooth starts and stops and for obstacles."""


class ShotAlone(NamedTuple):
    """A shot by itself.

    mission : with this shot alone; None where it is invalid with this drone
    fault : the first error of the shot with this drone, None where the drone can film it as it is asked
    """

    mission: MissionIR | None
    fault: Diagnostic | None


def alone(ir: LoadedMission, kinds: Mapping[str, Kind], number: int, drone: str) -> ShotAlone:
    """Return one shot by itself, flown by a drone.

    The lens, the gimbal and the limits of the drone decide whether the shot resolves and whether its pictures
    can be placed. Obstacles that take long to read, scenes and buildings, are left out.
    """
    written = ir.spec.shots[number]
    timing = written.timing.model_copy(update={"after": None})
    shots = (written.model_copy(update={"drone": drone, "timing": timing}),)
    world = ir.spec.world.model_copy(update={"scene": None, "buildings": None})
    one = ir._replace(spec=ir.spec.model_copy(update={"shots": shots, "world": world}))
    resolved = Resolve(kinds).run(one, PassContext())
    mission = resolved.value
    if mission is None or not mission.shots:
        return ShotAlone(None, _error(resolved.diagnostics))
    return ShotAlone(mission, _error(PlaceKeyframes().run(mission, PassContext()).diagnostics))


def _error(diagnostics: tuple[Diagnostic, ...]) -> Diagnostic | None:
    return next((d for d in diagnostics if severity_of(d) is Severity.ERROR), None)


class CameraEnds(NamedTuple):
    """Where the camera of a shot begins and ends, W, metres."""

    first: Vec3
    last: Vec3


class ShotTask(NamedTuple):
    """One shot.

    number : its index in the mission
    start : seconds, None where it is free
    duration : least duration, seconds
    ends : where the camera begins and ends, by drone
    flown_by : its drone, None where it is open
    drones : of the mission, by name
    refused : why a drone cannot film it as it is asked, by drone; empty where all can, or none
    """

    number: int
    id: str
    start: float | None
    duration: float
    ends: Mapping[str, CameraEnds]
    flown_by: str | None
    drones: Mapping[str, Drone]
    refused: Mapping[str, Diagnostic]

    def travel_time(self, drone: str) -> float:
        """Return the least time from a drone's home to the shot, seconds."""
        return least_travel([self.drones[drone].home, self.ends[drone].first], self.drones[drone].limits)

    def back(self, drone: str) -> float:
        """Return the least time from the shot to a drone's home, seconds."""
        return least_travel([self.ends[drone].last, self.drones[drone].home], self.drones[drone].limits)

    def to(self, other: ShotTask, drone: str) -> float:
        """Return the least time from the end of this shot to the start of another, seconds."""
        return least_travel([self.ends[drone].last, other.ends[drone].first], self.drones[drone].limits)

    def length(self, drone: str) -> float:
        """Return the distance from a drone's home to the shot, metres."""
        return dist(self.drones[drone].home, self.ends[drone].first)


def tasks_of(ir: LoadedMission, kinds: Mapping[str, Kind]) -> tuple[ShotTask, ...] | None:
    """Return every shot as a task; None where one is invalid with every drone that may film it."""
    tasks: list[ShotTask] = []
    for number, written in enumerate(ir.spec.shots):
        open_ = written.drone == AUTO
        drones = tuple(ir.spec.drones) if open_ else (written.drone,)
        alone_by = {drone: alone(ir, kinds, number, drone) for drone in drones}
        resolved = {drone: one.mission for drone, one in alone_by.items() if one.mission is not None}
        if not resolved:
            return None
        mission = next(iter(resolved.values()))
        ends = dict.fromkeys(ir.spec.drones, _ends(mission))
        ends |= {drone: _ends(own) for drone, own in resolved.items()}
        refused = {drone: one.fault for drone, one in alone_by.items() if one.fault is not None}
        if len(refused) == len(drones):
            refused = {}
        tasks.append(_task(number, mission, ends, None if open_ else written.drone, refused))
    return tuple(tasks)


def _ends(mission: MissionIR) -> CameraEnds:
    shot = mission.shots[0]
    if shot.ideal is None:
        return CameraEnds(shot.keyframes[0].at, shot.keyframes[-1].at)
    begin = shot.timing.start or 0.0
    end = begin + (shot.timing.duration or 0.0)
    return CameraEnds(ideal_place(mission, shot, begin, begin), ideal_place(mission, shot, begin, end))


def _task(
    index: int,
    mission: MissionIR,
    ends: Mapping[str, CameraEnds],
    flown_by: str | None,
    refused: Mapping[str, Diagnostic],
) -> ShotTask:
    shot, drones = mission.shots[0], {drone.name: drone for drone in mission.drones}
    duration = shot.timing.duration
    if shot.ideal is None and not duration:
        duration = min(least_shot(shot.keyframes, drone.limits) for drone in mission.drones)
    return ShotTask(index, shot.id, shot.timing.start, duration or 0.0, ends, flown_by, drones, refused)


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
