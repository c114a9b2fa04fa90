"""Compares a re-flight with the plan: the error that a waypoint file adds to position, heading
and picture.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.clearance import Obstacle, shortfall
from shotc.emit.waypoints.lens import edge
from shotc.emit.waypoints.reflown import STAY_PACE_M_S, ReflownSamples
from shotc.emit.waypoints.track import BEHIND_CAMERA_HALF_FRAMES, Poses, poses_at, project, subject_at
from shotc.geom.vec import wrapped
from shotc.ir.bodies import moved
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT
from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

SEARCH_M = 3.0  # metres of progress before and after the expected one, in which the nearest point is sought
CHUNK_POINTS = 256  # planned points compared in one batch, to bound memory
ORDER_WEIGHT = 1e-3  # weight of a metre of wrong progress over that of a metre of distance


@dataclass(frozen=True, slots=True)
class ShotError:
    """The error that a file adds to one shot.

    worst, mean : screen error, half frames
    time : mission time of the worst frame, seconds
    lag : largest difference in time between plan and re-flight, seconds, counted from the shot's first frame
    drift : largest motion of the framed target during the lag of a frame, metres
    edge : largest shift of the picture's edge by the lens, half frames
    """

    shot: str
    worst: float
    time: float
    mean: float
    lag: float
    drift: float
    edge: float = 0.0


@dataclass(frozen=True, slots=True)
class Error:
    """The error that a file adds: metres, rad, (u, v) units.

    shot, time : where the screen error is largest
    filmed, planned : seconds filmed in the re-flight and in the plan
    """

    position: float
    heading: float
    screen: float
    shot: str
    time: float
    filmed: float
    planned: float
    shots: tuple[ShotError, ...] = ()

    @property
    def edge(self) -> float:
        """Largest shift of the picture's edge by the lens, half frames."""
        return max((each.edge for each in self.shots), default=0.0)


class _MatchedPoses(NamedTuple):
    """Re-flown poses matched to planned ones.

    time : mission times of the planned poses, seconds
    elapsed : times of the re-flown poses, seconds
    """

    time: Array
    poses: Poses
    elapsed: Array


def compare(mission: MissionIR, flight: DroneTrajectory, flown: ReflownSamples, most: float = inf) -> Error:
    """Return the error of a re-flight against the plan at the output rate, matched by progress and not by
    time.

    most : highest rate that is needed, Hz
    """
    rate = min(mission.rate, most)
    position = heading = filmed = planned = 0.0
    shots: list[ShotError] = []
    for part in _parts(flight):
        shot, inside = part.shot, flown.part == part.number
        time = _frames(part.start, part.end, rate)
        if not inside.any() or not len(time):
            continue
        plan = poses_at(flight, time)
        met = _meet(plan, time, flown, inside)
        position = max(position, float(np.linalg.norm(met.poses.position - plan.position, axis=1).max()))
        if shot is None:
            continue
        heading = max(heading, float(np.abs(wrapped(met.poses.body_yaw - plan.body_yaw)).max()))
        shots.append(_shot_error(mission, flight, shot, plan, met))
        filmed += float(np.ptp(flown.elapsed[inside]))
        planned += part.end - part.start
    # Of two equally bad frames, the later one is named.
    worst = max(reversed(shots), key=lambda s: s.worst, default=ShotError("", 0.0, 0.0, 0.0, 0.0, 0.0))
    return Error(position, heading, worst.worst, worst.shot, worst.time, filmed, planned, tuple(shots))


def _shot_error(
    mission: MissionIR, flight: DroneTrajectory, shot: str, plan: Poses, met: _MatchedPoses
) -> ShotError:
    time = met.time
    shift = _shift(mission, flight, time, plan, met.poses, mission.drone(flight.drone))
    index = int(shift.argmax())
    late = met.elapsed - met.elapsed[0] - (time - time[0])
    drift = 0.0
    for span in (s for s in flight.framing if s.shot == shot):
        filmed = mission.target(span.target)
        displacement = moved(filmed, time + late) - moved(filmed, time)
        drift = max(drift, float(np.linalg.norm(displacement, axis=1).max()))
    lag = float(np.abs(late).max())
    off = float(edge(plan.hfov, met.poses.hfov).max())
    return ShotError(shot, float(shift[index]), float(time[index]), float(shift.mean()), lag, drift, off)


def nearest_miss(obstacles: tuple[Obstacle, ...], flown: ReflownSamples) -> tuple[str, float]:
    """Return the obstacle with the largest violation of its clearance, and the violation, metres; else ("",
    0).
    """
    if not len(flown.position):
        return ("", 0.0)
    cuts = ((float(shortfall(o, flown.position).max()), str(o.owner)) for o in obstacles)
    depth, name = max(cuts, default=(0.0, ""))
    return (name, depth) if depth > 0 else ("", 0.0)


