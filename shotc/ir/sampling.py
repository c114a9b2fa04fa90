"""Samples of a plan at the ticks of its output clock: phase, subjects, and the camera's view of them.

Verification and the tables use the same samples, so that the written values are those that were judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.framing import Cameras, Frames, frames
from shotc.geom.pieces import Mask
from shotc.geom.track_array import rate_seen_from, seen_from
from shotc.ir.bodies import moved, shapes
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import hiders
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory

SAME_TIME_S = 1e-9
"""Tolerance within which a tick is on a boundary, seconds."""


def clock(rate: float, end: float) -> Array:
    """Return the ticks k / rate from 0 to the first one at or after ``end``, (M,), seconds; rate : Hz."""
    return np.arange(ceil((end - SAME_TIME_S) * rate) + 1) / rate


def ticks(rate: float, start: float, end: float) -> Array:
    """Return two times, seconds, and the ticks k / rate between them, (M,)."""
    times = clock(rate, end)
    inside = times[(times > start + SAME_TIME_S) & (times < end - SAME_TIME_S)]
    return np.concatenate([[start], inside, [end]])


def ticks_inside(rate: float, start: float, end: float) -> Array:
    """Return the ticks k / rate that lie between two times, seconds, without these, (M,)."""
    times = clock(rate, end)
    return times[(times > start) & (times < end)]


def share_of_frames(good: Mask, counted: Mask) -> float:
    """Return the share of samples that are good, shape (M,), 0 to 1.

    A sample that is not counted lowers the share if it is bad, and does not raise it if it is good. So nobody
    raises the share by samples at times of their choice.

    counted : whether a sample is a frame or an end of its shot, shape (M,)
    """
    used = counted | ~good
    return float(good[used].mean()) if used.any() else 1.0


def phase_index(phases: tuple[Phase, ...], t: Array) -> NDArray[np.intp]:
    """Return the index of the phase at times t (M,), shape (M,).

    A boundary belongs to the phase that starts there.
    """
    starts = np.array([phase.start for phase in phases[1:]])
    return np.asarray(np.searchsorted(starts, t + SAME_TIME_S, side="right"))


def subjects(mission: MissionIR, drone: DroneTrajectory, shot: str) -> tuple[str, ...]:
    """Return the targets that a shot frames, in the order of their first framing, then the shot's own."""
    own = tuple(s.subject for s in mission.shots if s.id == shot and s.subject is not None)
    return tuple(dict.fromkeys([*(f.target for f in drone.framing if f.shot == shot), *own]))


def framed(drone: DroneTrajectory, shot: str, target: str, t: Array) -> Mask:
    """Return whether the shot frames the target at times t (M,), shape (M,)."""
    inside = np.zeros(len(t), dtype=bool)
    for span in drone.framing:
        if span.shot == shot and span.target == target:
            inside |= (t >= span.start - SAME_TIME_S) & (t <= span.end + SAME_TIME_S)
    return inside


def references(drone: DroneTrajectory, shot: str, target: str, t: Array) -> Array:
    """Return the reference (u, v) of the target at times t (M,), shape (M, 2); NaN where there is none."""
    reference_uv = np.full((len(t), 2), np.nan)
    for span in drone.framing:
        if span.shot == shot and span.target == target and span.reference is not None:
            inside = (t >= span.start - SAME_TIME_S) & (t <= span.end + SAME_TIME_S)
            reference_uv[inside] = span.reference(t[inside])
    return reference_uv


def projected(mission: MissionIR, drone: DroneTrajectory, target: str, t: Array) -> Frames:
    """Return the drone's view of a target at times t, shape (M,), without occlusion."""
    filmed = mission.target(target)
    still = beside_cameras(cameras(mission, drone, t), filmed, t)
    return frames(still, filmed.centre, shapes(filmed, t))


def seen(
    mission: MissionIR,
    drone: DroneTrajectory,
    target: str,
    t: Array,
    others: Sequence[DroneTrajectory] = (),
) -> Frames:
    """Return the drone's view of a target at times t, shape (M,), with the times at which it is hidden.

    others : flights of the other drones, which may hide it
    """
    eyes, covered = drone.curve(t)[:, :3], np.zeros(len(t), dtype=bool)
    for _, hides in hiders(mission, others, target, eyes, t):
        covered |= hides
    return replace(projected(mission, drone, target, t), hidden=covered)


def beside_cameras(eyes: Cameras, target: Target, t: Array) -> Cameras:
    """Return cameras at times (M,) relative to the target, for a target that stands at its centre."""
    return replace(eyes, position=eyes.position - moved(target, t))


def beside(curve: Piecewise, target: Target) -> Piecewise:
    """Return a curve of channels x, y, z over mission time, relative to the target's centre."""
    if target.track is None:
        return curve
    seen_by = seen_from(curve, target.track)
    return Piecewise(seen_by.breaks, seen_by.ctrl + np.array(target.centre))


def rate_beside(curve: Piecewise, target: Target) -> Piecewise:
    """Return the exact derivative of ``beside``: the velocity relative to the target."""
    return curve.derivative() if target.track is None else rate_seen_from(curve, target.track)


def cameras(mission: MissionIR, drone: DroneTrajectory, t: Array) -> Cameras:
    """Return the drone's camera at the given times, shape (M,)."""
    pose, aspect = drone.curve(t), mission.drone(drone.drone).aspect
    return Cameras(pose[:, :3], pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], aspect)
