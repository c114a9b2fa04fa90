"""Solids for whole arrays of points: distance, support and lines of sight. Mirrors geom.solids."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts

FAR = 1e7
"""Stands for an unlimited height, metres: beyond any flight, small enough for exact millimetres."""


SEAM = 1e-9
"""How far prisms reach beyond their walls against a sight line, metres: above the rounding of a flight's
coordinates, so that no line slips between two convex parts of one solid."""


def separation(part: Solid, points: Array) -> tuple[Array, Array]:
    """Return distances (M,) of points (M, 3) from a convex solid, 0 inside, and unit normals (M, 3).

    The normal points from the nearest place of the solid to the point; 0 inside.
    """
    bottom, top = _heights(part)
    nearest_z = np.clip(points[:, 2], bottom, top)
    if isinstance(part, Cylinder):
        flat = points[:, :2] - np.array(part.centre)
        radial = np.hypot(flat[:, 0], flat[:, 1])
        away = flat * (1.0 - np.minimum(1.0, part.radius / np.maximum(radial, 1e-300)))[:, None]
    else:
        away = points[:, :2] - _nearest_on_footprint(part, points[:, :2])
    offset = np.column_stack([away, points[:, 2] - nearest_z])
    distance = np.sqrt(np.einsum("md,md->m", offset, offset))
    return distance, offset / np.where(distance > 0, distance, 1.0)[:, None]


def support(part: Solid, normals: Array) -> Array:
    """Return max of n.x over the convex solid for normals of shape (M, 3)."""
    bottom, top = _heights(part)
    tall = np.maximum(normals[:, 2] * bottom, normals[:, 2] * top)
    if isinstance(part, Cylinder):
        reach = normals[:, :2] @ np.array(part.centre) + part.radius * np.hypot(normals[:, 0], normals[:, 1])
    else:
        reach = (normals[:, :2] @ np.array(part.points).T).max(axis=1)
    return np.asarray(reach + tall)


def signed_distance(solid: Solid, points: Array) -> Array:
    """Return distances (M,) of points (M, 3) from the solid; inside, minus the depth below its surface."""
    outside = np.min([separation(part, points)[0] for part in convex_parts(solid)], axis=0)
    return np.where(outside > 0, outside, -_depth(solid, points))


def _depth(solid: Solid, points: Array) -> Array:
    bottom, top = _heights(solid)
    upright = np.minimum(points[:, 2] - bottom, top - points[:, 2])
    if isinstance(solid, Cylinder):
        flat = points[:, :2] - np.array(solid.centre)
        across = solid.radius - np.hypot(flat[:, 0], flat[:, 1])
    else:
        across = np.sqrt(_edge_distances(solid, points[:, :2])[0].min(axis=1))
    return np.asarray(np.maximum(np.minimum(upright, across), 0.0))


def _nearest_on_footprint(prism: Prism, flat: Array) -> Array:
    squares, nearest = _edge_distances(prism, flat)
    best = nearest[np.arange(len(flat)), squares.argmin(axis=1)]
    return np.where(_in_convex(prism, flat)[:, None], flat, best)


def _edge_distances(prism: Prism, flat: Array) -> tuple[Array, Array]:
    # Squared distances (M, k) from every edge and the nearest points on them (M, k, 2).
    start = np.array(prism.points)
    along = np.roll(start, -1, axis=0) - start
    squared = np.maximum(np.einsum("kd,kd->k", along, along), 1e-300)
    offset = flat[:, None, :] - start
    share = np.clip(np.einsum("mkd,kd->mk", offset, along) / squared, 0.0, 1.0)
    nearest = start + share[:, :, None] * along
    rest = flat[:, None, :] - nearest
    return np.einsum("mkd,mkd->mk", rest, rest), nearest


def _in_convex(prism: Prism, flat: Array) -> Mask:
    start = np.array(prism.points)
    along = np.roll(start, -1, axis=0) - start
    offset = flat[:, None, :] - start
    return np.asarray((along[:, 0] * offset[:, :, 1] - along[:, 1] * offset[:, :, 0] >= 0).all(axis=1))


def blocks(solid: Solid, eyes: Array, point: Array, least: float = 1e-6) -> Mask:
    """Tell which sight lines from eyes (M, 3) to a point, (3,) or (M, 3), run through the solid.

    least : metres inside that count; a line that only touches at a point is not blocked, one along a face
    of a prism (within a nanometre of a wall) is
    """
    along = point - eyes
    length = np.sqrt(np.einsum("md,md->m", along, along))
    inside = np.zeros(len(eyes))
    for part in convex_parts(solid):
        enter, leave = _overlap(part, eyes, along)
        inside += np.maximum(leave - enter, 0.0) * length
    return np.asarray(inside > least)


def _overlap(part: Solid, eyes: Array, along: Array) -> tuple[Array, Array]:
    # Shares of the segment at which it enters and leaves the convex part (leave < enter: never inside).
    bottom, top = _heights(part)
    zero, one = np.zeros(len(eyes)), np.ones(len(eyes))
    enter, leave = _clip(zero, one, eyes[:, 2] - top, along[:, 2])
    enter, leave = _clip(enter, leave, bottom - eyes[:, 2], -along[:, 2])
    if isinstance(part, Cylinder):
        return _through_round(part, eyes, along, (enter, leave))
    for (ax, ay), (bx, by) in pairwise((*part.points, part.points[0])):
        normal = np.array([by - ay, ax - bx])
        excess = (eyes[:, :2] - np.array([ax, ay])) @ normal - SEAM * np.hypot(*normal)
        enter, leave = _clip(enter, leave, excess, along[:, :2] @ normal)
    return enter, leave


def _clip(enter: Array, leave: Array, excess: Array, slope: Array) -> tuple[Array, Array]:
    # Keep the shares x at which excess + slope x <= 0.
    with np.errstate(over="ignore"):  # all but level, it is crossed beyond all numbers: at infinity
        crossing = -excess / np.where(slope == 0, 1.0, slope)
    never = (slope == 0) & (excess > 0)
    enter = np.where(slope < 0, np.maximum(enter, crossing), np.where(never, 1.0, enter))
    leave = np.where(slope > 0, np.minimum(leave, crossing), np.where(never, 0.0, leave))
    return enter, leave


def _through_round(
    part: Cylinder, eyes: Array, along: Array, span: tuple[Array, Array]
) -> tuple[Array, Array]:
    flat = eyes[:, :2] - np.array(part.centre)
    a = np.einsum("md,md->m", along[:, :2], along[:, :2])
    b = np.einsum("md,md->m", flat, along[:, :2])
    c = np.einsum("md,md->m", flat, flat) - part.radius**2
    upright = a < 1e-18
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    safe = np.where(upright, 1.0, a)
    first = np.where(upright, np.where(c <= 0, 0.0, 1.0), (-b - root) / safe)
    last = np.where(upright, np.where(c <= 0, 1.0, 0.0), (-b + root) / safe)
    missed = ~upright & (b * b - a * c <= 0)
    enter, leave = np.maximum(span[0], first), np.minimum(span[1], last)
    return enter, np.where(missed, enter, leave)


def _heights(solid: Solid) -> tuple[float, float]:
    return max(solid.bottom, -FAR), min(solid.top, FAR)
