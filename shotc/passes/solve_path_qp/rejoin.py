"""Refined shots put back into a path: the body turned anew, the unfilmed legs led to the new ends.

What a refiner hands back is where the camera is and where it looks; the rest of the path follows from
that, so no refiner has to plan transits or bodies.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import restrict
from shotc.ir.mission import Drone
from shotc.ir.path import BODY_YAW, HFOV, DronePath, Leg, PathIR
from shotc.passes.corridor.room import flight_room, pad_room
from shotc.passes.solve_path_qp.body import BodyTask, body_line
from shotc.passes.solve_path_qp.legs import Flight, drone_legs
from shotc.passes.solve_path_qp.pad import PadBlocked, transit_point
from shotc.passes.solve_path_qp.shots import ShotCurve, stack
from shotc.solvers.conic import Status

SAME_END = 1e-9


class NoTransit(Exception):
    """A refined shot has no body or no way to it; the text says what cannot be kept."""


def rejoined(path: PathIR, cameras: Mapping[str, Piecewise]) -> PathIR:
    """Return the path with some shots' cameras replaced.

    cameras : by shot id, curves of x, y, z, cam_yaw, cam_pitch over the leg's own s, quintic, C2, on
        breaks that hold those of the leg
    Legs whose ends stay the same keep the unfilmed legs around them. NoTransit where there is no way
    to a new end; ValueError where a curve does not cover its leg.
    """
    return replace(path, drones=tuple(_drone(path, drone, cameras) for drone in path.drones))


def _drone(path: PathIR, flown: DronePath, cameras: Mapping[str, Piecewise]) -> DronePath:
    if not any(leg.shot in cameras for leg in flown.legs):
        return flown
    drone = path.keyframes.mission.drone(flown.drone)
    legs = [
        leg if leg.shot not in cameras else with_camera(drone, leg, cameras[leg.shot or ""])
        for leg in flown.legs
    ]
    if all(_same_ends(a, b) for a, b in zip(flown.legs, legs, strict=True)):
        return replace(flown, legs=tuple(legs))
    return replace(flown, legs=_led_anew(path, drone, legs))


def with_camera(drone: Drone, leg: Leg, camera: Piecewise) -> Leg:
    """Return a shot's leg with another camera (see ``rejoined``), and the body that goes with it."""
    old = leg.curve
    if old is None or abs(camera.start - old.start) > SAME_END or abs(camera.end - old.end) > SAME_END:
        raise ValueError(f"the camera of shot {leg.shot} does not cover its leg")
    kept = _same(old.ctrl[0, 0, :5], camera.ctrl[0, 0]) and _same(old.ctrl[-1, -1, :5], camera.ctrl[-1, -1])
    body = _body(drone, leg, camera, old) if kept else None
    kept = body is not None
    body = body or _body(drone, leg, camera, None)
    if body is None:
        raise NoTransit("the gimbal's yaw range")
    curve = stack(camera, body, restrict(old.channels(HFOV), camera.breaks))
    if kept:
        # Fits are good to 1e-9; joints are to be equal.
        ctrl = curve.ctrl.copy()
        ctrl[0, 0], ctrl[-1, -1] = old.ctrl[0, 0], old.ctrl[-1, -1]
        curve = Piecewise(curve.breaks, ctrl)
    return replace(leg, curve=curve, pose=tuple(map(float, curve.ctrl[0, 0])))


def _body(drone: Drone, leg: Leg, camera: Piecewise, ends: Piecewise | None) -> Piecewise | None:
    """Return the body's yaw, with the ends of an earlier curve if there is one; None without a solution."""
    start, end = (None, None) if ends is None else ends.ctrl[[0, -1], [0, -1], BODY_YAW].tolist()
    task = BodyTask(camera.channels(0, 1, 2), camera.channels(3), start, end, leg.pace * drone.limits.speed)
    status, body = body_line(drone, task)
    return body if status in {Status.SOLVED, Status.INACCURATE} else None


def _led_anew(path: PathIR, drone: Drone, legs: list[Leg]) -> tuple[Leg, ...]:
    mission = path.keyframes.mission
    room = flight_room(mission, drone)
    top = transit_point(room, pad_room(mission, drone), drone)
    assert not isinstance(top, PadBlocked), "it was free when the path was first planned"
    placed = {p.shot.id: p for p in path.keyframes.shots}
    shots = [
        ShotCurve(placed[leg.shot], leg.curve, leg.pose, leg.stops, leg.marks, leg.framing, (), (), None, ())
        for leg in legs
        if leg.shot is not None
    ]
    joined = drone_legs(Flight(drone, room, top), shots)
    if isinstance(joined[0], Leg):
        return joined
    before = joined[1]
    raise NoTransit("a way home" if before is None else f"a way to shot `{before.shot.shot.id}`")


def _same_ends(old: Leg, new: Leg) -> bool:
    if old.curve is None or new.curve is None:
        return old is new
    return old is new or (
        _same(old.curve.ctrl[0, 0], new.curve.ctrl[0, 0])
        and _same(old.curve.ctrl[-1, -1], new.curve.ctrl[-1, -1])
    )


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.abs(a - b).max() < SAME_END)
