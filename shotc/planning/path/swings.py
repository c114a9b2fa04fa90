"""Find where following a target turns the picture round: where a camera passes almost vertically above it."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, tan

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import subdivide
from shotc.ir.mission import MissionIR
from shotc.planning.path.angles import NOTICE_RAD, CameraLine, KeyedPath

SAMPLES_PER_PIECE = 6  # per piece
STEEP_RAD = radians(75)  # pitch beyond which a turn of the camera turns the picture
ROUND_RAD = radians(60)  # turn of the picture above which there is a warning
SLOW_SLOPE = 0.05  # horizontal metres per metre of path, below which there is no course


@dataclass(frozen=True, slots=True)
class Swing:
    """A place where the picture turns round, or where the camera misses its reference.

    index : the keyframe before it
    s : path parameter
    target : its name
    turn : turn of the picture, rad; 0 where the camera only misses its reference
    pitch : of the camera there, rad
    offset : metres beside the target from which there is no such turn
    miss : largest error of the camera's direction, rad
    """

    index: int
    s: float
    target: str
    turn: float
    pitch: float
    offset: float
    miss: float


def worst_swing(mission: MissionIR, keyed: KeyedPath, camera: CameraLine) -> Swing | None:
    """Return the worst place of a shot; None where the camera turns as a viewer expects.

    A turn together with the course is expected, as on a narrow orbit high above its target.
    """
    at = subdivide(camera.angles.breaks, SAMPLES_PER_PIECE)
    yaw, pitch, _ = camera.angles(at).T
    turned = yaw - _course(keyed.position, at)
    swings = []
    for run in _runs((np.abs(pitch) > STEEP_RAD) & _followed(keyed, at)):
        turn = min(float(np.ptp(yaw[run])), float(np.ptp(turned[run])))
        if turn > ROUND_RAD:
            steepest = run.start + int(np.abs(pitch[run]).argmax())
            swings.append(_swing(mission, keyed, camera, float(at[steepest]), turn))
    if not swings and camera.error > NOTICE_RAD and not camera.cuts:
        return _swing(mission, keyed, camera, camera.worst, 0.0)
    return max(swings, key=lambda swing: swing.turn, default=None)


def _swing(mission: MissionIR, keyed: KeyedPath, camera: CameraLine, s: float, turn: float) -> Swing:
    index = int(np.clip(np.searchsorted(keyed.s, s, side="right") - 1, 0, len(keyed.s) - 2))
    name = keyed.keyframes[index].target
    assert name is not None
    height = abs(mission.target(name).centre[2] - float(keyed.position(s)[2]))
    pitch = float(camera.angles(s)[1])
    return Swing(index, s, name, turn, pitch, height / tan(STEEP_RAD), camera.error)


def _followed(keyed: KeyedPath, at: Array) -> np.ndarray:
    """Return at which parameters both neighbouring keyframes have a target with a place on screen."""
    composed = [k.target is not None and k.reference is not None for k in keyed.keyframes]
    after = np.clip(np.searchsorted(keyed.s, at, side="right"), 1, len(composed) - 1)
    return np.asarray(np.array(composed)[after] & np.array(composed)[after - 1])


def _course(position: Piecewise, at: Array) -> Array:
    """Return the course, unwrapped; where there is none, the last one."""
    rate = position.derivative()(at)[:, :2]
    moves = np.linalg.norm(rate, axis=1) > SLOW_SLOPE
    if not moves.any():
        return np.zeros(len(at))
    last = np.maximum.accumulate(np.where(moves, np.arange(len(at)), int(moves.argmax())))
    return np.asarray(np.unwrap(np.arctan2(rate[last, 1], rate[last, 0])))


def _runs(where: np.ndarray) -> list[slice]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(int)))
    return [slice(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
