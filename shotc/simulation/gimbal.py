"""A gimbal that turns a camera on SO(3), vectorised over runs.

Frames: W is East, North, Up; C is x right, y down, z forward. An attitude is R_WC: its columns are the
camera's axes in W.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.vehicle import within


@dataclass(frozen=True, slots=True)
class GimbalModel:
    """A gimbal.

    rate : largest rate of an axis, rad/s; both axes together reach sqrt(2) times it
    gain : of the attitude error, 1/s
    lag : time constant of the motors, seconds
    """

    rate: float
    gain: float = 4.0
    lag: float = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class Attitude:
    """Cameras of R runs: R_WC (R, 3, 3), and their angular velocity in W, (R, 3), rad/s."""

    axes: Array
    rate: Array


def axes_of(yaw: Array, pitch: Array) -> Array:
    """Return R_WC (R, 3, 3) without roll, from yaw counter-clockwise from East and pitch up, (R,), rad."""
    cos_y, sin_y, cos_p, sin_p = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    right = np.stack([sin_y, -cos_y, np.zeros_like(yaw)], axis=-1)
    forward = np.stack([cos_p * cos_y, cos_p * sin_y, sin_p], axis=-1)
    return np.stack([right, cross(forward, right), forward], axis=-1)


class GimbalAngles(NamedTuple):
    """Yaw, pitch and roll, (R,) each, rad; roll is positive with the right side up."""

    yaw: Array
    pitch: Array
    roll: Array


def angles_of(axes: Array) -> GimbalAngles:
    """Return the angles of R_WC, shape (R, 3, 3)."""
    forward, right = axes[..., 2], axes[..., 0]
    yaw = np.arctan2(forward[..., 1], forward[..., 0])
    pitch = np.arcsin(np.clip(forward[..., 2], -1.0, 1.0))
    return GimbalAngles(yaw, pitch, np.arctan2(right[..., 2], -axes[..., 2, 1]))


def turn_rate(axes: Array, yaw_rate: Array, pitch_rate: Array) -> Array:
    """Return the angular velocity (R, 3), in W, of cameras (R, 3, 3) that yaw and pitch at rates (R,)."""
    out = pitch_rate[..., None] * axes[..., 0]
    out[..., 2] += yaw_rate
    return np.asarray(out)


def turned(gimbal: GimbalModel, attitude: Attitude, demanded: Array, rate: Array, step: float) -> Attitude:
    """Return cameras a step later, with demanded attitudes (R, 3, 3) that turn at ``rate`` (R, 3), in W.

    The control law is omega = k (R_e - R_e^T)^vee / 2 + the demanded rate, with R_e = R^T R* (Lee et al.
    2010). In W it is half the sum of the cross products of the axes. The motors' lag follows, and R <-
    exp(omega h) R.
    """
    error = 0.5 * cross(np.swapaxes(attitude.axes, 1, 2), np.swapaxes(demanded, 1, 2)).sum(axis=1)
    command = within(gimbal.gain * error + rate, sqrt(2.0) * gimbal.rate)
    omega = attitude.rate + (command - attitude.rate) * (1.0 - exp(-step / gimbal.lag))
    return Attitude(rotated(attitude.axes, omega * step), omega)


def rotated(axes: Array, by: Array) -> Array:
    """Return attitudes (R, 3, 3) rotated by rotation vectors in W, (R, 3), rad (Rodrigues)."""
    angle = np.sqrt(np.einsum("rd,rd->r", by, by))
    along = np.sinc(angle / np.pi)[:, None, None]
    across = (0.5 * np.sinc(angle / (2 * np.pi)) ** 2)[:, None, None]
    rows = np.swapaxes(axes, 1, 2)
    once = cross(by[:, None, :], rows)
    twice = cross(by[:, None, :], once)
    return np.swapaxes(rows + along * once + across * twice, 1, 2)


def cross(a: Array, b: Array) -> Array:
    """Return the cross products of vectors (..., 3); numpy's own is five times slower for a few."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    out[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out
