"""The parts of a surface near points, boxes and segments."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.tree import LEAF_TRIANGLES, Pairs, Surface, box_distances, search
from shotc.geom.surface.triangles import closest, dot, segment_distances

BATCH_ITEMS = 2048
"""Queries that are processed together, so that their pairs fit the processor's cache."""
ROUNDING_TOLERANCE = 1e-9
"""Tolerance of the distance of a box compared with a triangle in it: metres, and share of the distance."""
CENTRE_WEIGHT = 0.25
"""Weight of the squared distance from a box's middle, relative to that from the box, in the descent."""
LONGEST_SEGMENT_M = 4.0
"""Longest part of a segment, metres; longer segments are cut, because an oblique one has too large a box."""


@dataclass(frozen=True, slots=True, eq=False)
class NearestOnSurface:
    """The nearest points of a surface.

    distance : (K,), metres; inf if nothing is nearer than the limit
    point    : (K, 3), on the surface; NaN if there is none
    triangle : (K,), index in the surface; -1 if there is none
    """

    distance: Array
    point: Array
    triangle: IntArray


def nearest(surface: Surface, p: Array, limit: Array | float = np.inf) -> NearestOnSurface:
    """Return the nearest surface points to points (K, 3) within ``limit``, metres, scalar or (K,)."""
    count = len(p)
    closest_points = NearestOnSurface(np.full(count, np.inf), np.full((count, 3), np.nan), np.full(count, -1))
    limits = np.broadcast_to(np.asarray(limit, dtype=np.float64), (count,))
    for start in range(0, count, BATCH_ITEMS):
        part = slice(start, start + BATCH_ITEMS)
        _nearest(
            surface,
            p[part],
            limits[part],
            NearestOnSurface(*(getattr(closest_points, f)[part] for f in _FIELDS)),
        )
    return closest_points


_FIELDS = ("distance", "point", "triangle")


def _nearest(surface: Surface, p: Array, limit: Array, out: NearestOnSurface) -> None:
    if not len(surface):
        return
    reach = limit.copy()

    def meets(item: IntArray, low: Array, high: Array) -> Mask:
        its = p[item]
        np.minimum.at(
            reach, item, _surely_within(its, low, high) * (1.0 + ROUNDING_TOLERANCE) + ROUNDING_TOLERANCE
        )
        return np.asarray(box_distances(its, its, low, high) < reach[item])

    pairs = search(surface, len(p), meets)
    at = closest(surface.triangles[pairs.triangle], p[pairs.item])
    item, best = pairs.best(at.distance)
    nearer = at.distance[best] < limit[item]
    item, best = item[nearer], best[nearer]
    out.distance[item] = at.distance[best]
    out.point[item] = at.point[best]
    out.triangle[item] = pairs.triangle[best]


def _surely_within(p: Array, low: Array, high: Array) -> Array:
    """Return upper bounds (K,) on the distance of points from the triangles in boxes, shapes (K, 3).

    Each face of a box touches a triangle. The bound is that of the nearer face of some axis, at the farther
    ends of the other axes (Roussopoulos et al. 1995).
    """
    to_low, to_high = (p - low) ** 2, (p - high) ** 2
    nearer, farther = np.minimum(to_low, to_high), np.maximum(to_low, to_high)
    return np.asarray(np.sqrt(farther.sum(axis=1) + (nearer - farther).min(axis=1)))


def some_distance(surface: Surface, p: Array) -> Array:
    """Return the distances (K,) of points (K, 3) from some near triangle: upper bounds on the distance."""
    top = len(surface.low) - 1
    each = np.arange(len(p))
    nodes = np.broadcast_to(np.arange(len(surface.low[top])), (len(p), len(surface.low[top])))
    for level in range(top, -1, -1):
        low, high = surface.low[level][nodes], surface.high[level][nodes]
        apart = np.maximum(np.maximum(low - p[:, None], p[:, None] - high), 0.0)
        off = 0.5 * (low + high) - p[:, None]  # the middle decides between boxes that contain the point
        node = nodes[each, (dot(apart, apart) + CENTRE_WEIGHT * dot(off, off)).argmin(axis=1)]
        below = len(surface.low[level - 1]) if level else len(surface)
        nodes = np.minimum(LEAF_TRIANGLES * node[:, None] + np.arange(LEAF_TRIANGLES), below - 1)
    triangles = surface.triangles[nodes.ravel()]
    distances = closest(triangles, np.repeat(p, LEAF_TRIANGLES, axis=0)).distance
    return np.asarray(distances.reshape(-1, LEAF_TRIANGLES).min(axis=1))


def within(surface: Surface, low: Array, high: Array, reach: Array | float) -> Pairs:
    """Return the triangles with boxes nearer than ``reach``, metres, to boxes low-high, (K, 3) each."""
    reaches = np.broadcast_to(np.asarray(reach, dtype=np.float64), (len(low),))

    def meets(item: IntArray, its_low: Array, its_high: Array) -> Mask:
        return box_distances(low[item], high[item], its_low, its_high) < reaches[item]

    return search(surface, len(low), meets)


def comes_within(surface: Surface, a: Array, b: Array, distance: Array | float) -> Mask:
    """Return which segments a-b, shapes (K, 3), come nearer to a surface than a distance, metres; (K,)."""
    out = np.zeros(len(a), dtype=bool)
    limits = np.broadcast_to(np.asarray(distance, dtype=np.float64), (len(a),))
    parts = np.maximum(1, np.ceil(np.linalg.norm(b - a, axis=1) / LONGEST_SEGMENT_M)).astype(np.intp)
    owner = np.repeat(np.arange(len(a)), parts)
    step = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    side, share = (b - a)[owner], 1.0 / parts[owner][:, None]
    begin = a[owner] + side * (step[:, None] * share)
    end = np.where(
        (step + 1 == parts[owner])[:, None], b[owner], a[owner] + side * ((step + 1)[:, None] * share)
    )
    for start in range(0, len(owner), BATCH_ITEMS):
        part = slice(start, start + BATCH_ITEMS)
        p, q, of = begin[part], end[part], owner[part]
        pairs = within(surface, np.minimum(p, q), np.maximum(p, q), limits[of])
        pairs = pairs.pick(~out[of[pairs.item]])
        apart = segment_distances(surface.triangles[pairs.triangle], p[pairs.item], q[pairs.item])
        out[of[pairs.item[apart < limits[of[pairs.item]]]]] = True
    return out
