"""Shots on a path that keep the heading near the course, where ``rules.look_ahead`` asks for it.

If the camera looks along its path (``ir.ahead.looks_along``), camera and body are moved into the cone about
the course. If the camera films something, it stays as it is, and the body below it is kept in the cone if the
gimbal range allows this along the whole shot. Otherwise the rule is neither planned nor verified.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.geom.vec import wrapped
from shotc.ir.ahead import looks_along
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR, Shot
from shotc.planning.path.ahead import KEPT_SHARE, CourseBounds, finer_course, near_course
from shotc.planning.path.body import BodyTask, body_line
from shotc.solvers.conic import Status

YAW_CHANNEL = 0
ROUNDING_RAD = 1e-9
ROOM_SHARES = (0.3, 0.6, 0.8)
"""Least width of the yaw bounds over the cone's opening; larger ones are tried if smaller ones fail."""


class Ahead(NamedTuple):
    """The look-ahead constraint of a shot.

    half_angle : of the cone about the course, rad
    along : whether its camera looks along its path
    """

    half_angle: float
    along: bool


class Faced(NamedTuple):
    """A shot's camera (channels yaw, pitch and more) and its body yaw, on the breaks of its position."""

    position: Piecewise
    camera: Piecewise
    body: Piecewise


def ahead_in(mission: MissionIR, shot: Shot) -> Ahead | None:
    """Return the look-ahead constraint of a shot; None where the mission has none."""
    half_angle = mission.rules.look_ahead
    return None if half_angle is None else Ahead(half_angle, looks_along(shot))


def faced(drone: Drone, ahead: Ahead, task: BodyTask, camera: Piecewise) -> Faced | None:
    """Return a shot whose body heads along the course throughout; None where its framing prevents that.

    camera : yaw, pitch and further channels on the task's breaks; its yaw is the task's
    """
    if drone.body == "follow-camera" and not ahead.along:
        return None
    for share in ROOM_SHARES:
        course = finer_course(drone, task.position, ahead.half_angle, 2 * share * ahead.half_angle)
        if course is None:
            return None
        course = course.wound(float(task.cam_yaw.ctrl[0, 0, 0]))
        position, same = restrict(task.position, course.breaks), restrict(camera, course.breaks)
        turned = _along(drone, ahead, course, same) if ahead.along else same
        cone = None if turned is None else _cone(drone, course, turned)
        if turned is None or cone is None:
            continue
        within = BodyTask(position, turned.channels(YAW_CHANNEL), task.start, task.end, task.speed, cone)
        status, body = body_line(drone, within)
        if status in {Status.SOLVED, Status.INACCURATE}:
            return Faced(position, turned, body)
    return None


def _along(drone: Drone, ahead: Ahead, course: CourseBounds, camera: Piecewise) -> Piecewise | None:
    """Return the camera moved into the cone about its course, unless it is there; None if infeasible."""
    yaw = camera.ctrl[:, :, YAW_CHANNEL]
    if (yaw >= course.low[:, None]).all() and (yaw <= course.high[:, None]).all():
        return camera
    off = wrapped(camera(course.at)[:, YAW_CHANNEL] - course.yaw)
    most = KEPT_SHARE * ahead.half_angle
    line = near_course(drone, course, course.yaw + np.clip(off, -most, most), ())
    if isinstance(line, Status):
        return None
    return Piecewise(course.breaks, np.concatenate([line.ctrl, camera.ctrl[:, :, 1:]], axis=2))


def _cone(drone: Drone, course: CourseBounds, camera: Piecewise) -> tuple[Array, Array] | None:
    """Return the bounds of the body yaw on each piece, (P,), rad; None where the gimbal prevents any."""
    yaw = camera.ctrl[:, :, YAW_CHANNEL]
    if drone.body == "follow-camera":
        low, high = yaw.max(axis=1), yaw.min(axis=1)
        inside = (low <= course.high + ROUNDING_RAD).all() and (high >= course.low - ROUNDING_RAD).all()
        return (course.low, course.high) if inside else None
    least, most = drone.gimbal.yaw
    offset = np.median(
        0.5 * (yaw.min(axis=1) + yaw.max(axis=1)) - course.yaw.reshape(len(yaw), -1).mean(axis=1)
    )
    turns = 2 * pi * round((offset - 0.5 * (least + most)) / (2 * pi))
    low = np.maximum(course.low + turns, yaw.max(axis=1) - most)
    high = np.minimum(course.high + turns, yaw.min(axis=1) - least)
    return (course.low + turns, course.high + turns) if (low < high).all() else None
