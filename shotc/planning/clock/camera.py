"""Camera angles and body yaw over mission time: near the subjects, within the limits of gimbal and body."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import (
    SplineFunctionals,
    count,
    energy_rows,
    hull_rows,
    spline,
    value_rows,
)
from shotc.geom.vec import Vec2
from shotc.ir.drone import Drone
from shotc.planning.clock.aims import CameraTask, aims_at
from shotc.planning.clock.bounds import NEARLY_SHARE, held_ends, with_ends
from shotc.planning.clock.clock import Clock
from shotc.planning.clock.position import UNSEEN_WEIGHT
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import Goal, HalfSpaceRows, SplineProblem
from shotc.solvers.spline_qp import minimise

SAMPLES_PER_PIECE = 4  # samples of the camera angles
FAINT_WEIGHT = 1e-2  # weight of the references outside the film, over that in the film
SMOOTH_S = (0.12, 0.12, 0.6)
"""Seconds below which movements of camera yaw, camera pitch and body yaw vanish, with normal smoothing."""
FOLLOW_WEIGHT = 0.05  # weight of the body's reference, over that of the camera's
LEVEL_M_S = 0.5  # m/s of horizontal speed, below which a motion has no course
UNIT_RAD2_S = 1e-4  # rad^2 s, unit of the cost in the solver
YAW, PITCH, BODY = range(3)


@dataclass(frozen=True, slots=True, eq=False)
class CameraAngles:
    """Camera yaw, camera pitch and body yaw over mission time; or None, and the solver's status."""

    curve: Piecewise | None
    status: Status


@dataclass(frozen=True, slots=True, eq=False)
class AngleTask:
    """The task of finding a camera's angles along a position curve.

    kept : (yaw, pitch) that the camera keeps, rad; None where it follows the subjects
    course : reference (yaw, pitch) at times (M,), shape (M, 2), unwrapped, where a refiner has found them
        already
    begin, end : camera yaw, camera pitch and body yaw at the start and at the end, with their rates and
        accelerations, shape (3, 3), SI; None for rest at any angles
    """

    camera_task: CameraTask
    kept: Vec2 | None = None
    begin: Array | None = None
    end: Array | None = None
    course: Callable[[Array], Array] | None = None


