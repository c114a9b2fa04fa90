"""Where following a target turns the picture round: a camera that passes nearly straight over it."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, tan

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import subdivide
from shotc.ir.mission import MissionIR
from shotc.planning.path.angles import NOTICE_RAD, CameraLine, KeyedPath

SAMPLES_PER_PIECE = 6  # per piece
STEEP_RAD = radians(75)  # beyond this pitch a turn of the camera is a turn of the picture
ROUND_RAD = radians(60)  # turns of the picture that are worth a warning
SLOW_SLOPE = 0.05  # metres flown sideways for each metre of path, below which there is no course


@dataclass(frozen=True, slots=True)
class Swing:
    """A place where the camera swings round, or is not where it should be.

    index : the keyframe before it; s : path parameter; target : its name
    turn : rad that the picture turns by; 0 where the camera only misses its aim
    pitch : of the camera there, rad; aside : metres beside the target from which there is no such turn
    miss : rad by which the camera misses its aim at worst
    """

    index: int
    s: float
    target: str
    turn: float
    pitch: float
    aside: float
    miss: float


def worst_swing(mission: MissionIR, keyed: KeyedPath, camera: CameraLine) -> Swing | None:
    """Return the worst place of a shot, None where the camera turns as a viewer would expect.

    Turning along with the course is expected: a narrow orbit far above its target turns all the time.
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
    """Tell at which parameters both neighbouring keyframes have a target in its place."""
    composed = [k.target is not None and k.reference is not None for k in keyed.keyframes]
    after = np.clip(np.searchsorted(keyed.s, at, side="right"), 1, len(composed) - 1)
    return np.asarray(np.array(composed)[after] & np.array(composed)[after - 1])


def _course(position: Piecewise, at: Array) -> Array:
    """Return the direction of flight, unwrapped; where there is none, the last one."""
    rate = position.derivative()(at)[:, :2]
    moves = np.linalg.norm(rate, axis=1) > SLOW_SLOPE
    if not moves.any():
        return np.zeros(len(at))
    last = np.maximum.accumulate(np.where(moves, np.arange(len(at)), int(moves.argmax())))
    return np.asarray(np.unwrap(np.arctan2(rate[last, 1], rate[last, 0])))


def _runs(where: np.ndarray) -> list[slice]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(int)))
    return [slice(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
