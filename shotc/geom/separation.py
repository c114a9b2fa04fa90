"""A proved bound on the least distance of two drones of fleets, over all pairs and at every instant.

Heights are stretched (``geom.apart``), so that the separation is a ball, or an upright cylinder as high as
wide. The distance is one number, metres: the stretched distance, or the larger of the horizontal and the
stretched vertical distance. Time is cut into slabs in which each drone stays in a small ball around its
control points. A k-d tree of the balls gives every pair that may be the nearest. The relative motion of a
pair is a cubic; along any fixed direction it is at least the minimum of its control points. The error of this
bound falls quadratically as intervals are halved. Only intervals that may contain the minimum are halved.

Arithmetic is IEEE double with the same gap as in ``geom.proof``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import pieces
from shotc.geom.nearest_pair import Index, NearestPair, PairMotions, joined, midway
from shotc.geom.proof import norm

REACH_SHARE = 0.4
"""Largest radius of a drone's ball in a slab, as a share of the required horizontal distance."""

SAMPLE_SLABS = 128
"""Slabs in whose middle the nearest pair is searched first; a smaller distance leaves fewer pairs."""

BLOCK_PAIRS = 50_000
"""Pairs that are processed together, to bound the memory."""


PAIR = 2

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Nearest:
    """The least distance of any two drones, metres, in the stretched metric (see the module).

    proven : a lower bound on it; attained : the distance of ``first`` and ``second`` at ``time``
    first, second : their rows, in the first and (for two fleets) the second fleet
    position : half way between them, p_W. Without a pair the distances are inf and the rest is 0.
    """

    proven: float
    attained: float
    first: int
    second: int
    time: float
    position: tuple[float, float, float]


def closest(breaks: Array, coef: Array, apart: Distances, counted: Mask | None = None) -> Nearest:
    """Return the nearest approach of two drones of one fleet.

    breaks : shape (P + 1,), seconds; coef : shape (n, P + 3, 3), metres, as in ``geom.fleet_spline``
    counted : whether each drone counts on each piece, shape (n, P); None for all
    """
    fleet = replace(_Fleet.of(breaks, coef, apart), counted=counted)
    return _Search(fleet, None, apart).run()


def closest_between(
    breaks: Array, coef: Array, other_breaks: Array, other_coef: Array, apart: Distances
) -> Nearest:
    """Return the nearest approach of a drone of one fleet to one of another; arguments as in ``closest``.

    A fleet stands before its first break and after its last one.
    """
    one, other = _Fleet.of(breaks, coef, apart), _Fleet.of(other_breaks, other_coef, apart)
    return _Search(one, other, apart).run()


def first_nearer(
    flown: tuple[Array, Array], beside: tuple[Array, Array], apart: Distances, marks: Array, least: float
) -> Nearest | None:
    """Return the nearest approach of two fleets in the first interval without a proof of a distance, or None.

    flown, beside : breaks and control points, as in ``closest``; least : the distance, metres
    marks : ends of the intervals, rising, shape (M,), seconds
    """
    one, other = _Fleet.of(*flown, apart), _Fleet.of(*beside, apart)
    results = (_Search(one, other, apart, span).run() for span in pairwise(marks.tolist()))
    return next((nearest for nearest in results if nearest.proven < least), None)


