"""A camera pose, and the map from its screen to the page."""

from __future__ import annotations

from dataclasses import dataclass
from math import tan

import numpy as np

from shotc.emit.storyboard.canvas import PageRectangle
from shotc.geom.bernstein import Array
from shotc.geom.camera import View, view
from shotc.geom.vec import Vec3
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.target import Target


@dataclass(frozen=True, slots=True, eq=False)
class PictureRectangle:
    """A camera pose and the rectangle of its picture."""

    camera: View
    eye: Vec3
    pitch: float
    box: PageRectangle

    @property
    def horizon(self) -> float:
        """The v of the horizon on screen; outside [-1, 1] it is not in the picture."""
        return -tan(self.pitch) / float(self.camera.half_height)

    def place(self, uv: Array) -> Array:
        """Return page positions of screen points, shape (..., 2), inches."""
        x = self.box.x + (uv[..., 0] + 1) / 2 * self.box.width
        y = self.box.y + (uv[..., 1] + 1) / 2 * self.box.height
        return np.stack([x, y], axis=-1)

    def offset(self, target: Target) -> Vec3:
        """Return the target's centre minus the eye, W, metres."""
        x, y, z = target.centre
        return (x - self.eye[0], y - self.eye[1], z - self.eye[2])


def picture(pose: Array, aspect: float, box: PageRectangle) -> PictureRectangle:
    """Return the picture of one pose, channels of shape (7,)."""
    camera = view(float(pose[CAM_YAW]), float(pose[CAM_PITCH]), float(pose[HFOV]), aspect)
    return PictureRectangle(
        camera, (float(pose[0]), float(pose[1]), float(pose[2])), float(pose[CAM_PITCH]), box
    )
