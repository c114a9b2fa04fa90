"""A surface: triangles in a flat tree of boxes, in Morton order, without pointers.

Four triangles make a leaf, and four nodes make a node: node i of a level has the nodes 4i to 4i + 3 of the
level below. A search descends level by level with an array of pairs of a query and a node.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.triangles import Halved, dot, halved, highest, lowest

LEAF_TRIANGLES = 4
"""Triangles of a leaf, and children of a node."""
TOP_NODES = 16
"""Most nodes of the top level, where a search starts."""
GROUPED_POINTS = 16
"""Consecutive points that share one search."""
LONG_EDGE_RATIO = 8.0
"""Length of a triangle over the median longest edge above which it is halved; it would enlarge its leaf."""
SPARE_HALVES = 4096
"""Most halves of a few long triangles; with many triangles the limit is half their number."""
_SPREAD = (
    (32, 0x1F00000000FFFF),
    (16, 0x1F0000FF0000FF),
    (8, 0x100F00F00F00F00F),
    (4, 0x10C30C30C30C30C3),
    (2, 0x1249249249249249),
)
_AXIS_CELLS = 2**21 - 1  # of a Morton code, along each axis


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles with a tree of boxes.

    triangles : shape (N, 3, 3), metres of W; those of a leaf are consecutive
    source    : shape (N,), index of the given triangle that each one is, or is a part of
    low, high : corners of boxes, one array (n, 3) a level: leaves first, at most TOP_NODES boxes last
    disc      : radius of the discs by which triangles without size hide, metres; 0 if they hide nothing
    """

    triangles: Array
    source: IntArray
    low: tuple[Array, ...]
    high: tuple[Array, ...]
    disc: float = 0.0

    def __len__(self) -> int:
        return len(self.triangles)


def surface_of(triangles: Array) -> Surface:
    """Return the tree of triangles (N, 3, 3), metres of W; N may be 0.

    Raise ValueError if a corner is not finite or the shape is wrong.
    """
    given = np.ascontiguousarray(triangles, dtype=np.float64)
    if given.ndim != 3 or given.shape[1:] != (3, 3) or not np.isfinite(given).all():
        raise ValueError(f"triangles are finite and of shape (N, 3, 3), not {given.shape}")
    if not len(given):
        return Surface(given, np.zeros(0, dtype=np.intp), (), ())
    small = _without_long(given)
    order = np.argsort(_morton(small.triangles.mean(axis=1)), kind="stable")
    laid, source = small.triangles[order], small.source[order]
    low, high = [_grouped(lowest(laid), np.minimum)], [_grouped(highest(laid), np.maximum)]
    while len(low[-1]) > TOP_NODES:
        low.append(_grouped(low[-1], np.minimum))
        high.append(_grouped(high[-1], np.maximum))
    for array in (laid, source, *low, *high):
        array.setflags(write=False)
    return Surface(laid, source, tuple(low), tuple(high))


def _without_long(triangles: Array) -> Halved:
    """Halve triangles that are long compared with others: a few large ones would slow searches."""
    sides = triangles[:, [1, 2, 0]] - triangles
    edges = np.sqrt(dot(sides, sides).max(axis=1))
    limit = max(LONG_EDGE_RATIO * float(np.median(edges)), LONG_EDGE_RATIO * 1e-3 * float(edges.max()), 1e-9)
    while ((edges[edges > limit] / limit) ** 2).sum() > max(0.5 * len(edges), SPARE_HALVES):
        limit *= 2.0
    if not (edges > limit).any():
        return Halved(triangles.copy(), np.arange(len(triangles)))
    return halved(triangles, limit)


def _morton(points: Array) -> Array:
    """Return the Morton codes (N,) of points (N, 3); neighbours in this order are near (Morton 1966)."""
    low = points.min(axis=0)
    size = max(float((points - low).max()), 1e-9)  # one scale for all axes: cells are cubes
    cells = np.minimum((points - low) * (_AXIS_CELLS / size), _AXIS_CELLS).astype(np.uint64)
    for shift, mask in _SPREAD:
        cells = (cells | (cells << np.uint64(shift))) & np.uint64(mask)
    code: Array = cells[:, 0] | (cells[:, 1] << np.uint64(1)) | (cells[:, 2] << np.uint64(2))
    return code


def _grouped(boxes: Array, extreme: np.ufunc) -> Array:
    return np.asarray(extreme.reduceat(boxes, np.arange(0, len(boxes), LEAF_TRIANGLES), axis=0))


