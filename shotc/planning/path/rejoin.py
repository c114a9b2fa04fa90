"""Put refined shots back into a path: new body yaw for them, and unfilmed legs to their new ends.

A refiner returns the position and the angles of the camera. The rest of the path follows from these, so that
no refiner has to plan transfers or body yaw. Refined shots of a drone on the mission's clock keep their
durations, because other drones, and shots that wait for these, are planned beside the convex legs. Where
their camera angles at the ends differ, the unfilmed legs next to them keep their positions and durations and
get new angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import DronePath, HoldLeg, MovingLeg, PathIR, PathLeg, Pose, TimedPath
from shotc.planning.obstacles import free_spaces_of, pad_space
from shotc.planning.path.filmed_ahead import ahead_in
from shotc.planning.path.legs import BlockedWay, LegContext, drone_legs, end_of, turned_way
from shotc.planning.path.pad import PadBlocked, transit_point
from shotc.planning.path.shots import AngleFailure, PlannedShot
from shotc.planning.path.with_camera import SAME_END_TOLERANCE, NoTransit, same, with_camera
from shotc.planning.timing.timed_leg import lateness, leg_time


def rejoined(path: PathIR, cameras: Mapping[str, Piecewise]) -> PathIR:
    """Return the path with the cameras of some shots replaced.

    Where the ends of legs stay the same, the unfilmed legs around them stay as they are. Drones on the
    mission's clock keep the duration of every leg (see ``in_time``).

    cameras : by shot id, curves of x, y, z, cam_yaw, cam_pitch over the leg's own s, quintic, C2, on breaks
        that contain those of the leg; a sixth channel replaces the leg's field of view

    Raises NoTransit if there is no transfer to a new end, or none in time. Raises ValueError if a curve does
    not cover its leg.
    """
    return replace(
        path,
        drones=tuple(_drone(path, drone, cameras) for drone in path.drones),
        timed=tuple(in_time(path.keyframes.mission, flown, cameras) for flown in path.timed),
    )


def _drone(path: PathIR, flown: DronePath, cameras: Mapping[str, Piecewise]) -> DronePath:
    if not any(leg.shot in cameras for leg in flown.legs):
        return flown
    mission = path.keyframes.mission
    drone = mission.drone(flown.drone)
    legs = [
        leg
        if leg.shot not in cameras
        else with_camera(drone, leg, cameras[leg.shot or ""], ahead_in(mission, mission.shot(leg.shot)))
        for leg in flown.legs
    ]
    if all(_same_ends(a, b) for a, b in zip(flown.legs, legs, strict=True)):
        return replace(flown, legs=tuple(legs))
    return replace(flown, legs=_led_anew(path, drone, legs))


def _led_anew(path: PathIR, drone: Drone, legs: list[PathLeg]) -> tuple[PathLeg, ...]:
    mission = path.keyframes.mission
    spaces = free_spaces_of(mission, drone)
    top = transit_point(spaces.flight, pad_space(mission, drone), drone)
    assert not isinstance(top, PadBlocked), "it was free when the path was first planned"
    placed = {p.shot.id: p for p in path.keyframes.shots}
    shots = [
        PlannedShot(placed[leg.shot], leg, (), (), None, ()).lasting(None)
        for leg in legs
        if leg.shot is not None
    ]
    joined = drone_legs(LegContext(drone, spaces, top, mission.rules.look_ahead), shots)
    if not isinstance(joined, BlockedWay):
        return joined
    before = joined.shot
    raise NoTransit("a way home" if before is None else f"a way to shot `{before.shot.shot.id}`")


def _same_ends(old: PathLeg, new: PathLeg) -> bool:
    if isinstance(old, HoldLeg) or isinstance(new, HoldLeg):
        return old is new
    return old is new or (
        same(old.curve.ctrl[0, 0], new.curve.ctrl[0, 0])
        and same(old.curve.ctrl[-1, -1], new.curve.ctrl[-1, -1])
    )


def in_time(mission: MissionIR, flown: TimedPath, cameras: Mapping[str, Piecewise]) -> TimedPath:
    """Return a drone's legs with the cameras of some shots replaced, each leg with its old duration.

    cameras : as in ``rejoined``

    Raises NoTransit if a leg is infeasible in its duration, or if it does not join the next one.
    """
    if not any(isinstance(leg, MovingLeg) and leg.shot in cameras for leg in flown.legs):
        return flown
    drone, legs = mission.drone(flown.drone), list(flown.legs)
    for k, leg in enumerate(legs):
        if isinstance(leg, MovingLeg) and leg.shot in cameras:
            ahead = ahead_in(mission, mission.shot(leg.shot))
            legs[k] = lasting(drone, leg, with_camera(drone, leg, cameras[leg.shot or ""], ahead))
    for k, leg in enumerate(legs):
        if isinstance(leg, MovingLeg) and leg.phase in {"transit", "return"}:
            start = end_of(legs[: k or 1])
            goal = legs[k + 1].pose
            legs[k] = _led(mission, drone, leg, (start, goal))
    for a, b in pairwise(legs):
        if not _same(end_of([a]), b.pose):
            raise NoTransit("its ends where the next leg joins them")
    return replace(flown, legs=tuple(legs))


def lasting(drone: Drone, old: MovingLeg, new: MovingLeg) -> MovingLeg:
    """Return a new leg with the duration of an old one.

    Raises NoTransit if the new leg takes longer within the share of the limits that it may use.
    """
    duration = leg_time(drone, old)
    leg = new.given(duration) if old.duration is None else replace(new, duration=old.duration, most=old.most)
    if lateness(drone, leg) > 0.0:
        whose = "the way" if old.shot is None else "its convex path"
        least = leg_time(drone, replace(new, duration=None, pace=leg.most))
        limits = "full limits" if leg.most == 1.0 else f"{leg.most:.4g} of the limits"
        more = f", for it takes {least:.3f} s at {limits}" if least > duration else ""
        needs = leg_time(drone, replace(new, duration=None))
        raise NoTransit(f"the {duration:.3f} s of {whose}{more}", needs if old.shot is not None else None)
    return leg


def _led(mission: MissionIR, drone: Drone, leg: MovingLeg, ends: tuple[Pose, Pose]) -> MovingLeg:
    """Return an unfilmed leg between two poses that differ from its own in their angles only."""
    if _same(leg.pose, ends[0]) and _same(end_of([leg]), ends[1]):
        return leg
    turned = turned_way(drone, leg, ends, mission.rules.look_ahead)
    if isinstance(turned, AngleFailure):
        raise NoTransit("the body's turn on the way beside it")
    return lasting(drone, leg, turned)


def _same(a: Pose, b: Pose) -> bool:
    return bool(np.abs(np.array(a) - np.array(b)).max() < SAME_END_TOLERANCE)
