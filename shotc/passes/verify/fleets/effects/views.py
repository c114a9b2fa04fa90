"""How an audience sees lights: its eye, and its axes as it looks at the middle of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Vec3

AFAR_M = 10_000.0
"""Distance south of the lights from which a display without a viewpoint is seen, metres."""


class Eye(NamedTuple):
    """An eye, p_W in metres, and unit vectors to the right, up and forward, (3,) each."""

    eye: Array
    right: Array
    up: Array
    forward: Array


def seen_from(viewpoint: Vec3 | None, places: Array) -> Eye:
    """Return the view from a viewpoint on the middle of places (k, 3), metres; the view is level."""
    middle = (places.min(axis=0) + places.max(axis=0)) / 2.0
    eye = middle - np.array([0.0, AFAR_M, 0.0]) if viewpoint is None else np.array(viewpoint)
    ahead = middle - eye
    forward = ahead / max(float(np.linalg.norm(ahead)), 1e-9)
    level = np.array([forward[1], -forward[0], 0.0])
    width = float(np.linalg.norm(level))
    # Straight up there is no level direction to the right: east is taken.
    right = level / width if width > 1e-6 else np.array([1.0, 0.0, 0.0])
    return Eye(eye, right, np.cross(right, forward), forward)


def tangents(view: Eye, places: Array) -> Array:
    """Return where places (k, 3) are seen, to the right and up, as tangents of angles, shape (k, 2)."""
    offset = places - view.eye
    depth = np.maximum(offset @ view.forward, 1e-3)
    return np.stack([(offset @ view.right) / depth, (offset @ view.up) / depth], axis=1)
