"""Ground that rises, as pictures need it: its shades, and what it stands before."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.surface.ground import Ground
from shotc.geom.surface.sight import lines_hidden

LIGHT = np.array([-0.5, 0.5, np.sqrt(0.5)])
"""Where the light of a hillshade comes from, W: the north-west, half-way up, as on maps."""

CONTRAST = 0.9
"""How much lighter than level ground a slope towards the light is, and one that turns away darker."""

ROOM_M = 0.05
"""How deep a sight line lies in the ground that hides, metres: what stands on ground touches it."""


def hillshade(normals: Array) -> Array:
    """Return how light ground is, about 1 where it is level; normals : upward, any length, (..., 3)."""
    size = np.linalg.norm(normals, axis=-1)
    facing = normals @ LIGHT / np.where(size > 0.0, size, 1.0)
    return np.asarray(np.clip(1.0 + CONTRAST * (facing - LIGHT[2]), 0.45, 1.3))


def shades(color: Array, light: Array) -> Array:
    """Return a colour (3,) in many lights (...), as ``palette.shade`` does: shape (..., 3)."""
    dark, pale = np.minimum(light, 1.0)[..., None], np.clip(light - 1.0, 0.0, 1.0)[..., None]
    return np.asarray(color * dark + (1.0 - color * dark) * pale)


def before(ground: Ground, eye: Array, points: Array) -> Mask:
    """Tell of points (n, 3) whether ground stands before them, seen from an eye (3,), metres of W."""
    up = np.array([0.0, 0.0, ROOM_M])
    return lines_hidden(ground.surface, np.tile(eye + up, (len(points), 1)), points + up)
