"""The unfilmed legs: take-off, transfers, return and landing; and the sequence of all legs of a drone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, hypot, pi
from typing import TypeVar

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, concatenate
from shotc.geom.bspline import restrict, subdivide
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import (
    BODY_YAW,
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    ClockLeg,
    HoldLeg,
    Leg,
    MovingLeg,
    PathLeg,
    Pose,
    Stop,
)
from shotc.ir.phases import PhaseName
from shotc.planning.free_space import FreeSpace, bounds_slack, breaches
from shotc.planning.obstacles import FreeSpaces, pad_space
from shotc.planning.path.ahead import KEPT_SHARE, CourseBounds, course_of, headed, nearest_ends
from shotc.planning.path.bends import as_clear, bent_ends, bent_starts, over_cone
from shotc.planning.path.body import BodyTask, allowed_body, body_line
from shotc.planning.path.lines import SAME_PLACE_M, TURN_LENGTH_M_RAD
from shotc.planning.path.shots import AngleFailure, Failure, PlannedShot, stack
from shotc.planning.path.transit import transit_curve
from shotc.planning.timing.timed_leg import leg_time
from shotc.solvers.conic import Status

SAME_ANGLE_RAD = 1e-6
ROUNDING_M = 1e-9  # metres
LEG_PIECES = 4

CurveLeg = TypeVar("CurveLeg", MovingLeg, ClockLeg)


@dataclass(frozen=True, slots=True, eq=False)
class LegContext:
    """The data that all unfilmed legs of one drone share.

    top : transit point above the pad, shape (3,)
    look_ahead : as in ``ir.rules``, rad
    """

    drone: Drone
    spaces: FreeSpaces
    top: Array
    look_ahead: float | None

    @property
    def space(self) -> FreeSpace:
        """The free space of all phases."""
        return self.spaces.flight


@dataclass(frozen=True, slots=True, eq=False)
class BlockedWay:
    """Why a transfer is infeasible, and the shot that it leads to; None for the way home."""

    failure: Failure
    shot: PlannedShot | None


def drone_legs(flight: LegContext, shots: list[PlannedShot]) -> tuple[PathLeg, ...] | BlockedWay:
    """Join the shots of one drone with take-off, transits, return and landing."""
    legs: list[PathLeg] = [take_off(flight, shots[0].leg.pose)]
    for shot in shots:
        placed = turned(flight.drone, shot, end_of(legs))
        transfer = way_to(flight, end_of(legs), placed.leg.pose, shot.shot.shot.path)
        if isinstance(transfer, Failure):
            return BlockedWay(transfer, shot)
        legs += transfer
        wound = turns_to(placed.leg.pose, end_of(legs))
        legs.append(turned(flight.drone, placed, end_of(legs)).leg if wound else placed.leg)
    back = way_home(flight, end_of(legs))
    return BlockedWay(back, None) if isinstance(back, Failure) else (*legs, *back)


def take_off(flight: LegContext, goal: Pose) -> MovingLeg:
    """Return the take-off leg from the pad, before a shot that begins at ``goal``."""
    lift = _lift(flight, _at_pad(flight, goal), "takeoff")
    ctrl = lift.curve.ctrl.copy()
    ctrl[-1, -1, :3] = flight.top
    return replace(lift, curve=Piecewise(lift.curve.breaks, ctrl))


def raised(mission: MissionIR, flight: LegContext, metres: float) -> LegContext | None:
    """Return the flight with a higher transit point; None where that is not free."""
    top = flight.top + np.array([0.0, 0.0, metres])
    home, pad = np.array(flight.drone.home), pad_space(mission, flight.drone)
    free = bounds_slack(pad, top[None])[0] >= 0.0 and not breaches(flight.space, top)
    above = (segment_distances(o.part, home[None], top[None])[0] - o.clearance for o in pad.obstacles)
    return replace(flight, top=top) if free and min(above, default=0.0) >= -ROUNDING_M else None


def way_to(flight: LegContext, pose: Pose, goal: Pose, path: KeyPath) -> list[MovingLeg] | Failure:
    """Return the unfilmed leg from a pose to a shot's first pose; empty where they are equal.

    path : key path of the shot
    """
    return _transit(flight, pose, goal, "transit", path)


def way_home(flight: LegContext, pose: Pose) -> list[MovingLeg] | Failure:
    """Return the legs from the end of the last shot to the pad."""
    drone = flight.drone
    level = min(max(0.0, drone.gimbal.pitch[0]), drone.gimbal.pitch[1])
    goal = (*map(float, flight.top), pose[CAM_YAW], level, pose[BODY_YAW], pose[HFOV])
    back = _transit(flight, pose, goal, "return", drone.path)
    if isinstance(back, Failure):
        return back
    pose = end_of(back) if back else pose
    return [*back, _lift(flight, pose, "land")]


def _at_pad(flight: LegContext, first: Pose) -> Pose:
    """Return the pose on the pad, with the heading of the first frame or of the transfer to it."""
    drone = flight.drone
    level = min(max(0.0, drone.gimbal.pitch[0]), drone.gimbal.pitch[1])
    yaw = first[CAM_YAW]
    offset = (first[0] - flight.top[0], first[1] - flight.top[1])
    if flight.look_ahead is not None and hypot(*offset) > 1.0:
        yaw = atan2(offset[1], offset[0])
    heading = atan2(offset[1], offset[0]) if drone.body == "forward" and hypot(*offset) > 1.0 else yaw
    body = yaw if drone.body == "follow-camera" else allowed_body(drone, yaw, heading)
    return (*map(float, drone.home), yaw, level, body, first[HFOV])


def turns_to(goal: Pose, pose: Pose) -> float:
    """Return the whole turns, rad, that bring a goal's camera yaw nearest to a pose's."""
    return 2 * pi * round((pose[CAM_YAW] - goal[CAM_YAW]) / (2 * pi))


def nearest(goal: Pose, pose: Pose) -> Pose:
    """Return the goal with its yaws shifted by whole turns, so that its camera yaw is nearest to a pose's."""
    shift, near = turns_to(goal, pose), list(goal)
    near[CAM_YAW] += shift
    near[BODY_YAW] += shift
    return tuple(near)


