"""A drone's verified trajectory as samples, divided into the stretches that a flight plan must keep.

A stretch is a part of one phase between take-off and landing, either moving or at rest. Waypoints stand at
its two ends, and thinning chooses those in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise
from shotc.geom.framing import Cameras, optical_axes
from shotc.ir.bodies import moved
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import UPRIGHT
from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

SAMPLE_STEP_S = 0.1  # seconds; at 10 m/s and 3 m/s^2 the curve deviates from its samples' chords by 4 mm
REST_SPREAD_M = 1e-4  # metres, extent of the control points of a piece that stands still
SHORTEST_REST_S = 0.25  # seconds; a shorter standstill is a turning point of the motion, not a hold
BEHIND_CAMERA_HALF_FRAMES = 9.0  # half frames, the screen error of a subject behind the re-flown camera
FAR_M = 1e4  # metres to the point straight ahead that is watched where nothing is framed


@dataclass(frozen=True, slots=True)
class SampleRange:
    """Samples ``first`` to ``last`` of one phase; ``rest`` if the drone stands still."""

    first: int
    last: int
    shot: str | None
    rest: bool


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Camera poses: position (n, 3) in W, metres; angles and field of view (n,), rad."""

    position: Array
    body_yaw: Array
    cam_yaw: Array
    cam_pitch: Array
    hfov: Array


@dataclass(frozen=True, slots=True, eq=False)
class SampledFlight:
    """Samples of one drone's flight from the end of take-off to the start of landing.

    time : (n,), seconds
    subject : watched point in W at each sample, metres, (n, 3)
    """

    time: Array
    poses: Poses
    subject: Array
    stretches: tuple[SampleRange, ...]


def poses_at(flight: DroneTrajectory, time: Array) -> Poses:
    """Return the planned camera poses at mission times (n,), seconds."""
    value = flight.curve(time)
    return Poses(value[:, :3], value[:, BODY_YAW], value[:, CAM_YAW], value[:, CAM_PITCH], value[:, HFOV])


def track_of(mission: MissionIR, flight: DroneTrajectory) -> SampledFlight:
    """Return the samples of a drone's flight between take-off and landing."""
    spans = _spans(flight)
    begin = spans[0].start if spans else flight.phases[0].end
    times: list[Array] = [np.array([begin])]
    stretches: list[SampleRange] = []
    first = 0
    for start, end, shot, rest in spans:
        count = max(2, ceil((end - start) / SAMPLE_STEP_S))
        times.append(np.linspace(start, end, count + 1)[1:])
        stretches.append(SampleRange(first, first + count, shot, rest))
        first += count
    time = np.concatenate(times)
    poses = poses_at(flight, time)
    return SampledFlight(time, poses, subject_at(mission, flight, time, poses), tuple(stretches))


def subject_at(mission: MissionIR, flight: DroneTrajectory, time: Array, poses: Poses) -> Array:
    """Return the watched point at each time, (n, 3), metres: the framed target's centre, else
    straight ahead.
    """
    subject: Array = poses.position + FAR_M * optical_axes(poses.cam_yaw, poses.cam_pitch)
    for span in flight.framing:
        inside = (time >= span.start) & (time <= span.end)
        filmed = mission.target(span.target)
        subject[inside] = filmed.centre + moved(filmed, time[inside])
    return subject


def project(poses: Poses, subject: Array, drone: Drone) -> Array:
    """Return the screen position (u, v) of points (n, 3) seen from poses (n,), shape (n, 2); NaN behind the
    camera.
    """
    camera = Cameras(poses.position, poses.cam_yaw, poses.cam_pitch, poses.hfov, drone.aspect).view
    right, down, forward = camera.to_camera(tuple((subject - poses.position).T))
    depth = np.where(forward > 0, forward, np.nan) * camera.half_width
    return np.stack([right / depth, -down * drone.aspect / depth], axis=1)


def select(poses: Poses, part: NDArray[np.bool_] | NDArray[np.int64] | slice) -> Poses:
    """Return some of the poses."""
    return Poses(
        poses.position[part],
        poses.body_yaw[part],
        poses.cam_yaw[part],
        poses.cam_pitch[part],
        poses.hfov[part],
    )


class _FlightSpan(NamedTuple):
    """A part of a flight: start and end, seconds, its shot, and whether the drone stands all the time."""

    start: float
    end: float
    shot: str | None
    rests: bool


def _spans(flight: DroneTrajectory) -> list[_FlightSpan]:
    rests = _rests(flight.curve)
    spans: list[_FlightSpan] = []
    for phase in flight.phases:
        if phase.name in UPRIGHT:
            continue
        inside = [(max(a, phase.start), min(b, phase.end)) for a, b in rests]
        inside = [(a, b) for a, b in inside if b - a >= SHORTEST_REST_S]
        cuts = sorted({phase.start, phase.end, *(t for pair in inside for t in pair)})
        spans.extend(_FlightSpan(a, b, phase.shot, (a, b) in inside) for a, b in pairwise(cuts))
    return spans


def _rests(curve: Piecewise) -> list[tuple[float, float]]:
    spread = np.ptp(curve.ctrl[:, :, :3], axis=1).max(axis=1)
    rests: list[tuple[float, float]] = []
    for still, (start, end) in zip(spread <= REST_SPREAD_M, pairwise(curve.breaks.tolist()), strict=True):
        if still and rests and rests[-1][1] == start:
            rests[-1] = (rests[-1][0], end)
        elif still:
            rests.append((start, end))
    return rests
