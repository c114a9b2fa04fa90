"""Shading of terrain in pictures, and the test of what terrain hides."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.surface.ground import Ground
from shotc.geom.surface.occlusion import lines_hidden

LIGHT = np.array([-0.5, 0.5, np.sqrt(0.5)])
"""Direction to the light of a hillshade in W: from the north-west at 45 degrees, as on maps."""

CONTRAST_SHARE = 0.9
"""Change of lightness of a slope that turns towards the light or away from it."""

ROOM_M = 0.05
"""Metres that both ends of a sight line are raised in the test of what terrain hides, because objects that
stand on the ground touch it.
"""


def hillshade(normals: Array) -> Array:
    """Return the lightness of the ground, about 1 where it is level, shape (...).

    normals : upward normals of any length, shape (..., 3)
    """
    size = np.linalg.norm(normals, axis=-1)
    facing = normals @ LIGHT / np.where(size > 0.0, size, 1.0)
    return np.asarray(np.clip(1.0 + CONTRAST_SHARE * (facing - LIGHT[2]), 0.45, 1.3))


def shades(color: Array, light: Array) -> Array:
    """Return a colour (3,) at lightness values (...), as ``palette.shade`` does: shape (..., 3)."""
    dark, pale = np.minimum(light, 1.0)[..., None], np.clip(light - 1.0, 0.0, 1.0)[..., None]
    return np.asarray(color * dark + (1.0 - color * dark) * pale)


def before(ground: Ground, eye: Array, points: Array) -> Mask:
    """Return which of the points (n, 3) the ground hides from an eye (3,), shape (n,); positions in W,
    metres.
    """
    up = np.array([0.0, 0.0, ROOM_M])
    return lines_hidden(ground.surface, np.tile(eye + up, (len(points), 1)), points + up)