def turned(drone: Drone, shot: PlannedShot, pose: Pose) -> PlannedShot:
    """Return a shot with its yaws shifted by whole turns, so that its start is nearest to the last pose."""
    leg = shot.leg
    if isinstance(leg, HoldLeg):
        start = list(nearest(leg.pose, pose))
        if drone.body != "follow-camera":
            heading = pose[BODY_YAW]
            if drone.body == "forward" and hypot(start[0] - pose[0], start[1] - pose[1]) > 1.0:
                heading = atan2(start[1] - pose[1], start[0] - pose[0])
            start[BODY_YAW] = allowed_body(drone, start[CAM_YAW], heading)
        return replace(shot, leg=replace(leg, pose=tuple(start)))
    return replace(shot, leg=turned_leg(leg, pose)) if turns_to(leg.pose, pose) else shot


def turned_leg(leg: CurveLeg, pose: Pose) -> CurveLeg:
    """Return a leg with its yaws shifted by whole turns, so that its start is nearest to a pose."""
    ctrl = leg.curve.ctrl.copy()
    ctrl[:, :, (CAM_YAW, BODY_YAW)] += turns_to(leg.pose, pose)
    return replace(leg, curve=Piecewise(leg.curve.breaks, ctrl))


def _lift(flight: LegContext, pose: Pose, phase: PhaseName) -> MovingLeg:
    home, top = np.array(flight.drone.home), flight.top
    ends = (home, top) if phase == "takeoff" else (top, home)
    x = np.linspace(0.0, 1.0, 6)[:, None]
    ctrl = np.concatenate([(1 - x) * ends[0] + x * ends[1], np.tile(np.array(pose[3:]), (6, 1))], axis=1)
    breaks = np.array([0.0, float(np.linalg.norm(top - home))])
    return _plain(phase, [Piecewise(breaks, ctrl[None])], flight.drone.path)


