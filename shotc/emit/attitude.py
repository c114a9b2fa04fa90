"""Camera angles as unit quaternions (x, y, z, w) for other programs' files.

The rotation to W (x East, y North, z Up) from a camera that looks along its own -Z, with Y up, is Rz(yaw - 90
deg) Rx(90 deg + pitch). Consecutive quaternions have a non-negative scalar product, so that programs may
interpolate between them.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array


def graphics(yaw: Array, pitch: Array) -> Array:
    """Return rotations to W from a camera that looks along -Z, with Y up, shape (M, 4).

    yaw, pitch : rad, shape (M,)
    """
    return _continuous(_turned(yaw - np.pi / 2, pitch + np.pi / 2))


def optical(yaw: Array, pitch: Array) -> Array:
    """Return rotations to W from the camera frame of plans (x right, y down, z forward), shape (M, 4).

    yaw, pitch : rad, shape (M,)
    """
    return _continuous(_turned(yaw - np.pi / 2, pitch - np.pi / 2))


def upright(yaw: Array, pitch: Array) -> Array:
    """Return the rotations of ``graphics`` for a world with Y up (x East, y Up, z South), shape (M, 4).

    yaw, pitch : rad, shape (M,)
    """
    x, y, z, w = _turned(yaw - np.pi / 2, pitch).T  # Ry(yaw - 90 deg) Rx(pitch): its y, z are z, -y of W
    return _continuous(np.stack([x, z, -y, w], axis=-1))


def _turned(about_z: Array, about_x: Array) -> Array:
    """Return Rz(about_z) Rx(about_x) as quaternions, shape (M, 4)."""
    a, b = about_z / 2, about_x / 2
    return np.stack(
        [np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.sin(a) * np.cos(b), np.cos(a) * np.cos(b)], -1
    )


def _continuous(quaternions: Array) -> Array:
    """Return the same rotations, each with the sign that is nearer to the quaternion before it."""
    back = np.einsum("mi,mi->m", quaternions[1:], quaternions[:-1]) < 0.0
    sign = np.concatenate([[1.0], np.where(np.logical_xor.accumulate(back), -1.0, 1.0)])
    return np.asarray(quaternions * sign[:, None])
