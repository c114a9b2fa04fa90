"""The least size of a formation during a move for drones that keep vertical cylinders free, pair by pair.

On a common move p_i = c + a (x_i - c) + b (g_i - c) (``geom.arcs``) two drones at r0 from each other before
and at r1 after are at (a + b) r(u), with the direction u = b / (a + b) and r(u) = (1 - u) r0 + u r1. They
keep a vertical cylinder of radius and half height 1 free while

 (a + b) M(u) >= 1,    M(u) = max(length of the horizontal part of r(u), size of the vertical part of r(u)).

So in the direction u a formation needs the size a + b >= 1 / M(u), with the least M of all pairs. Where it is
smaller, some pair is too near, so no common move is shorter than the shortest with this size. M is convex,
because r is linear. Its tangents at both ends of an interval bound it in between.

If the matching gives r0.r1 >= 0 (``solvers.match``), few pairs need a size above 1, which is that of straight
paths: M^2 >= |r(u)|^2 / 2 >= ((1 - u)^2 |r0|^2 + u^2 |r1|^2) / 2, whose minimum is at least 1 if 1 / |r0|^2 +
1 / |r1|^2 <= 1 / 2. Those pairs are left out; all others are nearer than 2 before or after.

The shortest path in the plane of (a, b) from (1, 0) to (0, 1) that is nowhere smaller is a taut string:
points of the bound at which it would turn right are left out. Two drones side by side before and one above
the other after need a = 1 until b is 1, if both pictures are as dense as possible. The reverse holds for b.
The string then passes through (1, 1) and has length 2, while straight paths have sqrt 2. This is the minimum
for common scalars for all three axes. ``solvers.own_heights`` finds shorter moves by other scalars for the
heights.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.arcs import evenly, sampled

COARSE_INTERVALS, FINE_PARTS = 40, 16
"""Intervals of the direction, and parts of each in the fine search."""
NEAREST_AXIS_RATIO = 1e-5
"""Least ratio of b to a, and of a to b, that is distinguished from the axes. Directions are spread by the
logarithm of the ratio, because pairs far apart at one end need a size only in a narrow range of directions.
"""
REACH_RATIO = 2.0
"""Distance, above which before and after a pair needs no size."""
TOGETHER_PAIRS = 20_000
ROUNDED_SHARES = (0.03, 0.06, 0.1, 0.15, 0.2)
"""Shares of the path over which its corners are rounded on either side. The fleet slows down less there,
which may outweigh the longer path.
"""
SIZE_ROUNDS = 8
"""Most iterations in which a spline's control points are moved outwards."""
PIECE_SAMPLES = 16
ROUNDING_TOLERANCE = 1e-9


def _directions() -> Array:
    ratio = np.geomspace(NEAREST_AXIS_RATIO, 1.0 / NEAREST_AXIS_RATIO, COARSE_INTERVALS * FINE_PARTS - 1)
    return np.concatenate([[0.0], ratio / (1.0 + ratio), [1.0]])


DIRECTIONS = _directions()


@dataclass(frozen=True, slots=True, eq=False)
class LeastSize:
    """The least a + b by direction.

    size : between ``DIRECTIONS``, shape (K - 1,), at least 1
    """

    size: Array

    @property
    def most(self) -> float:
        """Return the largest size in any direction."""
        return float(self.size.max())

    @property
    def _at(self) -> Array:
        """Return a size for each of ``DIRECTIONS`` such that the chords between them are large enough."""
        at: Array = np.maximum(np.append(self.size, 1.0), np.insert(self.size, 0, 1.0))
        at[[0, -1]] = 1.0  # the formations themselves
        return at

    def ways(self) -> Iterator[Array]:
        """Yield (a, b) along the shortest path, then along wider ones with rounder corners, (N, 2) each."""
        line = self._shortest()
        yield line
        for share in ROUNDED_SHARES:
            yield self._rounded(line, round(share * len(line)))

    def _rounded(self, line: Array, reach: int) -> Array:
        """Return the moving averages of a path over ``reach`` points on either side, moved outwards until
        free.
        """
        ends = 2.0 * line[[0, -1]]
        mirrored = [ends[0] - line[reach:0:-1], line, ends[1] - line[-2 : -reach - 2 : -1]]
        smooth = uniform_filter1d(np.concatenate(mirrored), 2 * reach + 1, axis=0)[reach:-reach]
        size = smooth.sum(axis=1)
        lacking = np.maximum(np.interp(smooth[:, 1] / size, DIRECTIONS, self._at) / size, 1.0)
        # An average of local maxima is at least the value at each point.
        factor = uniform_filter1d(maximum_filter1d(lacking, 2 * reach + 1), 2 * reach + 1)
        steps = np.arange(len(line))
        inner = np.minimum(np.minimum(steps, steps[::-1]) / reach, 1.0)
        return evenly(smooth * (1.0 + inner * (factor - 1.0))[:, None])

    def _shortest(self) -> Array:
        at = self._at
        line: list[Array] = []
        for point in np.stack([(1.0 - DIRECTIONS) * at, DIRECTIONS * at], axis=1):
            while len(line) > 1 and _turn(line[-2], line[-1], point) <= 0.0:
                line.pop()
            line.append(point)
        return evenly(np.array(line))

    def pushed_out(self, ctrl: Array) -> Array:
        """Return control points (..., K, 2) of (a, b) moved outwards, so that their splines are large enough,
        or nearly so.
        """
        ctrl = ctrl.copy()
        pieces = ctrl.shape[-2] - 3
        for _ in range(SIZE_ROUNDS):
            lacking = 1.0 / np.minimum(self._shares(ctrl), 1.0)
            if lacking.max() <= 1.0 + ROUNDING_TOLERANCE:
                break
            # A control point is part of four pieces.
            wide = np.pad(lacking, [(0, 0)] * (lacking.ndim - 1) + [(3, 3)], constant_values=1.0)
            factor = np.max([wide[..., k : k + pieces + 3] for k in range(4)], axis=0)
            ctrl[..., 3:-3, :] *= factor[..., 3:-3, None]
        return ctrl

    def least_share(self, ctrl: Array) -> Array:
        """Return the least size of splines with control points (..., K, 2), over the required size."""
        return np.asarray(self._shares(ctrl).min(axis=-1))

    def _shares(self, ctrl: Array) -> Array:
        """Return the least ratio of each piece, shape (..., K - 3)."""
        a, b = sampled(ctrl, PIECE_SAMPLES)
        size = a + b
        return np.asarray((size / np.interp(b / size, DIRECTIONS, self._at)).min(axis=-1))


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]))


