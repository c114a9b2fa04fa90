"""Camera angles that show a target at a place on screen: ``geom.camera.aim_at`` for many runs at once."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array


def aimed(offset: Array, uv: Array, half: Array) -> tuple[Array, Array]:
    """Return yaw and pitch (R,), rad, that show points at offsets (R, 3) from the eye, W, at (u, v) (R, 2).

    half : tan of half the fields of view, (R, 2). Where no camera without roll shows the point there it looks
    as steeply as it helps.
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


def sight_rates(offset: Array, velocity: Array) -> tuple[Array, Array]:
    """Return how fast a line of sight yaws and pitches, (R,) each, rad/s.

    offset : (R, 3), from the eye to the point, metres; velocity : of the point less the eye's, m/s
    """
    level = np.maximum(np.sum(offset[:, :2] ** 2, axis=1), 1e-6)
    yaw = (offset[:, 0] * velocity[:, 1] - offset[:, 1] * velocity[:, 0]) / level
    distance = np.maximum(np.sum(offset**2, axis=1), 1e-6)
    closing = np.sum(offset * velocity, axis=1) / distance
    pitch = (velocity[:, 2] - offset[:, 2] * closing) / np.sqrt(level)
    return yaw, pitch
