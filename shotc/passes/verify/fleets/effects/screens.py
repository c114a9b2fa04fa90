"""Where an image lies over the lights: its eye, its axes and its rectangle, against its `fit`.

The shape of the file is not in a plan, but its pixels are, in rows and columns that were rounded.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.effects import Fit
from shotc.ir.light_layers import Footage
from shotc.ir.limits import Vec3
from shotc.passes.verify.fleets.effects.views import Eye, seen_from, tangents

LEAST_SLOPE = 1e-6
"""Least size of what an audience sees, as a tangent."""


def screen_error(fit: Fit, places: Array, viewpoint: Vec3 | None, image: Footage) -> float:
    """Return how far an image is from its place over lights at places (k, 3), as a share of its size."""
    view, screen = seen_from(viewpoint, places), image.screen
    seen = tangents(view, places)
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = np.maximum(high - low, LEAST_SLOPE)
    drawn = np.array([screen.width, screen.height])
    middle = np.array([screen.left, screen.bottom]) + drawn / 2.0
    aside = float(np.abs((middle - (low + high) / 2.0) / drawn).max())
    return max(aside, _size_error(fit, drawn / size), _shape_error(fit, image), _turn(view, image))


def _size_error(fit: Fit, scale: Array) -> float:
    """Return the error of width and height over those of the lights, (2,)."""
    if fit == "stretch":
        return float(np.abs(scale - 1.0).max())
    return abs(float(scale.min() if fit == "cover" else scale.max()) - 1.0)


def _shape_error(fit: Fit, image: Footage) -> float:
    """Return by how much an image is wider or higher than its pixels allow, as a share.

    Its columns and rows were rounded, so each is off by up to half of one.
    """
    if fit == "stretch":
        return 0.0
    shape = image.screen.width / image.screen.height
    widest = (image.columns + 0.5) / (image.rows - 0.5)
    narrowest = (image.columns - 0.5) / (image.rows + 0.5)
    # A side of one pixel may have been any part of it.
    too_wide = shape / widest - 1.0 if image.rows > 1 else 0.0
    too_narrow = narrowest / shape - 1.0 if image.columns > 1 else 0.0
    return max(too_wide, too_narrow, 0.0)


def _turn(view: Eye, image: Footage) -> float:
    """Return how far the eye and the axes of an image are from those of the audience, as a share."""
    screen, distance = image.screen, float(np.linalg.norm(view.eye)) + 1.0
    off = float(np.linalg.norm(np.array(screen.eye) - view.eye)) / distance
    axes = ((screen.right, view.right), (screen.up, view.up), (screen.forward, view.forward))
    return max(off, *(float(np.linalg.norm(np.array(one) - other)) for one, other in axes))