class TooMany(Exception):
    """A search exceeded its limit of pairs."""


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """Pairs of a query (item) and a triangle of the surface, as indices; shapes (K,), items in order."""

    item: IntArray
    triangle: IntArray

    def __len__(self) -> int:
        return len(self.item)

    def pick(self, which: Mask | slice) -> Pairs:
        """Return some of the pairs, by a mask of shape (K,) or a slice."""
        return Pairs(self.item[which], self.triangle[which])

    def best(self, value: Array) -> tuple[IntArray, IntArray]:
        """Return the distinct items, and for each the pair with the least of the values (K,)."""
        order = np.lexsort((value, self.item))
        item = self.item[order]
        first = np.flatnonzero(np.concatenate([[True], item[1:] != item[:-1]])) if len(item) else order
        return item[first], order[first]


Meets = Callable[[IntArray, Array, Array], Mask]
"""Whether queries (K,) may meet the content of boxes: low (K, 3), high (K, 3)."""


def search(surface: Surface, count: int, meets: Meets, most: int | None = None) -> Pairs:
    """Return the triangles whose boxes, and all boxes above them, meet each of ``count`` queries.

    most : limit of pairs of a query and a box at a time; raise TooMany beyond it
    """
    if not len(surface) or not count:
        return Pairs(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))
    top = len(surface.low[-1])
    item, node = np.repeat(np.arange(count), top), np.tile(np.arange(top), count)
    below = (*(len(low) for low in surface.low), 0)
    for level in range(len(surface.low) - 1, -1, -1):
        keep = meets(item, surface.low[level][node], surface.high[level][node])
        item, node = item[keep], node[keep]
        if most is not None and LEAF_TRIANGLES * len(item) > most:
            raise TooMany
        item = np.repeat(item, LEAF_TRIANGLES)
        node = (LEAF_TRIANGLES * node[:, None] + np.arange(LEAF_TRIANGLES)).ravel()
        inside = node < (below[level - 1] if level else len(surface))
        item, node = item[inside], node[inside]
    corners = surface.triangles[node]
    keep = meets(item, lowest(corners), highest(corners))
    return Pairs(item[keep], node[keep])


def in_plan(surface: Surface, low: Array, high: Array) -> Pairs:
    """Return the triangles whose boxes meet boxes low-high, shapes (K, 2 or 3), in the plan."""

    def meets(item: IntArray, its_low: Array, its_high: Array) -> Mask:
        return plan_boxes_meet(low[item], high[item], its_low, its_high)

    return search(surface, len(low), meets)


def under_points(surface: Surface, xy: Array) -> Pairs:
    """Return the triangles whose boxes contain points (K, 2) in the plan.

    Consecutive points share a search if they are near each other, as on a path.
    """
    starts = np.arange(0, len(xy), GROUPED_POINTS)
    if len(starts) < 2:
        return in_plan(surface, xy, xy)
    low, high = (extreme.reduceat(xy, starts, axis=0) for extreme in (np.minimum, np.maximum))
    if (high - low).mean() > (surface.high[0] - surface.low[0])[:, :2].mean():
        return in_plan(surface, xy, xy)
    pairs = in_plan(surface, low, high)
    point = starts[pairs.item][:, None] + np.arange(GROUPED_POINTS)
    inside = point < len(xy)
    item, triangle = point[inside], np.repeat(pairs.triangle, inside.sum(axis=1))
    corners = surface.triangles[triangle]
    keep = plan_boxes_meet(xy[item], xy[item], lowest(corners), highest(corners))
    order = np.argsort(item[keep], kind="stable")
    return Pairs(item[keep][order], triangle[keep][order])


def plan_boxes_meet(low: Array, high: Array, other_low: Array, other_high: Array) -> Mask:
    """Return which boxes meet others in the plan, shapes (K, 2 or 3); shape (K,)."""
    # Column by column: a reduction over such a short axis takes far longer.
    return np.asarray(
        (low[:, 0] <= other_high[:, 0])
        & (low[:, 1] <= other_high[:, 1])
        & (high[:, 0] >= other_low[:, 0])
        & (high[:, 1] >= other_low[:, 1])
    )


def box_distances(low: Array, high: Array, other_low: Array, other_high: Array) -> Array:
    """Return the distances (K,) of boxes from boxes, shapes (K, 3), 0 if they meet."""
    apart = np.maximum(np.maximum(other_low - high, low - other_high), 0.0)
    return np.asarray(np.sqrt(dot(apart, apart)))
