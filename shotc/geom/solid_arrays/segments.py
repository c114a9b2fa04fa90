"""Segments and solids: distances, nearest points, and lines of sight that a solid blocks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import NO_AREA_M2, closest_points, distances, heights
from shotc.geom.solids import Cylinder, Solid, convex_parts

SEAM_M = 1e-9
"""Distance by which prisms are larger against a line of sight. It is above the rounding of a flight's
coordinates, so that no line passes between two convex parts of one solid."""

SETTLED_SHARE = 1e-7
"""Tolerance of a segment's nearest point, as a share of its length."""

MOST_ROUNDS = 60
"""Most iterations; about twelve suffice."""


def segment_distances(part: Solid, a: Array, b: Array) -> Array:
    """Return the distance of segments a-b, shapes (N, 3), to the convex solid; shape (N,), metres.

    The error is at most the square of SETTLED_SHARE of their length, or SETTLED_SHARE of it if they meet the
    solid.
    """
    near = distances(part, nearest_on_segments(part, a, b))
    return np.asarray(np.minimum.reduce([near, distances(part, a), distances(part, b)]))


def nearest_on_segments(part: Solid, a: Array, b: Array) -> Array:
    """Return the point of each segment a-b, shapes (N, 3), that is nearest to the solid or inside it, (N, 3).

    The squared distance to a convex set is convex and smooth, so its slope rises along a segment. The root of
    the slope is found by the Illinois variant of false position, which halves the value of an end that stays
    twice.
    """
    side = b - a

    def slope(share: Array) -> Array:
        p = a + share[:, None] * side
        return np.asarray(np.einsum("nd,nd->n", p - closest_points(part, p), side))

    low, high = np.zeros(len(a)), np.ones(len(a))
    falls, rises = np.minimum(slope(low), 0.0), np.maximum(slope(high), 0.0)
    level = SETTLED_SHARE**2 * np.einsum("nd,nd->n", side, side) + NO_AREA_M2
    before, at = np.zeros(len(a)), low
    for _ in range(MOST_ROUNDS):
        at = low - falls / np.maximum(rises - falls, NO_AREA_M2) * (high - low)
        now = slope(at)
        beyond = now >= 0.0
        low, high = np.where(beyond, low, at), np.where(beyond, at, high)
        falls = np.where(beyond, np.where(before > 0.0, 0.5 * falls, falls), now)
        rises = np.where(beyond, now, np.where(before < 0.0, 0.5 * rises, rises))
        before = np.where(beyond, 1.0, -1.0)
        if ((high - low <= SETTLED_SHARE) | (np.abs(now) <= level)).all():
            break
    return np.asarray(a + at[:, None] * side)


def blocks(solid: Solid, eyes: Array, point: Array, least: float = 1e-6) -> Mask:
    """Return which lines of sight from eyes (M, 3) to a point, (3,) or (M, 3), cross the solid; shape (M,).

    least : least length inside that counts, metres. A line that touches the solid at a point is not blocked;
        one along a face of a prism (within a nanometre of a wall) is
    """
    along = point - eyes
    length = np.sqrt(np.einsum("md,md->m", along, along))
    inside = np.zeros(len(eyes))
    for part in convex_parts(solid):
        enter, leave = within(part, eyes, along)
        inside += np.maximum(leave - enter, 0.0) * length
    return np.asarray(inside > least)


def within(part: Solid, eyes: Array, along: Array) -> tuple[Array, Array]:
    """Return the shares of segments from eyes (M, 3) at which they enter and leave a convex solid, (M,) each.

    along : from start to end, (M, 3). A segment outside the solid has leave <= enter.
    """
    bottom, top = heights(part)
    zero, one = np.zeros(len(eyes)), np.ones(len(eyes))
    enter, leave = _clip(zero, one, eyes[:, 2] - top, along[:, 2])
    enter, leave = _clip(enter, leave, bottom - eyes[:, 2], -along[:, 2])
    if isinstance(part, Cylinder):
        return _through_round(part, eyes, along, (enter, leave))
    for (ax, ay), (bx, by) in pairwise((*part.points, part.points[0])):
        normal = np.array([by - ay, ax - bx])
        excess = (eyes[:, :2] - np.array([ax, ay])) @ normal - SEAM_M * np.hypot(*normal)
        enter, leave = _clip(enter, leave, excess, along[:, :2] @ normal)
    return enter, leave


def _clip(enter: Array, leave: Array, excess: Array, slope: Array) -> tuple[Array, Array]:
    # Keep the shares x at which excess + slope x <= 0.
    with np.errstate(over="ignore"):  # a nearly parallel line crosses at infinity
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
