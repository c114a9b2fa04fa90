"""How far a ball is out of a camera's picture: beyond the edges in metres, or off the axis by an angle.

What stands before a ball does not hide it here: a zone or a target is rarely as solid as it is drawn, so
that what is behind one counts as in the picture.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import frustum_margins
from shotc.geom.framing import Cameras

WITHIN_RAD = -0.5 * np.pi
"""Radians: what a ball is off the axis of a camera that is inside of it."""


def outside(cameras: Cameras, places: Array, radius: float) -> Array:
    """Return how far each ball lies beyond one of the frame's four edges, or behind the image plane.

    places : of its centre, (M, 3). Metres, (M,); negative where it reaches into the picture. It is no more
    than the distance from the picture: over a corner of the frame it is less.
    """
    camera, away = cameras.view, _away(cameras, places)
    edges = frustum_margins(camera, away)
    return np.asarray(-np.min([*edges, camera.to_camera(away)[2]], axis=0) - radius)


def off_axis(cameras: Cameras, places: Array, radius: float) -> Array:
    """Return the angle between the optical axis and the nearest point of each ball, rad, shape (M,)."""
    right, down, forward = cameras.view.to_camera(_away(cameras, places))
    aside = np.hypot(right, down)
    far = np.hypot(aside, forward)
    half = np.arcsin(radius / np.maximum(far, radius)) if radius > 0 else np.zeros_like(far)
    return np.where(far > radius, np.arctan2(aside, forward) - half, WITHIN_RAD)


def _away(cameras: Cameras, places: Array) -> tuple[Array, Array, Array]:
    x, y, z = (places - cameras.position).T
    return x, y, z