@dataclass(frozen=True, slots=True, eq=False)
class _Fleet:
    """A fleet's motion in stretched space; ctrl : Bernstein control points, shape (P, n, 4, 3).

    counted : whether each drone counts on each piece, shape (n, P); None for all
    """

    breaks: Array
    ctrl: Array
    counted: Mask | None = None

    @staticmethod
    def of(breaks: Array, coef: Array, apart: Distances) -> _Fleet:
        ctrl = np.moveaxis(pieces(breaks, coef), 1, 0)
        return _Fleet(breaks, np.ascontiguousarray(ctrl * np.array([1.0, 1.0, stretch(apart)])))

    def rows(self, low: float, high: float) -> Index | None:
        """Return the rows (m,) of the drones that count on an interval without breaks; None for all."""
        if self.counted is None:
            return None
        return np.flatnonzero(self.counted[:, self._piece(low, high)])

    def on(self, low: float, high: float) -> Array:
        """Return the control points on an interval without breaks, shape (n, 4, 3)."""
        if high <= self.breaks[0]:
            return np.repeat(self.ctrl[0, :, :1], 4, axis=1)
        if low >= self.breaks[-1]:
            return np.repeat(self.ctrl[-1, :, -1:], 4, axis=1)
        k = self._piece(low, high)
        start, width = self.breaks[k], self.breaks[k + 1] - self.breaks[k]
        cut = _cut(float((low - start) / width), float((high - start) / width))
        return np.asarray(np.matmul(cut, self.ctrl[k]))

    def _piece(self, low: float, high: float) -> int:
        return int(np.searchsorted(self.breaks, 0.5 * (low + high), side="right")) - 1


def _cut(low: float, high: float) -> Array:
    """Return the (4, 4) matrix from a cubic's control points to those between two parameters (blossom)."""
    rows = []
    for k in range(4):
        row = np.array([1.0])
        for x in (low,) * (3 - k) + (high,) * k:
            row = np.convolve(row, [1.0 - x, x])
        rows.append(row)
    return np.array(rows)