class _Recording(NamedTuple):
    """What is flown between a start and a stop of recording; number : as in the re-flight; shot : None for a
    transit.
    """

    number: int
    shot: str | None
    start: float
    end: float


def _parts(flight: DroneTrajectory) -> list[_Recording]:
    """Return the parts of a flight, between starts and stops of recording."""
    parts: list[_Recording] = []
    number, shot = 0, None
    for phase in flight.phases:
        if phase.name in UPRIGHT:
            continue
        if phase.shot != shot:
            number += 1 if shot is None or phase.shot is None else 2
        elif parts:
            parts[-1] = parts[-1]._replace(number=number, end=phase.end)
            continue
        shot = phase.shot
        parts.append(_Recording(number, phase.shot, phase.start, phase.end))
    return parts


def _frames(start: float, end: float, rate: float) -> Array:
    return np.arange(ceil(start * rate - 1e-6), floor(end * rate + 1e-6) + 1) / rate


def _meet(plan: Poses, time: Array, flown: ReflownSamples, inside: NDArray[np.bool_]) -> _MatchedPoses:
    """Return the poses of a re-flight nearest to the planned ones, in order of progress."""
    position = flown.position[inside]
    progress = flown.progress[inside] - flown.progress[inside][0]
    flown_m = _progress(plan.position, time)
    total = flown_m[-1] if flown_m[-1] > 0 else 1.0
    expected = flown_m * (progress[-1] / total)
    index, share = _nearest(plan.position, expected, position, progress)
    yaw = [np.unwrap(a[inside]) for a in (flown.body_yaw, flown.cam_yaw)]
    after = np.minimum(index + 1, len(position) - 1)

    def mix(values: Array) -> Array:
        weight = share if values.ndim == 1 else share[:, None]
        return np.asarray(values[index] + weight * (values[after] - values[index]))

    hfov = mix(flown.hfov[inside])
    hfov = np.where(np.isnan(hfov), plan.hfov, hfov)
    poses = Poses(mix(position), mix(yaw[0]), mix(yaw[1]), mix(flown.cam_pitch[inside]), hfov)
    return _MatchedPoses(time, poses, mix(flown.elapsed[inside]))


def _progress(position: Array, time: Array) -> Array:
    steps = np.linalg.norm(np.diff(position, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(np.maximum(steps, STAY_PACE_M_S * np.diff(time)))])


def _nearest(points: Array, expected: Array, position: Array, progress: Array) -> tuple[Array, Array]:
    """Return the nearest point of the flown line near the ``expected`` progress: segment index and share on
    it.
    """
    if len(position) == 1:
        return np.zeros(len(points), dtype=int), np.zeros(len(points))
    chunks = [
        _nearest_of(points[i : i + CHUNK_POINTS], expected[i : i + CHUNK_POINTS], position, progress)
        for i in range(0, len(points), CHUNK_POINTS)
    ]
    return np.concatenate([c[0] for c in chunks]), np.concatenate([c[1] for c in chunks])


def _nearest_of(points: Array, expected: Array, position: Array, progress: Array) -> tuple[Array, Array]:
    low = np.searchsorted(progress, expected - SEARCH_M)
    high = np.searchsorted(progress, expected + SEARCH_M, side="right")
    width = max(1, int((high - low).max()))
    window = np.clip(low[:, None] + np.arange(width), 0, len(position) - 2)
    start = position[window]
    span = position[window + 1] - start
    offset = points[:, None, :] - start
    length2 = np.einsum("nwk,nwk->nw", span, span)
    along = np.einsum("nwk,nwk->nw", offset, span)
    share = np.clip(np.where(length2 > 0, along / np.where(length2 > 0, length2, 1.0), 0.0), 0.0, 1.0)
    miss = offset - share[..., None] * span
    lag = progress[window] + share * (progress[window + 1] - progress[window]) - expected[:, None]
    cost = np.einsum("nwk,nwk->nw", miss, miss) + (ORDER_WEIGHT * lag) ** 2
    best = cost.argmin(axis=1)
    rows = np.arange(len(points))
    return np.asarray(window[rows, best]), np.asarray(share[rows, best])


def _shift(
    mission: MissionIR, flight: DroneTrajectory, time: Array, plan: Poses, met: Poses, drone: Drone
) -> Array:
    subject = subject_at(mission, flight, time, plan)
    meant = project(plan, subject, drone)
    shift = np.hypot(*(project(met, subject, drone) - meant).T)
    return np.where(np.isnan(meant[:, 0]), 0.0, np.nan_to_num(shift, nan=BEHIND_CAMERA_HALF_FRAMES))
