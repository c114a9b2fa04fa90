"""Transfers on which the body heads along the course, within the half-angle of ``rules.look_ahead``.

The body yaw over s is a spline near the course and inside the cone about it. It begins and ends as near as
the cone allows to the headings of the shots before and after. The drone makes the rest of each turn at rest,
before or after the transfer. The camera turns with the body; its pan angle changes linearly from its value at
one end to that at the other. ``filmed_ahead`` does the same for shots.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict, spline, subdivide
from shotc.ir.drone import Drone
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV, Pose
from shotc.ir.rules import SLOW_M_S
from shotc.planning.path.body import FAINT_WEIGHT, UPRIGHT_SLOPE
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import Fit, fit

PIECE_FACTORS = (4, 8, 16, 32)  # pieces for each piece of the position curve
MOST_HALVINGS = 12  # halvings of pieces on which the course turns by much of the cone
SAMPLES_PER_PIECE = 4
KEPT_SHARE = 0.97  # share of the half-angle that is used, because the course is sampled
ANY_RAD = 1e3  # rad, bounds of the yaw where there is no course


class CourseBounds(NamedTuple):
    """The course of a transfer over s, and the bounds of a yaw in the cone about it.

    breaks : shape (P + 1,)
    at, yaw : samples of s and of the course, shape (M,), unwrapped
    moves : whether there is a course at each sample, shape (M,)
    low, high : bounds of the yaw on each piece, shape (P,), rad
    """

    breaks: Array
    at: Array
    yaw: Array
    moves: Array
    low: Array
    high: Array

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Bounds of the yaw at the start and at the end."""
        return (float(self.low[0]), float(self.high[0])), (float(self.low[-1]), float(self.high[-1]))

    def wound(self, near: float) -> CourseBounds:
        """Return the course shifted by whole turns, so that it begins nearest to a yaw."""
        low, high = self.ends[0]
        turns = 2 * pi * round((near - 0.5 * (low + high)) / (2 * pi))
        return self._replace(yaw=self.yaw + turns, low=self.low + turns, high=self.high + turns)


def course_of(drone: Drone, position: Piecewise, half_angle: float) -> CourseBounds | None:
    """Return the course of a position curve, x, y, z over s.

    None if the curve is vertical, or if its corners leave no yaw in the cone.
    """
    for finer in PIECE_FACTORS:
        course = _sampled(drone, position, half_angle, subdivide(position.breaks, finer))
        if course is None or (course.low < course.high).all():
            return course
    return None


def finer_course(drone: Drone, position: Piecewise, half_angle: float, width: float) -> CourseBounds | None:
    """Return the course on pieces so short that the bounds are at least ``width`` apart, rad; None as there.

    Where the curve reverses, its course turns within a short part of its length.
    """
    breaks = subdivide(position.breaks, PIECE_FACTORS[0])
    for _ in range(MOST_HALVINGS):
        course = _sampled(drone, position, half_angle, breaks)
        if course is None:
            return None
        tight = course.high - course.low < width
        if not tight.any():
            return course
        breaks = np.union1d(breaks, 0.5 * (breaks[:-1] + breaks[1:])[tight])
    return None


def _sampled(drone: Drone, position: Piecewise, half_angle: float, breaks: Array) -> CourseBounds | None:
    """Return the course on given pieces, whose bounds may be empty; None if there is no course."""
    share = np.linspace(0.0, 1.0, SAMPLES_PER_PIECE + 1)
    at = breaks[:-1, None] + np.diff(breaks)[:, None] * share
    rate = position.derivative()(at.ravel())
    moves = _moves(drone, rate)
    if not moves.any():
        return None
    known = np.flatnonzero(moves)
    yaw = np.interp(np.arange(len(rate)), known, np.unwrap(np.arctan2(rate[known, 1], rate[known, 0])))
    each, there = yaw.reshape(at.shape), moves.reshape(at.shape).any(axis=1)
    low = np.where(there, each.max(axis=1) - KEPT_SHARE * half_angle, -ANY_RAD)
    high = np.where(there, each.min(axis=1) + KEPT_SHARE * half_angle, ANY_RAD)
    return CourseBounds(breaks, at.ravel(), yaw, moves, low, high)


def _moves(drone: Drone, rate: Array) -> Array:
    """Return where a drone may be fast enough over ground to have a course, (M,).

    Climb and descent rates are limited, so that the drone is slow over ground on a steep path.

    rate : derivative of its position over s, (M, 3)
    """
    level, rise = np.linalg.norm(rate[:, :2], axis=1), rate[:, 2]
    fastest = np.where(rise > 0.0, drone.limits.climb, drone.limits.descent)
    return np.asarray(level > np.maximum(UPRIGHT_SLOPE, KEPT_SHARE * SLOW_M_S * np.abs(rise) / fastest))


