"""Body yaw along a leg, a curve of its own, with the camera always within the gimbal's yaw range.

With ``follow-camera`` it equals the camera yaw. With ``forward`` it follows the course as far as the gimbal
range allows. With ``free`` it turns as little as the gimbal range allows.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, pi

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import spline
from shotc.ir.drone import Drone
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import Fit, fit, within

SAMPLES_PER_PIECE = 3  # per piece
FAINT_WEIGHT = 1e-4  # weight that makes the programme regular
FREE_PULL_PER_M = 1e-8  # 1/m, selects one of the headings that need no turn
UPRIGHT_SLOPE = 0.02  # horizontal metres per metre of path, below which there is no course
SWITCH_RAD2 = 1.0  # rad^2, price of a change from one gimbal stop to the other


@dataclass(frozen=True, slots=True, eq=False)
class BodyTask:
    """One leg: p_WC and camera yaw over s, on the same breaks, and the body yaws at the ends where given.

    speed : speed of the leg, m/s, which determines how sharply the body may turn
    cone : lower and upper bounds of the body yaw on each piece, (P,), rad; None where there are none
    """

    position: Piecewise
    cam_yaw: Piecewise
    start: float | None
    end: float | None
    speed: float
    cone: tuple[Array, Array] | None = None


def body_line(drone: Drone, task: BodyTask) -> tuple[Status, Piecewise]:
    """Return the solver's status and the body yaw over s on the task's breaks, one channel."""
    if drone.body == "follow-camera":
        return Status.SOLVED, task.cam_yaw
    breaks = task.cam_yaw.breaks
    at = _samples(breaks)
    cam = task.cam_yaw(at)[:, 0]
    # The smoothing length is at most the leg's; more would be badly scaled on a short leg.
    length = min(max(0.5 * task.speed / drone.limits.yaw_rate, 1e-3), float(breaks[-1] - breaks[0]))
    if drone.body == "forward":
        value, weight = _forward(drone, task, at, cam)
        stiff = (FAINT_WEIGHT * length**2, length**6)
    else:
        value, weight = cam - _clip(0.0, drone.gimbal.yaw), np.full(len(at), FREE_PULL_PER_M)
        stiff = (1.0, length**4)
    step = float(breaks[-1] - breaks[0]) / len(at)
    low, high = drone.gimbal.yaw
    ends = [(float(s), y) for s, y in ((breaks[0], task.start), (breaks[-1], task.end)) if y is not None]
    anchors = np.array(ends, dtype=np.float64).reshape(-1, 2)
    points = task.cam_yaw.ctrl[:, :, 0]
    least, most = points - high, points - low
    if task.cone is not None:
        least, most = np.maximum(least, task.cone[0][:, None]), np.minimum(most, task.cone[1][:, None])
    status, coef = fit(
        Fit(
            breaks,
            at,
            value,
            weight * step,
            anchors[:, 0],
            anchors[:, 1],
            stiff,
            least - 1e-9,
            most + 1e-9,
        )
    )
    curve = spline(breaks, coef[:, None])
    ctrl = within(curve.ctrl[:, :, 0], least, most)
    return status, Piecewise(breaks, ctrl[:, :, None])


def allowed_body(drone: Drone, cam_yaw: float, heading: float) -> float:
    """Return the body yaw nearest to the wanted heading from which the gimbal reaches ``cam_yaw``."""
    return cam_yaw - min(_relatives(drone, cam_yaw - heading), key=lambda c: c[1])[0]


def _relatives(drone: Drone, yaw: float) -> list[tuple[float, float]]:
    """Return gimbal yaws near a wanted one, and their distances from it, for each winding; best first."""
    low, high = drone.gimbal.yaw
    first, last = floor((low - yaw) / (2 * pi)), ceil((high - yaw) / (2 * pi))
    windings = [yaw + 2 * pi * k for k in range(first, last + 1)]
    # Among equals the smaller angle comes first.
    options = [(_clip(w, (low, high)), abs(w - _clip(w, (low, high)))) for w in windings]
    return sorted(options, key=lambda c: (round(c[1], 9), abs(c[0])))


def _forward(drone: Drone, task: BodyTask, at: Array, cam: Array) -> tuple[Array, Array]:
    rate = task.position.derivative()(at)[:, :2]
    flat = np.linalg.norm(rate, axis=1)
    weight = np.minimum(flat, 1.0) ** 2 + FAINT_WEIGHT
    course = np.where(flat > UPRIGHT_SLOPE, np.arctan2(rate[:, 1], rate[:, 0]), cam)
    options = [_relatives(drone, float(c - t)) for c, t in zip(cam, course, strict=True)]
    first = None if task.start is None else float(cam[0]) - task.start
    return cam - _best_windings(options, weight, first), weight


def _best_windings(options: list[list[tuple[float, float]]], weight: Array, first: float | None) -> Array:
    """Return one gimbal yaw per sample, near the course and with few jumps between stops (Viterbi)."""
    width = max(len(o) for o in options)
    value = np.array([[o[min(k, len(o) - 1)][0] for k in range(width)] for o in options])
    price = np.array([[o[min(k, len(o) - 1)][1] for k in range(width)] for o in options])
    price = price**2 * weight[:, None]
    total = price[0] + (0.0 if first is None else SWITCH_RAD2 * (value[0] - first) ** 2)
    back = np.zeros(value.shape, dtype=np.intp)
    for k in range(1, len(value)):
        jump = SWITCH_RAD2 * len(value) ** 0.5 * (value[k][:, None] - value[k - 1][None, :]) ** 2
        through = total[None, :] + jump
        back[k] = through.argmin(axis=1)
        total = through.min(axis=1) + price[k]
    chosen = [int(total.argmin())]
    for k in range(len(value) - 1, 0, -1):
        chosen.append(int(back[k][chosen[-1]]))
    return np.asarray(value[np.arange(len(value)), chosen[::-1]])


def _samples(breaks: Array) -> Array:
    x = (np.arange(SAMPLES_PER_PIECE) + 0.5) / SAMPLES_PER_PIECE
    return np.asarray((breaks[:-1, None] + np.diff(breaks)[:, None] * x).ravel())


def _clip(x: float, bounds: tuple[float, float]) -> float:
    return max(bounds[0], min(bounds[1], x))
