"""A plan at the ticks of its output clock: which phase, which subjects, what the camera sees.

Verification and the tables read the same samples, so that what is written is what was judged.
"""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.framing import Cameras, Frames, frames
from shotc.geom.pieces import Mask
from shotc.geom.solids import Cylinder, Solid
from shotc.ir.mission import MissionIR, Target
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import DroneTrajectory, Phase

SAME_TIME = 1e-9
"""Seconds within which a tick counts as being on a boundary."""


def clock(rate: float, end: float) -> Array:
    """Return the ticks k / rate from 0 to the first one at or after ``end``, seconds."""
    return np.arange(ceil((end - SAME_TIME) * rate) + 1) / rate


def phase_index(phases: tuple[Phase, ...], t: Array) -> NDArray[np.intp]:
    """Return the index of the phase at each time; a boundary belongs to the phase that begins there."""
    starts = np.array([phase.start for phase in phases[1:]])
    return np.asarray(np.searchsorted(starts, t + SAME_TIME, side="right"))


def subjects(mission: MissionIR, drone: DroneTrajectory, shot: str) -> tuple[str, ...]:
    """Return the targets that a shot frames, in the order of their first framing, then the shot's own."""
    own = tuple(s.subject for s in mission.shots if s.id == shot and s.subject is not None)
    return tuple(dict.fromkeys([*(f.target for f in drone.framing if f.shot == shot), *own]))


def framed(drone: DroneTrajectory, shot: str, target: str, t: Array) -> Mask:
    """Tell at which times the shot frames the target."""
    inside = np.zeros(len(t), dtype=bool)
    for span in drone.framing:
        if span.shot == shot and span.target == target:
            inside |= (t >= span.start - SAME_TIME) & (t <= span.end + SAME_TIME)
    return inside


def references(drone: DroneTrajectory, shot: str, target: str, t: Array) -> Array:
    """Return the (u, v) that is wanted of the target at each time, shape (M, 2), NaN where none is."""
    wanted = np.full((len(t), 2), np.nan)
    for span in drone.framing:
        if span.shot == shot and span.target == target and span.reference is not None:
            inside = (t >= span.start - SAME_TIME) & (t <= span.end + SAME_TIME)
            wanted[inside] = span.reference(t[inside])
    return wanted


def seen(mission: MissionIR, drone: DroneTrajectory, target: str, t: Array) -> Frames:
    """Look through the drone's camera at a target at the given times, shape (M,)."""
    return frames(cameras(mission, drone, t), cylinder(mission.target(target)), hiding(mission, target))


def cameras(mission: MissionIR, drone: DroneTrajectory, t: Array) -> Cameras:
    """Return the drone's camera at the given times, shape (M,)."""
    pose, aspect = drone.curve(t), mission.drone(drone.drone).aspect
    return Cameras(pose[:, :3], pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], aspect)


def cylinder(target: Target) -> Cylinder:
    """Return the target as a solid."""
    x, y, z = target.centre
    return Cylinder((x, y), target.radius, z - target.height / 2, z + target.height / 2)


def hiding(mission: MissionIR, target: str) -> tuple[Solid, ...]:
    """Return what may stand before a target: the other targets and the keep-out zones."""
    others = tuple(cylinder(t) for t in mission.targets if t.name != target)
    return others + tuple(zone.solid for zone in mission.zones if zone.keep == "out")
