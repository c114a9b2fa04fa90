"""Where a flight leaves its plan for a reason: a subject is too fast, or receivers mislead the drone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.bodies import centres
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from shotc.simulation.flight import DroneRuns
from shotc.simulation.sensors import within
from shotc.simulation.situations import Anew, Chased, replanned
from shotc.simulation.world import World, at_times

SAMPLE_S = 0.2
"""Seconds between the samples of a shot."""

SPEED_S = 1.0
"""Seconds over which the speed of a subject is averaged."""

LEFT_RATIO = 0.5
"""Additional distance over the planned one, above which a drone has fallen behind: the subject has two thirds
of its planned size on screen.
"""

RETURNING_S = 20.0
"""Seconds after a shot or an outage in which a drone's stray is no error of its receiver."""

RECEIVER_SHARE = 0.5
"""Share of a stray, above which the receiver's error is its main cause."""

LEAST_STRAY_M = 0.5
"""Metres, up to which a stray is never reported, whatever clearance a mission needs: corrected positions
are within 0.1 m.
"""


@dataclass(frozen=True, slots=True)
class Lag:
    """How far a drone falls behind its subject in a replanned shot, in one run.

    behind : largest distance from the subject beyond the planned one, metres
    planned : the planned distance at that time, metres
    time : seconds
    speed, most : the subject's speed, and the drone's limit over ground in that direction, m/s, at the
        instant until then at which the subject exceeds the limit most, or comes closest to it
    """

    shot: str
    drone: str
    target: str
    behind: float
    planned: float
    time: float
    speed: float
    most: float

    @property
    def left(self) -> bool:
        """Whether the drone has fallen behind."""
        return self.behind > LEFT_RATIO * self.planned

    @property
    def outrun(self) -> bool:
        """Whether the subject is faster than the drone."""
        return self.speed > self.most


@dataclass(frozen=True, slots=True)
class LargestDeviation:
    """The largest of a drone's distances in one run.

    metres : 0 if there is none that counts
    time : seconds
    """

    metres: float = 0.0
    time: float = 0.0


def lags(world: World, track: DroneTrajectory, flown: DroneRuns) -> list[tuple[Lag, ...]]:
    """Return for every run how far a drone falls behind in each replanned shot; () without replanning."""
    shots = replanned(world.mission, track) if world.conditions.loop == "replan" else ()
    lags_of_shots = [
        list(_lags(world, track, flown, (shot.phase, name)))
        for shot in shots
        for name in _moving(world, shot)
    ]
    return [tuple(each[r] for each in lags_of_shots) for r in range(len(world.runs))]


def misled(world: World, track: DroneTrajectory, flown: DroneRuns, astray: Array) -> list[LargestDeviation]:
    """Return for every run the largest stray of a drone that is mainly its receiver's error.

    Replanned shots, flight without positions, and the ways back from both leave the plan on purpose, so they
    do not count.

    astray : the drone's strays, (F, R), metres
    """
    counts = np.linalg.norm(flown.error, axis=2) >= RECEIVER_SHARE * astray
    counts &= _on_plan(world, track, flown.times)[:, None]
    return _peaks(np.where(counts, astray, 0.0), flown.times)


def unplaced(world: World, track: DroneTrajectory, flown: DroneRuns) -> list[LargestDeviation]:
    """Return for every run the largest error of a drone's own position while it has none by satellites."""
    lost, times = world.conditions.lost(flown.drone), flown.times
    aboard = np.array([within(t, lost) and t <= track.curve.end for t in times.tolist()], dtype=bool)
    return _peaks(np.linalg.norm(flown.error, axis=2) * aboard[:, None], times)


def needed(mission: MissionIR) -> float:
    """Return the least clearance that a mission needs of its drones, at least LEAST_STRAY_M, metres.

    A drone that is farther off its plan can touch what the plan is proved to be clear of.
    """
    rules = mission.rules
    clearances = [rules.ground_clearance]
    clearances += [rules.target_clearance] if mission.targets else []
    clearances += [rules.obstacle_clearance] if mission.meshes else []
    clearances += [rules.separation] if len(mission.drones) > 1 else []
    return max(LEAST_STRAY_M, min(clearances))


def _peaks(off: Array, times: Array) -> list[LargestDeviation]:
    """Return the largest distance of every run; off : (F, R), metres, at times (F,)."""
    worst = np.argmax(off, axis=0)
    return [LargestDeviation(float(off[k, r]), float(times[k])) for r, k in enumerate(worst.tolist())]


def _moving(world: World, shot: Anew) -> tuple[str, ...]:
    names = (shot.target,) if isinstance(shot, Chased) else tuple(each.target for each in shot.subjects)
    return tuple(name for name in names if world.moves(name))


def _lags(world: World, track: DroneTrajectory, flown: DroneRuns, of: tuple[Phase, str]) -> Iterator[Lag]:
    """Yield the lag of every run; ``of`` is the phase of the shot and the subject's name."""
    phase, name = of
    times = np.arange(phase.start, phase.end, SAMPLE_S)
    really = world.places[name]
    course = centres(world.mission.target(name), times)
    planned = np.linalg.norm(track.curve(times)[:, :3] - course, axis=1)
    here = at_times(really, world.times, times)
    there = at_times(flown.position, flown.times, times) - here
    behind = np.linalg.norm(there, axis=2) - planned[:, None]
    moved = here - at_times(really, world.times, times - SPEED_S)
    velocity = moved[..., :2] / SPEED_S
    along = world.mission.drone(flown.drone).limits.speed_along
    for r in range(len(world.runs)):
        k = int(np.argmax(behind[:, r]))
        speeds = np.hypot(*velocity[: k + 1, r].T)
        most = np.array([along(east, north) for east, north in velocity[: k + 1, r].tolist()])
        i = int(np.argmax(speeds - most))
        yield Lag(
            shot=str(phase.shot),
            drone=flown.drone,
            target=name,
            behind=float(behind[k, r]),
            planned=float(planned[k]),
            time=float(times[k]),
            speed=float(speeds[i]),
            most=float(most[i]),
        )


def _on_plan(world: World, track: DroneTrajectory, times: Array) -> Array:
    """Return at which of times (M,) a drone follows its plan, (M,)."""
    inside = np.ones(len(times), dtype=bool)
    for start, end in world.conditions.lost(track.drone):
        inside &= (times < start) | (times > end + RETURNING_S)
    if world.conditions.loop == "replan":
        for shot in replanned(world.mission, track):
            inside &= (times < shot.phase.start) | (times > shot.phase.end + RETURNING_S)
    return inside