def _transit(
    flight: LegContext, start: Pose, goal: Pose, phase: PhaseName, path: KeyPath
) -> list[MovingLeg] | Failure:
    """Return the leg from one pose to another; empty where they are equal."""
    a, b = np.array(start[:3]), np.array(goal[:3])
    free_end = phase == "return"
    curves: list[Piecewise] | AngleFailure
    if np.linalg.norm(b - a) < SAME_PLACE_M:
        curves = _turn(flight.drone, start, goal, free_end=free_end)
    else:
        position = transit_curve(flight.spaces, flight.drone, a, b)
        if not isinstance(position, Piecewise):
            return position
        flown = _soonest(flight, position, start, None if free_end else goal)
        if flown is None:
            curve = _with_angles(flight.drone, position, start, goal, free_end=free_end)
            flown = curve if isinstance(curve, AngleFailure) else [curve]
        curves = flown
    if isinstance(curves, AngleFailure):
        return curves
    return [_plain(phase, curves, path)] if curves else []


def _turn(drone: Drone, start: Pose, goal: Pose, *, free_end: bool = False) -> list[Piecewise] | AngleFailure:
    """Return the turn on the spot from one pose to another; empty where they are equal."""
    a, b = np.array(start[:3]), np.array(goal[:3])
    turn = max(abs(p - q) for p, q in zip(start[3:], goal[3:], strict=True))
    if turn < SAME_ANGLE_RAD and np.linalg.norm(b - a) <= ROUNDING_M:
        return []
    breaks = np.array([0.0, TURN_LENGTH_M_RAD * max(turn, SAME_ANGLE_RAD)])
    curve = _with_angles(drone, Piecewise(breaks, np.linspace(a, b, 6)[None]), start, goal, free_end=free_end)
    return curve if isinstance(curve, AngleFailure) else [curve]


def _soonest(
    flight: LegContext, position: Piecewise, start: Pose, goal: Pose | None
) -> list[Piecewise] | AngleFailure | None:
    """Return the fastest transfer that looks ahead: bent at its ends, or with turns on the spot.

    None where the mission does not ask for it, or the transfer has no course.

    position : x, y, z over s
    """
    drone, half_angle = flight.drone, flight.look_ahead
    course = None if half_angle is None else course_of(drone, position, half_angle)
    if half_angle is None or course is None:
        return None
    best = _looking_ahead(drone, (position, course), start, goal)
    if isinstance(best, AngleFailure):
        return best
    least, flown = _seconds(drone, best), position
    for end, pose, bends in ((0, start, bent_starts), (-1, goal, bent_ends)):
        if pose is None:
            continue
        over = over_cone(float(course.yaw[end]), pose[BODY_YAW], KEPT_SHARE * half_angle)
        for bend in bends(flown, over):
            bent = course_of(drone, bend, half_angle) if as_clear(flight.spaces, bend, position) else None
            tried = None if bent is None else _looking_ahead(drone, (bend, bent), start, goal)
            if isinstance(tried, list) and (takes := _seconds(drone, tried)) < least:
                best, least, position = tried, takes, bend
        flown = position
    return best


def _seconds(drone: Drone, curves: list[Piecewise]) -> float:
    return leg_time(drone, _plain("transit", curves, ()))


def _looking_ahead(
    drone: Drone, path: tuple[Piecewise, CourseBounds], start: Pose, goal: Pose | None
) -> list[Piecewise] | AngleFailure:
    """Return a transfer with the body along its course, and the turns on the spot before and after it.

    path : x, y, z over s, and its course
    """
    ends = nearest_ends(path[1], start, goal)
    flown = headed(drone, path[0], ends.course, (ends.first, ends.last))
    if isinstance(flown, Status):
        return AngleFailure("body", flown)
    before = _turn(drone, start, ends.first)
    after = [] if ends.last is None or ends.goal is None else _turn(drone, ends.last, ends.goal)
    if isinstance(before, AngleFailure):
        return before
    return after if isinstance(after, AngleFailure) else [*before, flown, *after]