def least_size(before: Array, after: Array) -> LeastSize:
    """Return the size that all pairs together need.

    before, after : positions, shape (n, 3), heights scaled, in units of the separation
    """
    r0, r1 = _pairs(before, after)
    most = np.ones(len(DIRECTIONS) - 1)
    if not len(r0):
        return LeastSize(most)
    coarse = DIRECTIONS[::FINE_PARTS]
    low, high = _coarse(r0, r1, coarse)
    for k, (first, last) in enumerate(pairwise(range(0, len(DIRECTIONS), FINE_PARTS))):
        # A pair that is always farther apart than another pair's maximum determines nothing.
        asking = low[:, k] < min(high[k], 1.0)
        if asking.any():
            bound = _bounds(r0[asking], r1[asking], DIRECTIONS[first : last + 1]).min(axis=0)
            most[first:last] = np.maximum(1.0 / np.maximum(bound, ROUNDING_TOLERANCE), 1.0)
    return LeastSize(most)


def _pairs(before: Array, after: Array) -> tuple[Array, Array]:
    """Return r0 and r1 of the pairs that may need a size, shape (P, 3) each."""
    near = [
        cKDTree(p).query_pairs(REACH_RATIO, output_type="ndarray").astype(np.int64) for p in (before, after)
    ]
    count = len(before)
    both = np.unique(np.concatenate([pairs @ [count, 1] for pairs in near]))
    i, j = both // count, both % count
    r0, r1 = before[i] - before[j], after[i] - after[j]
    with np.errstate(divide="ignore"):
        inverse = 1.0 / np.einsum("pd,pd->p", r0, r0) + 1.0 / np.einsum("pd,pd->p", r1, r1)
    asking = inverse > 0.5
    return r0[asking], r1[asking]


def _coarse(r0: Array, r1: Array, directions: Array) -> tuple[Array, Array]:
    """Return lower bounds of M for each pair and interval, (P, K - 1); an upper bound of the least M, (K -
    1,).
    """
    low, high = np.empty((len(r0), len(directions) - 1)), np.full(len(directions) - 1, np.inf)
    for at in range(0, len(r0), TOGETHER_PAIRS):
        some = slice(at, at + TOGETHER_PAIRS)
        low[some] = _bounds(r0[some], r1[some], directions)
        ends = _sizes(r0[some], r1[some], directions)[0]
        high = np.minimum(high, np.maximum(ends[:, 1:], ends[:, :-1]).min(axis=0))
    return low, high


def _bounds(r0: Array, r1: Array, directions: Array) -> Array:
    """Return a lower bound of M for each pair and interval, by the tangents at its ends, (P, K - 1)."""
    sizes, slopes = _sizes(r0, r1, directions)
    first, last, fall, rise = sizes[:, :-1], sizes[:, 1:], slopes[:, :-1], slopes[:, 1:]
    wide = np.diff(directions)
    dips = (fall < 0.0) & (rise > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.where(dips, (last - first - rise * wide) / (fall - rise), 0.0)
    return np.asarray(np.where(dips, first + fall * np.clip(at, 0.0, wide), np.minimum(first, last)))


def _sizes(r0: Array, r1: Array, directions: Array) -> tuple[Array, Array]:
    """Return M of each pair in each direction, and a subgradient of it, shape (P, K) each."""
    move = r1 - r0
    x, y, z = (r0[:, k, None] + move[:, k, None] * directions for k in range(3))
    level, upright = np.hypot(x, y), np.abs(z)
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = np.where(level > 0.0, (x * move[:, :1] + y * move[:, 1:2]) / level, 0.0)
    slopes = np.where(level >= upright, turned, np.sign(z) * move[:, 2:])
    return np.maximum(level, upright), slopes
