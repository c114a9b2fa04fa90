"""Circles and the ground plans of solids as polygons."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid

POLYGON_SIDES = 48
"""Sides of the polygon for a circle."""


def ring(radius: float, sides: int = POLYGON_SIDES) -> Array:
    """Return the corners of a regular polygon around a circle, counter-clockwise from East, (sides, 2), m."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    return np.asarray(radius / np.cos(np.pi / sides) * np.stack([np.cos(turn), np.sin(turn)], axis=-1))


def ground_plan(solid: Solid) -> Array:
    """Return the corners of a solid's footprint, counter-clockwise, shape (k, 2), metres.

    A circle becomes a polygon around it, so that everything inside the circle is inside the polygon.
    """
    if isinstance(solid, Cylinder):
        return np.array(solid.centre) + ring(solid.radius)
    return np.array(solid.points)
