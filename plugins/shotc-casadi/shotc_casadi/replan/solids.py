"""Signed distances of points from what stands, with their gradients, for arrays of points.

The distance from a convex solid is a convex function: where its linearisation is kept, the distance is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from shotc.plugin_api.replanner import (
    Array,
    Clearance,
    Cylinder,
    Prism,
    Solid,
    convex_parts,
    edges,
    hull_and_pockets,
)

NO_LENGTH_M = 1e-9
"""A length below it has no direction."""
SHARP_M = 0.5
"""Radius of a curve that leads round a corner: a straight step between two stages cuts it."""

Room = Callable[[Array], tuple[Array, Array]]
"""Of points (M, 3): how much room there is, (M,), metres, negative where it lacks; its gradient, (M, 3)."""


def rooms(zone: Clearance, margin: float) -> Iterator[tuple[Room, float]]:
    """Yield what is kept of one clearance, and the radius of the curve that it is kept on, metres."""
    metres = zone.metres + margin
    if zone.inside:
        yield from _inside(zone.solid, metres)
        return
    for part in convex_parts(zone.solid):
        yield partial(outside, part, metres), _radius(part, metres)


def outside(part: Solid, metres: float, p: Array) -> tuple[Array, Array]:
    """Return the room of points outside of a convex solid, less metres."""
    gap, normal = _from_disc(part, p) if isinstance(part, Cylinder) else _from_polygon(part, p)
    if part.bottom == -np.inf and part.top == np.inf:
        return gap - metres, normal
    return _with_heights(part, p, gap, normal, metres)


def above(normal: Array, offset: float, p: Array) -> tuple[Array, Array]:
    """Return the room of points in a half-space normal . p >= offset; normal : a unit vector."""
    return p @ normal - offset, np.broadcast_to(normal, p.shape)


def _inside(solid: Solid, metres: float) -> Iterator[tuple[Room, float]]:
    yield from ((partial(above, n, o), np.inf) for n, o in _lids(solid, metres))
    if isinstance(solid, Cylinder):
        yield partial(_in_disc, solid, metres), np.inf
        return
    hull, pockets = hull_and_pockets(solid)
    for a, b in edges(hull.points):
        normal = _outward(a, b)
        yield partial(above, -normal, metres - float(normal @ [*a, 0.0])), np.inf
    for pocket in pockets:
        yield partial(outside, pocket, metres), _radius(pocket, metres)


def _lids(solid: Solid, metres: float) -> Iterator[tuple[Array, float]]:
    if np.isfinite(solid.bottom):
        yield np.array([0.0, 0.0, 1.0]), solid.bottom + metres
    if np.isfinite(solid.top):
        yield np.array([0.0, 0.0, -1.0]), metres - solid.top


def _radius(part: Solid, metres: float) -> float:
    return max(metres + (part.radius if isinstance(part, Cylinder) else 0.0), SHARP_M)


def _in_disc(solid: Cylinder, metres: float, p: Array) -> tuple[Array, Array]:
    gap, normal = _from_disc(solid, p)
    return -gap - metres, -normal


def _from_disc(part: Cylinder, p: Array) -> tuple[Array, Array]:
    away = p[:, :2] - part.centre
    distance = np.hypot(away[:, 0], away[:, 1])
    if not distance.min() > NO_LENGTH_M:  # on the axis any direction leads out
        away = np.where(distance[:, None] > NO_LENGTH_M, away, [NO_LENGTH_M, 0.0])
        distance = np.maximum(distance, NO_LENGTH_M)
    normal = np.zeros((len(p), 3))
    normal[:, :2] = away / distance[:, None]
    return distance - part.radius, normal


def _from_polygon(part: Prism, p: Array) -> tuple[Array, Array]:
    corners = np.array(part.points)
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(sides, axis=1)
    normals = np.column_stack([sides[:, 1], -sides[:, 0]]) / lengths[:, None]
    from_corners = p[:, None, :2] - corners
    faces = np.einsum("mkd,kd->mk", from_corners, normals)
    along = np.clip(np.einsum("mkd,kd->mk", from_corners, sides) / lengths**2, 0.0, 1.0)
    rest = from_corners - along[..., None] * sides
    nearest = np.einsum("mkd,mkd->mk", rest, rest).argmin(axis=1)
    rows, face = np.arange(len(p)), faces.argmax(axis=1)
    away = rest[rows, nearest]
    distance = np.hypot(away[:, 0], away[:, 1])
    beyond = (faces[rows, face] > 0) & (distance > NO_LENGTH_M)
    gap = np.where(beyond, distance, faces[rows, face])
    normal = np.zeros((len(p), 3))
    normal[:, :2] = np.where(
        beyond[:, None], away / np.maximum(distance, NO_LENGTH_M)[:, None], normals[face]
    )
    return gap, normal


def _with_heights(part: Solid, p: Array, gap: Array, normal: Array, metres: float) -> tuple[Array, Array]:
    under, over = part.bottom - p[:, 2], p[:, 2] - part.top
    upright = np.maximum(under, over)
    up = np.where(over >= under, 1.0, -1.0)
    corner = (gap > 0) & (upright > 0)
    with_corner = np.hypot(gap, np.maximum(upright, 0.0))
    distance = np.where(corner, with_corner, np.maximum(gap, upright))
    lengths = np.where(corner, with_corner, 1.0)
    flat = np.where(corner, gap, gap >= upright) / lengths
    tall = np.where(corner, upright, gap < upright) / lengths
    turned = normal * flat[:, None]
    turned[:, 2] = up * tall
    return distance - metres, turned


def _outward(a: tuple[float, float], b: tuple[float, float]) -> Array:
    side = np.array([b[1] - a[1], a[0] - b[0], 0.0])  # the polygon runs counter-clockwise
    return np.asarray(side / np.linalg.norm(side))
