"""Elementwise operations on triangles, points and segments: closest points, distances, subdivision.

A triangle may be degenerate, a segment or a point; then it consists of its edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask

TINY_SQUARE = 1e-300  # m^2 or m^4, replaces a zero length or area
_NEXT = [1, 2, 0]


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products (...) of vectors (..., D)."""
    return np.asarray(np.einsum("...d,...d->...", a, b))


def cross(a: Array, b: Array) -> Array:
    """Return the vector products over the last axis, shape (..., 3)."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def lowest(corners: Array) -> Array:
    """Return the lower corners (K, 3) of boxes around triangles (K, 3, 3)."""
    # corners.min(axis=1) takes three times as long.
    return np.asarray(np.minimum(np.minimum(corners[:, 0], corners[:, 1]), corners[:, 2]))


def highest(corners: Array) -> Array:
    """Return the upper corners (K, 3) of boxes round triangles (K, 3, 3)."""
    return np.asarray(np.maximum(np.maximum(corners[:, 0], corners[:, 1]), corners[:, 2]))


def without_size(triangles: Array) -> Mask:
    """Return which triangles (K, 3, 3) are points, (K,)."""
    first = triangles[:, 0]
    return np.asarray(((first == triangles[:, 1]) & (first == triangles[:, 2])).all(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class Closest:
    """Points of triangles, shape (K, 3), and their distances from the query, (K,), metres."""

    point: Array
    distance: Array


def closest(triangles: Array, p: Array) -> Closest:
    """Return the point of each triangle (K, 3, 3) that is closest to a point (K, 3).

    The result is a weighted mean of corners, so it is on the triangle in spite of rounding.
    """
    edges = triangles[:, _NEXT] - triangles
    offset = p[:, None] - triangles
    along = np.clip(dot(offset, edges) / np.maximum(dot(edges, edges), TINY_SQUARE), 0.0, 1.0)
    feet = triangles + along[..., None] * edges
    off = p[:, None] - feet
    squares = dot(off, off)
    each, side = np.arange(len(p)), squares.argmin(axis=1)
    point, square = feet[each, side], squares[each, side]
    normal = cross(edges[:, 0], edges[:, 1])
    # Twice the signed areas of the three triangles between the foot on the plane and the edges.
    areas = dot(normal[:, None], cross(edges, offset))
    above = np.flatnonzero((areas > 0.0).all(axis=1))
    if len(above):
        weights = areas[above][:, _NEXT]  # the weight of a corner is the area at the opposite edge
        weights /= weights.sum(axis=1, keepdims=True)
        foot = np.einsum("kv,kvd->kd", weights, triangles[above])
        its_square = dot(p[above] - foot, p[above] - foot)
        nearer = its_square < square[above]
        point[above[nearer]] = foot[nearer]
        square[above[nearer]] = its_square[nearer]
    return Closest(point, np.sqrt(square))


def segment_distances(triangles: Array, a: Array, b: Array) -> Array:
    """Return the distances (K,) of triangles (K, 3, 3) from segments a-b, (K, 3) each, metres."""
    best = np.minimum(closest(triangles, a).distance, closest(triangles, b).distance)
    for corner in range(3):
        best = np.minimum(best, _between(triangles[:, corner], triangles[:, _NEXT[corner]], a, b))
    return np.where(pierced(triangles, a, b), 0.0, best)


def _between(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the distances of segments a-b and c-d (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = dot(u, u), dot(v, v), dot(u, v)
    uw, vw = dot(u, w), dot(v, w)
    spread = uu * vv - uv * uv
    s = np.clip(np.where(spread > 0.0, (uv * vw - uw * vv) / np.maximum(spread, TINY_SQUARE), 0.0), 0.0, 1.0)
    t = np.clip((uv * s + vw) / np.maximum(vv, TINY_SQUARE), 0.0, 1.0)
    s = np.clip((uv * t - uw) / np.maximum(uu, TINY_SQUARE), 0.0, 1.0)
    gap = w + s[:, None] * u - t[:, None] * v
    return np.asarray(np.sqrt(dot(gap, gap)))


def pierced(triangles: Array, a: Array, b: Array) -> Mask:
    """Return which segments a-b, (K, 3) each, cross triangles (K, 3, 3) off their edges, (K,)."""
    edges = triangles[:, _NEXT] - triangles
    normal = cross(edges[:, 0], edges[:, 1])
    one, other = dot(a - triangles[:, 0], normal), dot(b - triangles[:, 0], normal)
    turns = dot(cross(edges, a[:, None] - triangles), (b - a)[:, None])
    same = (turns > 0.0).all(axis=1) | (turns < 0.0).all(axis=1)
    return np.asarray(same & (one * other < 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Halved:
    """A subdivision of given triangles: triangles (N, 3, 3).

    source : (N,), index of each one's given triangle
    """

    triangles: Array
    source: IntArray


def halved(triangles: Array, longest: float) -> Halved:
    """Split triangles (T, 3, 3) at their longest edges until none is longer than ``longest`` metres."""
    finished: list[Halved] = []
    rest, source = triangles, np.arange(len(triangles))
    while len(rest):
        squares = dot(rest[:, _NEXT] - rest, rest[:, _NEXT] - rest)
        long = squares.max(axis=1) > longest**2
        finished.append(Halved(rest[~long], source[~long]))
        rest, source, side = rest[long], source[long], squares[long].argmax(axis=1)
        each = np.arange(len(rest))
        a, b, c = (rest[each, (side + step) % 3] for step in range(3))
        middle = 0.5 * (a + b)
        rest = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
        source = np.concatenate([source, source])
    return Halved(
        np.concatenate([np.zeros((0, 3, 3)), *(each.triangles for each in finished)]),
        np.concatenate([np.zeros(0, dtype=np.intp), *(each.source for each in finished)]),
    )
