"""Points and solids: closest points, distances, depths, footprints, and the support of a solid."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts, edges

FAR_M = 1e7
"""Replaces an unlimited height: beyond any flight, but small enough for exact millimetres."""

NO_LENGTH_M = 1e-12
"""Replaces a zero length in a division."""

NO_AREA_M2 = 1e-18
"""Replaces a zero squared length."""


def bounded(part: Solid) -> Solid:
    """Return the solid with infinite heights replaced by FAR_M."""
    bottom, top = heights(part)
    return part._replace(bottom=bottom, top=top)


def heights(solid: Solid) -> tuple[float, float]:
    """Return the heights of bottom and top, metres, both finite."""
    return max(solid.bottom, -FAR_M), min(solid.top, FAR_M)


def closest_points(part: Solid, p: Array) -> Array:
    """Return the points of a convex solid closest to p, shape (..., 3); p itself if it is inside."""
    z = np.clip(p[..., 2:], part.bottom, part.top)
    if isinstance(part, Cylinder):
        return np.concatenate([_closest_on_circle(part, p[..., :2]), z], axis=-1)
    return np.concatenate([_closest_on_polygon(part, p[..., :2]), z], axis=-1)


def distances(part: Solid, p: Array) -> Array:
    """Return the distances (...) of points (..., 3) from a convex solid, metres, 0 inside."""
    return np.asarray(np.linalg.norm(p - closest_points(part, p), axis=-1))


def separation(part: Solid, p: Array) -> tuple[Array, Array]:
    """Return distances (...) of points (..., 3) from a convex solid, and unit normals (..., 3); 0 inside.

    The normal points from the nearest point of the solid to p. Beside a cylinder it is computed from the
    axis, because the coordinates of the nearest point are rounded.
    """
    offset = p - closest_points(part, p)
    if isinstance(part, Cylinder):
        flat = p[..., :2] - np.array(part.centre)
        share = np.minimum(1.0, part.radius / np.maximum(_from_axis(part, p), NO_LENGTH_M))
        offset[..., :2] = flat * (1.0 - share)[..., None]
    distance = np.asarray(np.sqrt(np.einsum("...d,...d->...", offset, offset)))
    return distance, offset / np.where(distance > 0, distance, 1.0)[..., None]


def support(part: Solid, n: Array) -> Array:
    """Return max of n.x over the convex solid for directions of shape (..., 3); shape (...)."""
    bottom, top = heights(part)
    high = np.maximum(n[..., 2] * bottom, n[..., 2] * top)
    if isinstance(part, Cylinder):
        flat = n[..., :2] @ np.array(part.centre) + part.radius * np.linalg.norm(n[..., :2], axis=-1)
    else:
        flat = (n[..., :2] @ np.array(part.points).T).max(axis=-1)
    return np.asarray(flat + high)


def signed_distance(solid: Solid, p: Array) -> Array:
    """Return signed distances (M,) of points (M, 3) from the solid, metres; inside, minus the depth."""
    distance = np.min([distances(part, p) for part in convex_parts(solid)], axis=0)
    bottom, top = heights(solid)
    upright = np.minimum(p[:, 2] - bottom, top - p[:, 2])
    # Between the parts of a prism there are gaps by rounding; its footprint has none.
    inside = (distance <= 0) | ((upright > 0) & in_footprint(solid, p[:, :2]))
    depth = np.maximum(np.minimum(upright, _depth_in_footprint(solid, p[:, :2])), 0.0)
    return np.where(inside, -depth, distance)


def footprint_distances(solid: Solid, xy: Array) -> Array:
    """Return horizontal distances (...) of points (..., 2) from the footprint, metres, 0 inside."""
    if isinstance(solid, Cylinder):
        return np.maximum(_from_axis(solid, xy) - solid.radius, 0.0)
    return np.where(in_footprint(solid, xy), 0.0, np.sqrt(_from_edges(solid, xy)[0].min(axis=-1)))


def in_footprint(solid: Solid, xy: Array) -> Mask:
    """Return which points (..., 2) are in a solid's footprint, by crossing number; shape (...)."""
    if isinstance(solid, Cylinder):
        return np.asarray(_from_axis(solid, xy) <= solid.radius)
    inside = np.zeros(xy.shape[:-1], dtype=np.bool_)
    x, y = xy[..., 0], xy[..., 1]
    for (ax, ay), (bx, by) in edges(solid.points):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < (bx - ax) * (y - ay) / (by - ay) + ax)
    return inside


def in_convex(corners: Array, xy: Array) -> Mask:
    """Return which points (..., 2) are in or on a convex polygon, shape (...).

    corners : in counter-clockwise order, shape (k, 2)
    """
    sides = np.roll(corners, -1, axis=0) - corners
    offset = xy[..., None, :] - corners
    turn = sides[:, 0] * offset[..., 1] - sides[:, 1] * offset[..., 0]
    return np.asarray((turn >= 0).all(axis=-1))


def _closest_on_circle(part: Cylinder, xy: Array) -> Array:
    centre = np.array(part.centre)
    offset = xy - centre
    distance = np.hypot(offset[..., :1], offset[..., 1:])
    scale = part.radius / np.maximum(distance, NO_LENGTH_M)
    return np.where(distance <= part.radius, xy, centre + offset * scale)


def _closest_on_polygon(part: Prism, xy: Array) -> Array:
    squares, feet = _from_edges(part, xy)
    nearest = squares.argmin(axis=-1)
    foot = np.take_along_axis(feet, nearest[..., None, None], axis=-2)[..., 0, :]
    return np.where(in_convex(np.array(part.points), xy)[..., None], xy, foot)


def _from_edges(prism: Prism, xy: Array) -> tuple[Array, Array]:
    # Squared distances (..., k) from every edge, and the nearest points on them (..., k, 2).
    corners = np.array(prism.points, dtype=np.float64)
    sides = np.roll(corners, -1, axis=0) - corners
    along = _dot(xy[..., None, :] - corners, sides) / np.maximum(_dot(sides, sides), NO_AREA_M2)
    feet = corners + np.clip(along, 0.0, 1.0)[..., None] * sides
    rest = xy[..., None, :] - feet
    return _dot(rest, rest), feet


def _depth_in_footprint(solid: Solid, xy: Array) -> Array:
    if isinstance(solid, Cylinder):
        return solid.radius - _from_axis(solid, xy)
    return np.asarray(np.sqrt(_from_edges(solid, xy)[0].min(axis=-1)))


def _from_axis(part: Cylinder, xy: Array) -> Array:
    return np.asarray(np.hypot(xy[..., 0] - part.centre[0], xy[..., 1] - part.centre[1]))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
