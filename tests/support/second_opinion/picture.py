"""What a camera sees of a target: points of its rims, or its corners, projected one by one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tests.support.second_opinion.flight import CAM_PITCH, CAM_YAW, HFOV, Array

FRAMES = 512  # projected at once


class Picture(NamedTuple):
    """Of M frames: the centre's place (M, 2), NaN behind the camera, the outline's height over the frame's,
    NaN unless all is in front, and how far the outline is within the frame, half frames: negative is outside.
    """

    centre: Array
    size: Array
    inside: Array


class Camera(NamedTuple):
    """Places (M, 3), directions (M, 3) and half widths of the picture one metre ahead (M,)."""

    place: Array
    right: Array
    down: Array
    ahead: Array
    wide: Array
    high: Array

    @staticmethod
    def of(states: Array, aspect: float) -> Camera:
        """Return the cameras of states (M, 7)."""
        yaw, pitch = states[:, CAM_YAW], states[:, CAM_PITCH]
        ahead = np.stack([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)], axis=1)
        right = np.stack([np.sin(yaw), -np.cos(yaw), np.zeros_like(yaw)], axis=1)
        wide = np.tan(states[:, HFOV] / 2)
        return Camera(states[:, :3], right, np.cross(ahead, right), ahead, wide, wide / aspect)

    def project(self, points: Array) -> tuple[Array, Array]:
        """Return the places on screen (M, K, 2) and the depths (M, K) of points (M, K, 3)."""
        away = points - self.place[:, None]
        x, y, z = (np.einsum("mkc,mc->mk", away, axis) for axis in (self.right, self.down, self.ahead))
        with np.errstate(divide="ignore", invalid="ignore"):
            screen = np.stack([x / (z * self.wide[:, None]), -y / (z * self.high[:, None])], axis=-1)
        return screen, z

    def some(self, which: slice) -> Camera:
        return Camera(*(field[which] for field in self))


def picture(camera: Camera, centre: Array, outline: Array) -> Picture:
    """Return what cameras see of what is about centres (M, 3); outline : points of its hull, (M, K, 3)."""
    parts = []
    for first in range(0, len(centre), FRAMES):
        which = slice(first, first + FRAMES)
        parts.append(_pictures(camera.some(which), centre[which], outline[which]))
    return Picture(*(np.concatenate(field) for field in zip(*parts, strict=True)))


def _pictures(camera: Camera, centre: Array, outline: Array) -> tuple[Array, Array, Array]:
    middle, ahead = camera.project(centre[:, None])
    screen, depth = camera.project(outline)
    whole = depth.min(axis=1) > 0
    size = np.where(whole, np.ptp(screen[..., 1], axis=1) / 2, np.nan)
    inside = np.where(whole, 1.0 - np.abs(screen).max(axis=(1, 2)), -np.inf)
    return np.where(ahead > 0, middle[:, 0], np.nan), size, inside