def turn(angle_task: AngleTask, clock: Clock, position: Piecewise) -> CameraAngles:
    """Return the angles along a position curve, by one convex programme."""
    drone = angle_task.camera_task.drone
    breaks = clock.breaks
    inner = (np.arange(SAMPLES_PER_PIECE) + 0.5) / SAMPLES_PER_PIECE
    times = (breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel()
    rows = value_rows(breaks, times)
    aims = _aims(angle_task, times, position)
    step = np.diff(breaks)[rows.piece] / SAMPLES_PER_PIECE
    filmed = np.where(clock.filmed[rows.piece], 1.0, FAINT_WEIGHT) * step
    across = np.maximum(np.cos(aims[:, 1]), 0.03)
    reference = np.column_stack([aims, _course(drone, aims[:, 0], times, position)])
    weight = np.column_stack([filmed * across**2, filmed, FOLLOW_WEIGHT * step])
    goals = _goals(rows, np.sqrt(weight), reference) + _smooth(clock, angle_task.camera_task.smoother)
    ends = angle_task.begin, angle_task.end
    problem = SplineProblem(count(breaks), goals, held_ends(breaks, *ends), _bounds(drone, breaks), ())
    solved = minimise(problem, UNIT_RAD2_S)
    if solved.coef is None:
        return CameraAngles(None, solved.status)
    coef = with_ends(breaks, solved.coef, *ends)
    if drone.body == "follow-camera":
        coef[:, BODY] = coef[:, YAW]
    return CameraAngles(spline(breaks, coef), solved.status)


def _aims(angle_task: AngleTask, times: Array, position: Piecewise) -> Array:
    """Return the reference yaw and pitch of the camera, unwrapped; shape (M, 2)."""
    if angle_task.kept is not None:
        return np.tile(np.array(angle_task.kept), (len(times), 1))
    if angle_task.course is not None:
        return angle_task.course(times)
    if not angle_task.camera_task.watches:
        yaw = _motion(position.derivative()(times)[:, :2])
        return np.column_stack([_wound(angle_task, yaw), np.zeros(len(times))])
    angles = aims_at(angle_task.camera_task, times, position(times)[:, :3])
    low, high = angle_task.camera_task.drone.gimbal.pitch
    return np.column_stack([_wound(angle_task, np.unwrap(angles[:, 0])), np.clip(angles[:, 1], low, high)])


def _wound(angle_task: AngleTask, yaw: Array) -> Array:
    """Return a yaw moved by whole turns to be nearest to the given start angle, if there is one."""
    if angle_task.begin is None:
        return yaw
    return np.asarray(yaw + 2 * np.pi * np.round((angle_task.begin[0, YAW] - yaw[0]) / (2 * np.pi)))


def _course(drone: Drone, yaw: Array, times: Array, position: Piecewise) -> Array:
    """Return the reference of the body's yaw, from which the gimbal reaches the camera's yaw."""
    if drone.body != "forward":
        return yaw
    course = _motion(position.derivative()(times)[:, :2])
    low, high = drone.gimbal.yaw
    relative = np.unwrap(yaw - course)
    # The median decides, because the course of a slow motion at its ends is arbitrary.
    relative -= 2 * np.pi * np.round((np.median(relative) - 0.5 * (low + high)) / (2 * np.pi))
    return np.asarray(yaw - np.clip(relative, low, high))


def _motion(velocity: Array) -> Array:
    """Return the course of a motion, unwrapped; where it hardly moves, interpolated from the times at which
    it does.
    """
    moves = np.flatnonzero(np.linalg.norm(velocity, axis=1) >= LEVEL_M_S)
    if not len(moves):
        return np.full(len(velocity), np.pi / 2)
    course = np.unwrap(np.arctan2(velocity[moves, 1], velocity[moves, 0]))
    return np.asarray(np.interp(np.arange(len(velocity)), moves, course))


def _goals(rows: SplineFunctionals, root: Array, reference: Array) -> tuple[Goal, ...]:
    """Return one least-squares term a channel, weighted by the squares of ``root``, shape (M, 3)."""
    goals = []
    for channel in range(3):
        value = np.zeros_like(reference)
        value[:, channel] = root[:, channel] * reference[:, channel]
        goals.append(Goal(_scaled(rows, root[:, channel]), value, (channel,)))
    return tuple(goals)


def _smooth(clock: Clock, smoother: float) -> tuple[Goal, ...]:
    energy = energy_rows(clock.breaks, 3)
    none = np.zeros((len(energy.piece), 3))
    gentle = np.where(clock.filmed, smoother**3, sqrt(UNSEEN_WEIGHT))[energy.piece]
    return tuple(Goal(_scaled(energy, s**3 * gentle), none, (c,)) for c, s in enumerate(SMOOTH_S))


def _bounds(drone: Drone, breaks: Array) -> tuple[HalfSpaceRows, ...]:
    """Return the ranges, rates and accelerations of gimbal and body as half-spaces of control points."""
    limits, gimbal = drone.limits, drone.gimbal
    half_spaces = []

    def keep(order: int, along: tuple[float, float, float], low: float, high: float) -> None:
        rows = hull_rows(breaks, order)
        number = len(rows.piece)
        normal = np.tile(np.array(along), (number, 1))
        owner = np.zeros(number, dtype=np.intp)
        half_spaces.append(HalfSpaceRows(rows, normal, np.full(number, low), owner))
        half_spaces.append(HalfSpaceRows(rows, -normal, np.full(number, -high), owner))

    keep(0, (0.0, 1.0, 0.0), *gimbal.pitch)
    for order, body, axis in (
        (1, limits.yaw_rate, gimbal.rate),
        (2, limits.yaw_acceleration, gimbal.acceleration),
    ):
        keep(order, (0.0, 1.0, 0.0), -NEARLY_SHARE * axis, NEARLY_SHARE * axis)
        if drone.body == "follow-camera":
            keep(order, (1.0, 0.0, 0.0), -NEARLY_SHARE * body, NEARLY_SHARE * body)
            continue
        keep(order, (0.0, 0.0, 1.0), -NEARLY_SHARE * body, NEARLY_SHARE * body)
        keep(order, (1.0, 0.0, -1.0), -NEARLY_SHARE * axis, NEARLY_SHARE * axis)
    if drone.body != "follow-camera":
        keep(0, (1.0, 0.0, -1.0), *gimbal.yaw)
    return tuple(half_spaces)


def _scaled(rows: SplineFunctionals, factor: Array) -> SplineFunctionals:
    return SplineFunctionals(rows.piece, rows.weight * factor[:, None])
