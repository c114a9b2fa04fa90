"""The distance of a ball from a camera's picture: beyond the edges in metres, or off the axis as an angle.

Occlusion of the ball is ignored: zones and targets are rarely as solid as their shapes, so a ball behind one
counts as in the picture.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import Offset, frustum_margins
from shotc.geom.framing import Cameras

WITHIN_RAD = -0.5 * np.pi
"""Angle of a ball that contains the camera, rad."""


def outside(cameras: Cameras, places: Array, radius: float) -> Array:
    """Return the distance of each ball beyond one of the frame's four edges or behind the image plane, (M,).

    places : of its centre, (M, 3), metres. The result is in metres, negative if the ball reaches into the
    picture. It is a lower bound on the distance from the picture; beyond a corner of the frame it is smaller.
    """
    camera, offset = cameras.view, _offsets(cameras, places)
    edges = frustum_margins(camera, offset)
    return np.asarray(-np.min([*edges, camera.to_camera(offset)[2]], axis=0) - radius)


def off_axis(cameras: Cameras, places: Array, radius: float) -> Array:
    """Return the angle between the optical axis and the nearest point of each ball, rad, shape (M,)."""
    right, down, forward = cameras.view.to_camera(_offsets(cameras, places))
    radial = np.hypot(right, down)
    far = np.hypot(radial, forward)
    half = np.arcsin(radius / np.maximum(far, radius)) if radius > 0 else np.zeros_like(far)
    return np.where(far > radius, np.arctan2(radial, forward) - half, WITHIN_RAD)


def _offsets(cameras: Cameras, places: Array) -> Offset:
    x, y, z = (places - cameras.position).T
    return x, y, z
