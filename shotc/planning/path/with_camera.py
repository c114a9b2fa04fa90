"""Put a refined camera into its shot's leg, with a body yaw for it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import restrict
from shotc.ir.drone import Drone
from shotc.ir.path import BODY_YAW, HFOV, HoldLeg, MovingLeg, PathLeg
from shotc.planning.path.body import BodyTask, body_line
from shotc.planning.path.filmed_ahead import Ahead, Faced, faced
from shotc.planning.path.shots import stack
from shotc.solvers.conic import Status

SAME_END_TOLERANCE = 1e-9  # metres or radians
LENS_COLUMN = 5  # channel of the field of view in a refined camera


class NoTransit(Exception):
    """A refined shot has no body yaw, or no transfer to it; the text says what cannot be kept.

    least : least duration of the shot, seconds, where the duration is the reason
    """

    def __init__(self, what: str, least: float | None = None) -> None:
        super().__init__(what)
        self.least = least


@lru_cache(maxsize=64)
def with_camera(drone: Drone, leg: PathLeg, camera: Piecewise, ahead: Ahead | None = None) -> MovingLeg:
    """Return a shot's leg with another camera (see ``rejoined``), and the body yaw for it.

    The result is cached, so that the leg which a refiner examines is the one put back, with its cached times.

    ahead : the look-ahead constraint (``ahead_in``); a camera that looks along its path looks along the new
        one and keeps its pitch

    Raises ValueError if the camera does not cover its leg. Raises NoTransit if no body yaw keeps the gimbal
    range.
    """
    if isinstance(leg, HoldLeg):
        raise ValueError(f"the camera of shot {leg.shot} does not cover its leg: it stands still")
    old = leg.curve
    if abs(camera.start - old.start) > SAME_END_TOLERANCE or abs(camera.end - old.end) > SAME_END_TOLERANCE:
        raise ValueError(f"the camera of shot {leg.shot} does not cover its leg")
    lens = old.channels(HFOV)
    if camera.ctrl.shape[2] > LENS_COLUMN:
        lens, camera = camera.channels(LENS_COLUMN), camera.channels(*range(LENS_COLUMN))
    same_ends = same(old.ctrl[0, 0, :5], camera.ctrl[0, 0]) and same(
        old.ctrl[-1, -1, :5], camera.ctrl[-1, -1]
    )
    if ahead is not None and (turned := _facing(drone, leg, camera, ahead)) is not None:
        whole = stack(turned.position, turned.camera, turned.body, restrict(lens, turned.position.breaks))
        return replace(leg, curve=whole)
    body = _body(drone, leg, camera, old) if same_ends else None
    same_ends = body is not None
    body = body or _body(drone, leg, camera, None)
    if body is None:
        raise NoTransit("the gimbal's yaw range")
    curve = stack(camera, body, restrict(lens, camera.breaks))
    if same_ends:
        # Fits are accurate to 1e-9, but joints have to be equal.
        ctrl = curve.ctrl.copy()
        ctrl[0, 0], ctrl[-1, -1] = old.ctrl[0, 0], old.ctrl[-1, -1]
        curve = Piecewise(curve.breaks, ctrl)
    return replace(leg, curve=curve)


def _facing(drone: Drone, leg: MovingLeg, camera: Piecewise, ahead: Ahead) -> Faced | None:
    speed = leg.pace * drone.limits.speed
    task = BodyTask(camera.channels(0, 1, 2), camera.channels(3), None, None, speed)
    return faced(drone, ahead, task, camera.channels(3, 4))


def _body(drone: Drone, leg: MovingLeg, camera: Piecewise, ends: Piecewise | None) -> Piecewise | None:
    """Return the body yaw, with the end values of an earlier curve if given; None if infeasible."""
    start, end = (None, None) if ends is None else ends.ctrl[[0, -1], [0, -1], BODY_YAW].tolist()
    task = BodyTask(camera.channels(0, 1, 2), camera.channels(3), start, end, leg.pace * drone.limits.speed)
    status, body = body_line(drone, task)
    return body if status in {Status.SOLVED, Status.INACCURATE} else None


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether two poses are equal within rounding."""
    return bool(np.abs(a - b).max() < SAME_END_TOLERANCE)
