"""Proves limits and clearances of a motion at every instant by hulls, and checks its camera."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    CameraTask,
    ClockLeg,
    Drone,
    HalfSpaces,
    Surroundings,
    aim_at,
    aims_at,
    wanted_places,
    wrapped,
)
from shotc_casadi.clock.references import ClockSubject

PROVED_M = 1e-6  # metres
ROUNDING_SHARE = 1e-9  # of a limit
AIM_SAMPLES = 200  # number of times at which a camera is compared with its reference


class UnprovedMoment(NamedTuple):
    """A moment at which a motion is not proved: mission time, the constraint, and the lack in ``unit``."""

    time: float
    what: str
    lack: float
    unit: str


def gap_in(
    drone: Drone, around: Surroundings, position: Piecewise, planes: HalfSpaces
) -> UnprovedMoment | None:
    """Return the worst of what the hulls of a motion do not prove, None if they prove all.

    planes : half-spaces that the motion was planned to keep
    """
    lack = around.lacking(position.ctrl, planes)
    k = int(lack.argmax())
    if lack[k] > PROVED_M:
        return UnprovedMoment(float(position.breaks[k]), "the clearances", float(lack[k]), "m")
    limits = drone.limits
    first, second, third = (position.derivative(order).ctrl for order in (1, 2, 3))
    norm = np.linalg.norm
    uses = {
        "speed": (norm(first[:, :, :2] - np.array(limits.wind), axis=2), limits.speed, "m/s"),
        "climb": (first[:, :, 2], limits.climb, "m/s"),
        "descent": (-first[:, :, 2], limits.descent, "m/s"),
        "acceleration": (norm(second, axis=2), limits.usable_acceleration, "m/s^2"),
        "jerk": (norm(third, axis=2), limits.jerk, "m/s^3"),
    }
    worst: UnprovedMoment | None = None
    for what, (points, limit, unit) in uses.items():
        most = points.max(axis=1)
        k = int(most.argmax())
        over = float(most[k]) - limit
        if over > ROUNDING_SHARE * limit and (worst is None or over > worst.lack):
            worst = UnprovedMoment(float(position.breaks[k]), f"the limit of {what}", over, unit)
    return worst


def astray(subject: ClockSubject, leg: ClockLeg) -> float:
    """Return the largest error of the camera angles in the film against their reference, rad."""
    watched, drone, camera_task = subject.watched, subject.drone, subject.camera_task
    if camera_task.keyed is not None:
        return _off(camera_task, leg)
    if watched is None:
        return 0.0
    target = subject.mission.target(watched.target)
    worst = 0.0
    times = np.linspace(leg.start, leg.end, AIM_SAMPLES)
    places = wanted_places(watched, leg.start, times)
    for t, q, (u, v) in zip(times, leg.curve(times), places.tolist(), strict=True):
        ray = np.array(target.at(float(t))) - q[:3]
        aim = aim_at((ray[0], ray[1], ray[2]), (u, v), drone.hfov, drone.aspect, q[CAM_YAW])
        if aim is not None:
            turned = wrapped(q[CAM_YAW] - aim[0])
            worst = max(worst, float(np.hypot(np.cos(aim[1]) * turned, q[CAM_PITCH] - aim[1])))
    return worst


def _off(camera_task: CameraTask, leg: ClockLeg) -> float:
    """Return the largest error of the camera angles in the film against those of its keyframes, rad."""
    times = np.linspace(leg.start, leg.end, AIM_SAMPLES)
    pose = leg.curve(times)
    aims = aims_at(camera_task, times, pose[:, :3])
    turned = np.cos(aims[:, 1]) * wrapped(pose[:, CAM_YAW] - aims[:, 0])
    return float(np.hypot(turned, pose[:, CAM_PITCH] - aims[:, 1]).max())