def headed(
    drone: Drone, position: Piecewise, course: CourseBounds, ends: tuple[Pose, Pose | None]
) -> Piecewise | Status:
    """Return all channels of a transfer whose body heads along its course, or the solver's status.

    ends : poses at the start and at the end; without the latter the body yaw is free there, and the camera
        keeps its angle relative to the body
    """
    start, goal = ends
    breaks = course.breaks
    anchors = [(breaks[0], start[BODY_YAW])] + ([] if goal is None else [(breaks[-1], goal[BODY_YAW])])
    line = near_course(drone, course, course.yaw, anchors)
    if isinstance(line, Status):
        return line
    body = line.ctrl[:, :, 0]
    last = start if goal is None else goal
    x = np.linspace(0.0, 1.0, 6)
    step = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    pan = start[CAM_YAW] - start[BODY_YAW], last[CAM_YAW] - last[BODY_YAW]
    level = min(max(0.0, drone.gimbal.pitch[0]), drone.gimbal.pitch[1])
    pitch = start[CAM_PITCH], level if goal is None else goal[CAM_PITCH]
    even = np.stack(
        [
            pan[0] + (pan[1] - pan[0]) * x,
            pitch[0] + (pitch[1] - pitch[0]) * x,
            start[HFOV] + (last[HFOV] - start[HFOV]) * step,
        ],
        axis=1,
    )
    camera = restrict(Piecewise(np.array([breaks[0], breaks[-1]]), even[None]), breaks).ctrl
    place = restrict(position, breaks).ctrl
    ctrl = np.concatenate(
        [place, (body + camera[:, :, 0])[:, :, None], camera[:, :, 1:2], body[:, :, None], camera[:, :, 2:]],
        axis=2,
    )
    ctrl[0, 0] = start
    if goal is not None:
        ctrl[-1, -1] = goal
    return Piecewise(breaks, ctrl)


def near_course(
    drone: Drone, course: CourseBounds, wish: Array, anchors: Sequence[tuple[float, float]]
) -> Piecewise | Status:
    """Return a yaw in the cone about a course, one channel on its breaks, or the solver's status.

    wish : reference of the yaw at the course's samples, shape (M,)
    anchors : pairs (s, yaw) that it passes
    """
    breaks, points = course.breaks, (len(course.breaks) - 1, 6)
    long = float(breaks[-1] - breaks[0])
    length = min(max(0.5 * drone.limits.speed / drone.limits.yaw_rate, 1e-3), long)
    weight = (np.where(course.moves, 1.0, 0.0) + FAINT_WEIGHT) * long / len(course.at)
    bound = np.array(anchors, dtype=np.float64).reshape(-1, 2)
    status, coef = fit(
        Fit(
            breaks,
            course.at,
            wish,
            weight,
            bound[:, 0],
            bound[:, 1],
            (FAINT_WEIGHT * length**2, length**6),
            np.broadcast_to(course.low[:, None], points),
            np.broadcast_to(course.high[:, None], points),
        )
    )
    return spline(breaks, coef[:, None]) if status in {Status.SOLVED, Status.INACCURATE} else status


class TransferEnds(NamedTuple):
    """The poses in which a transfer from one pose to another begins and ends; None without a goal.

    course : unwrapped to the start's winding
    first, last : with body yaws as near to the given ones as the cone allows
    goal : the given one, shifted by whole turns to the end of the transfer
    """

    course: CourseBounds
    first: Pose
    last: Pose | None
    goal: Pose | None


def nearest_ends(course: CourseBounds, start: Pose, goal: Pose | None) -> TransferEnds:
    """Return the ends of a transfer along a course."""
    wound = course.wound(start[BODY_YAW])
    first, last = wound.ends
    first_pose = _turned(start, min(max(start[BODY_YAW], first[0]), first[1]))
    if goal is None:
        return TransferEnds(wound, first_pose, None, None)
    turns = 2 * pi * round((0.5 * (last[0] + last[1]) - goal[BODY_YAW]) / (2 * pi))
    wound_goal = tuple(c + turns if k in (CAM_YAW, BODY_YAW) else c for k, c in enumerate(goal))
    return TransferEnds(
        wound,
        first_pose,
        _turned(wound_goal, min(max(wound_goal[BODY_YAW], last[0]), last[1])),
        wound_goal,
    )


def _turned(pose: Pose, body: float) -> Pose:
    """Return a pose with another body yaw, and the camera turned with it."""
    angles = list(pose)
    angles[BODY_YAW], angles[CAM_YAW] = body, pose[CAM_YAW] + body - pose[BODY_YAW]
    return tuple(angles)