def _with_angles(
    drone: Drone, position: Piecewise, start: Pose, goal: Pose, *, free_end: bool
) -> Piecewise | AngleFailure:
    """Return a leg whose camera turns linearly in s, with the body yaw of the drone's mode."""
    straight = len(position.breaks) == 2 and (
        drone.body == "follow-camera" or start[BODY_YAW] == goal[BODY_YAW]
    )
    breaks = (
        position.breaks if straight and drone.body != "forward" else subdivide(position.breaks, LEG_PIECES)
    )
    return _stacked(drone, restrict(position, breaks), start, goal, free_end=free_end)


def turned_way(
    drone: Drone, leg: MovingLeg, ends: tuple[Pose, Pose], look_ahead: float | None
) -> MovingLeg | AngleFailure:
    """Return an unfilmed leg with the same positions and other angles; ends : its poses."""
    position, (start, goal) = leg.curve.channels(0, 1, 2), ends
    course = None if look_ahead is None else course_of(drone, position, look_ahead)
    if course is not None:
        headed_curve = headed(drone, position, course.wound(start[BODY_YAW]), ends)
        return (
            AngleFailure("body", headed_curve)
            if isinstance(headed_curve, Status)
            else replace(leg, curve=headed_curve)
        )
    if len(position.breaks) == 2:
        position = restrict(position, subdivide(position.breaks, LEG_PIECES))
    curve = _stacked(drone, position, start, goal, free_end=False)
    return curve if isinstance(curve, AngleFailure) else replace(leg, curve=curve)


def _stacked(
    drone: Drone, position: Piecewise, start: Pose, goal: Pose, *, free_end: bool
) -> Piecewise | AngleFailure:
    """Return a position curve with a camera that turns linearly in s, and the body yaw for it."""
    breaks = position.breaks
    camera = restrict(_even(position, start, goal), breaks)
    yaw = camera.channels(0)
    end = None if free_end else goal[BODY_YAW]
    task = BodyTask(position, yaw, start[BODY_YAW], end, drone.limits.speed)
    status, body = body_line(drone, task)
    if status not in {Status.SOLVED, Status.INACCURATE}:
        return AngleFailure("body", status)
    whole = stack(position, camera.channels(0, 1), body, camera.channels(2))
    ctrl = whole.ctrl.copy()
    ctrl[0, 0] = start
    ctrl[-1, -1, : 5 if free_end else 7] = goal[: 5 if free_end else 7]
    return Piecewise(breaks, ctrl)


def _even(position: Piecewise, start: Pose, goal: Pose) -> Piecewise:
    """Return yaw and pitch linear in s, and a field of view that rests at both ends; one piece."""
    x = np.linspace(0.0, 1.0, 6)
    step = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    ctrl = [start[k] + (goal[k] - start[k]) * (step if k == HFOV else x) for k in (CAM_YAW, CAM_PITCH, HFOV)]
    return Piecewise(np.array([position.start, position.end]), np.stack(ctrl, axis=1)[None])


def _plain(phase: PhaseName, curves: Sequence[Piecewise], path: KeyPath) -> MovingLeg:
    """Return the unfilmed leg along curves that begin at 0; the drone rests between them."""
    ends = np.cumsum([0.0, *(curve.end for curve in curves)])
    curve = concatenate([Piecewise(c.breaks + s, c.ctrl) for c, s in zip(curves, ends, strict=False)])
    stops = tuple(Stop(float(s), 0.0) for s in ends)
    return MovingLeg(phase, None, curve, stops, (), (), 1.0, None, None, path)


def end_of(legs: Sequence[Leg]) -> Pose:
    """Return the end pose of the last leg."""
    return legs[-1].end_pose
