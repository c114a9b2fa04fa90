"""The flights of drones on the mission's clock, with the same timing as in the time pass."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.mission import MissionIR
from shotc.ir.path import ClockLeg, PathIR, PathLeg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.timing.flight import TrajectoryBuilder
from shotc.planning.timing.profile import Profile
from shotc.planning.timing.timed_leg import leg_motion

LATE_S = 1e-6  # seconds

Result = TypeVar("Result")


@lru_cache(maxsize=4)  # refiners ask for the same flights repeatedly
def flights(path: PathIR) -> Mapping[str, DroneTrajectory]:
    """Return the flights of the drones of a path on the clock, by name; empty where only one drone flies."""
    return {} if len(path.timed) < 2 else _all(path)


def _all(path: PathIR) -> dict[str, DroneTrajectory]:
    mission, ends = path.keyframes.mission, dict[str, float]()

    def flown_once() -> dict[str, DroneTrajectory]:
        return {flown.drone: flight(mission, flown, ends) for flown in path.timed}

    return settled(flown_once, ends, crosswise(mission, [flown.drone for flown in path.timed]))


def crosswise(mission: MissionIR, order: Sequence[str]) -> bool:
    """Return whether a shot waits for one of a drone that comes later in an order of drones."""
    rank = {name: k for k, name in enumerate(order)}
    owner = {shot.id: shot.drone for shot in mission.shots}
    waits = ((shot.drone, owner.get(shot.timing.after or "", shot.drone)) for shot in mission.shots)
    return any(rank.get(other, -1) > rank.get(own, -1) for own, other in waits)


def settled(once: Callable[[], Result], ends: dict[str, float], again: bool) -> Result:
    """Return what one pass over all drones gives; if ``again``, pass after pass until the ends stay.

    Each pass knows the ends of the one before it. Shots do not wait in a circle, so each pass settles one
    more of them at least.

    ends : mission times at which shots end, by id, seconds, which each pass extends
    """
    result = once()
    for _ in range(len(ends) if again else 0):
        before = dict(ends)
        result = once()
        if ends == before:
            break
    return result


@dataclass(frozen=True, slots=True, eq=False)
class FlownShot:
    """A shot on a path with the timing of the time pass, in a mission with a clock.

    start : mission time of its first frame, seconds
    profile : its path parameter over seconds from the start
    curve : channels CHANNELS over mission time
    """

    start: float
    profile: Profile
    curve: Piecewise

    def times(self, s: Array) -> Array:
        """Return the mission times at which places on the path are first reached; s, times : shape (M,)."""
        return np.array([self.start + self.profile.arrival(float(at)) for at in s])


def flown_shot(path: PathIR, shot: str) -> FlownShot:
    """Return a shot on a path of a drone on the mission's clock, timed.

    Raises KeyError if there is no such shot.
    """
    for flown in path.timed:
        leg = next((leg for leg in flown.legs if leg.shot == shot and isinstance(leg, PathLeg)), None)
        if leg is not None:
            mission = path.keyframes.mission
            motion = leg_motion(mission.drone(flown.drone), leg)
            phase = next(p for p in _all(path)[flown.drone].phases if p.shot == shot)
            assert motion is not None
            over = Piecewise(phase.start + motion.curve.breaks, motion.curve.ctrl)
            return FlownShot(phase.start, motion.profile, over)
    raise KeyError(shot)


def flight(mission: MissionIR, flown: TimedPath, ends: dict[str, float]) -> DroneTrajectory:
    """Return a drone's flight with the timing of the time pass, up to the first shot that it would reach too
    late.

    ends : mission times at which the shots of drones before it end, by id, seconds; its own are added
    """
    drone, builder = mission.drone(flown.drone), TrajectoryBuilder(flown.drone)
    after = {shot.id: shot.timing.after for shot in mission.shots}
    for leg in flown.legs:
        if isinstance(leg, ClockLeg):
            if builder.clock > leg.curve.start + LATE_S:
                break
            builder.wait(float(leg.curve.start), leg.pose)
            builder.film(leg)
            ends[leg.shot] = leg.end
            continue
        motion = leg_motion(drone, leg)
        waited = ends.get(after.get(leg.shot or "") or "", 0.0)
        builder.wait(max(builder.clock, leg.start or 0.0, waited), leg.pose)
        if motion is not None:
            builder.fly(leg, motion)
        if leg.shot is not None:
            ends[leg.shot] = builder.clock
    return builder.trajectory()