class _Search(NearestPair):
    """Branch and bound over slabs and pairs."""

    def __init__(
        self,
        one: _Fleet,
        other: _Fleet | None,
        apart: Distances,
        span: tuple[float, float] | None = None,
    ) -> None:
        self.one, self.other, self.apart, self.span = one, other, apart, span
        super().__init__(upright=apart.shape == "cylinder")

    def run(self) -> Nearest:
        slabs = self._slabs()
        for low, high in slabs[:: max(1, len(slabs) // SAMPLE_SLABS)]:
            self._sample(low, high)
        bags: list[PairMotions] = []
        for bag in (bag for slab in slabs for bag in self._open(*slab)):
            bags.append(bag)
            if sum(len(bag.ends) for bag in bags) > BLOCK_PAIRS:
                self.close(joined(bags))
                bags = []
        self.close(joined(bags))
        # The discarded intervals cannot contain a smaller distance.
        proven = min(self.rest, self.best - self.gap())
        return Nearest(proven, self.best, *self.pair, self.time, self._position())

    def _slabs(self) -> list[tuple[float, float]]:
        """Cut time so that no drone's ball exceeds the reach; intervals without a pair are omitted."""
        breaks = self.one.breaks
        if self.other is not None:
            breaks = np.unique(np.concatenate([breaks, self.other.breaks]))
        if self.span is not None:
            low, high = self.span
            breaks = np.array([low, *breaks[(breaks > low) & (breaks < high)], high])
        slabs: list[tuple[float, float]] = []
        reach = REACH_SHARE * self.apart.across
        for low, high in pairwise(breaks.tolist()):
            ctrl, rows = self._counted(low, high)
            if rows is not None and len(rows) < PAIR:
                continue
            _, radius = _balls(_steady(ctrl))
            parts = max(1, int(np.ceil(radius.max(initial=0.0) / reach)))
            ends = np.linspace(low, high, parts + 1)
            slabs += list(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
        return slabs

    def _ctrl(self, low: float, high: float) -> Array:
        """Return the control points of all drones, those of the first fleet first."""
        one = self.one.on(low, high)
        return one if self.other is None else np.concatenate([one, self.other.on(low, high)])

    def _counted(self, low: float, high: float) -> tuple[Array, Index | None]:
        """Return the control points of the drones that count, and their rows; None for all."""
        rows, ctrl = self.one.rows(low, high), self._ctrl(low, high)
        return (ctrl, None) if rows is None else (ctrl[rows], rows)

    def _sample(self, low: float, high: float) -> None:
        """Search the nearest pair in the middle of a slab."""
        ctrl, rows = self._counted(low, high)
        middle = midway(ctrl)
        count = len(self.one.ctrl[0])
        if self.other is None:
            distance, at = cKDTree(middle).query(middle, k=2)
            distance, at, skip = distance[:, 1], at[:, 1], 0
        else:
            distance, at = cKDTree(middle[count:]).query(middle[:count])
            skip = count
        first = int(np.argmin(distance))
        if not np.isfinite(distance[first]):
            return  # There is no pair.
        second = int(at[first])
        apart = float(self.size((middle[first] - middle[second + skip])[None])[0])
        pair = (first, second) if rows is None else (int(rows[first]), int(rows[second]))
        self.note(apart, pair, 0.5 * (low + high))

    def _open(self, low: float, high: float) -> Iterator[PairMotions]:
        """Yield the pairs of a slab that may be nearer than the least distance so far."""
        ctrl, rows = self._counted(low, high)
        ctrl = _steady(ctrl)
        centre, radius = _balls(ctrl)
        # A ball contains the cylinder: a pair that is near in its metric is near in the tree's.
        far = self.best * (np.sqrt(2.0) if self.upright else 1.0)
        skip = 0 if self.other is None else len(self.one.ctrl[0])
        candidates = self._candidates(centre, far + 2.0 * float(radius.max(initial=0.0)))
        for at in range(0, len(candidates), BLOCK_PAIRS):
            pairs = candidates[at : at + BLOCK_PAIRS]
            first, second = pairs[:, 0], pairs[:, 1] + skip
            near = norm(centre[first] - centre[second]) - radius[first] - radius[second] < far
            relative = ctrl[first[near]] - ctrl[second[near]]
            named = pairs[near] if rows is None else rows[pairs[near]]
            bag = PairMotions(named, np.broadcast_to([low, high], (len(relative), 2)), relative)
            yield bag.pick(self.least(relative) < self.best - self.gap())

    def _candidates(self, centre: Array, reach: float) -> Index:
        """Return the pairs of rows, in one fleet or between both, whose centres are within reach."""
        if not np.isfinite(reach):
            return np.zeros((0, 2), dtype=np.intp)  # There is no pair.
        if self.other is None:
            return np.asarray(cKDTree(centre).query_pairs(reach, output_type="ndarray"))
        count = len(self.one.ctrl[0])
        tree = cKDTree(centre[count:])
        near = cKDTree(centre[:count]).sparse_distance_matrix(tree, reach, output_type="ndarray")
        return np.stack([near["i"], near["j"]], axis=1)

    def _position(self) -> tuple[float, float, float]:
        first, second = self.pair
        if not np.isfinite(self.best):
            return (0.0, 0.0, 0.0)
        skip = 0 if self.other is None else len(self.one.ctrl[0])
        at = self._ctrl(self.time, self.time)[[first, second + skip], 0].mean(axis=0)
        x, y, z = at / [1.0, 1.0, stretch(self.apart)]
        return (float(x), float(y), float(z))


def _steady(ctrl: Array) -> Array:
    """Return the control points minus the common motion of all drones, which changes no distance."""
    return np.asarray(ctrl - ctrl.mean(axis=0)) if len(ctrl) else ctrl


def _balls(ctrl: Array) -> tuple[Array, Array]:
    """Return centres (n, 3) and radii (n,) of bounding balls of the control points, and so of the motion."""
    # One control point at a time: numpy is ten times slower along such a short axis.
    one, two, three, four = (ctrl[:, k] for k in range(4))
    low = np.minimum(np.minimum(one, two), np.minimum(three, four))
    high = np.maximum(np.maximum(one, two), np.maximum(three, four))
    centre = 0.5 * (low + high)
    sizes = [norm(part - centre) for part in (one, two, three, four)]
    return centre, np.maximum(np.maximum(sizes[0], sizes[1]), np.maximum(sizes[2], sizes[3]))
