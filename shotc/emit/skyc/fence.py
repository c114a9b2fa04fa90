"""The geofence of a show file: keep-in zones as polygons on the map, which have no height."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.solids import Cylinder, Solid

SIDES = 48


def outside(solid: Solid, points: Array) -> bool:
    """Tell whether any of these points, shape (k, 3), is not above or below a solid."""
    flat = points[:, :2]
    if isinstance(solid, Cylinder):
        away = np.linalg.norm(flat - np.array(solid.centre), axis=1)
        return bool(away.max() > solid.radius)
    return not bool(_inside(np.array(solid.points), flat).all())


def _inside(corners: Array, points: Array) -> Mask:
    """Tell which points lie in a polygon: those whose way East crosses an odd number of its edges."""
    odd = np.zeros(len(points), dtype=np.bool_)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if ay != by:
            spans = (points[:, 1] >= ay) != (points[:, 1] >= by)
            odd ^= spans & (points[:, 0] < ax + (points[:, 1] - ay) / (by - ay) * (bx - ax))
    return odd


def fence(solid: Solid) -> Array:
    """Return the corners of a solid's outline on the ground, counter-clockwise, shape (k, 3).

    A circle is a polygon about it: what stays in the zone stays in the fence.
    """
    if isinstance(solid, Cylinder):
        turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
        reach = solid.radius / np.cos(np.pi / SIDES)
        flat = np.array(solid.centre) + reach * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    else:
        flat = np.array(solid.points)
    return np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)
