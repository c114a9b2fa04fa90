"""Camera angles that show a target at a place on screen: ``geom.camera.aim_at``, vectorised over runs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped


class Shown(NamedTuple):
    """The place on screen of a point, and the lens; (R, 2) each.

    uv : half frames
    half : tan of half the fields of view
    """

    uv: Array
    half: Array


def aimed(offset: Array, uv: Array, half: Array) -> tuple[Array, Array]:
    """Return yaw and pitch (R,), rad, that show points at offsets (R, 3) from the eye, W, at (u, v) (R, 2).

    Where no camera without roll shows the point there, the pitch is as near as possible.

    half : tan of half the fields of view, (R, 2)
    """
    right, up = uv[:, 0] * half[:, 0], uv[:, 1] * half[:, 1]
    norm = np.sqrt(right**2 + up**2 + 1.0)
    right, up, forward = right / norm, up / norm, 1.0 / norm
    reach = np.hypot(up, forward)
    length = np.maximum(np.linalg.norm(offset, axis=1), 1e-9)
    rise = np.arcsin(np.clip(offset[:, 2] / length / reach, -1.0, 1.0))
    pitch = rise - np.arctan2(up, forward)
    along = forward * np.cos(pitch) - up * np.sin(pitch)
    yaw = np.arctan2(offset[:, 1], offset[:, 0]) + np.arctan2(right, along)
    return yaw, pitch


def aim_rates(offset: Array, velocity: Array, now: Shown, later: Shown, step: float) -> tuple[Array, Array]:
    """Return the mean rates of the angles of ``aimed`` over the next ``step`` seconds, (R,) each, rad/s.

    offset : (R, 3), from the eye to the point, W, metres
    velocity : of the point minus that of the eye, (R, 3), m/s
    now, later : place on screen and lens at the start and at the end of the step
    """
    yaw, pitch = aimed(offset, *now)
    then_yaw, then_pitch = aimed(offset + step * velocity, *later)
    return wrapped(then_yaw - yaw) / step, (then_pitch - pitch) / step
