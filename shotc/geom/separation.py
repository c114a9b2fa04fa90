"""How near two drones of fleets come, over all pairs and at every instant: a bound that is proved.

Heights are stretched (``geom.apart``), so that what is kept free is a ball or an upright cylinder as high as
wide, and "how near" is one number, metres: the stretched distance, or the larger of the horizontal and the
stretched vertical one. Time is cut into slabs within which no drone leaves a small ball by more than its own
control points do; a k-d tree of the balls gives every pair that could be the nearest. Of a pair the relative
motion is a cubic: along any fixed direction it is nowhere less than its control points. That bound closes
quadratically as intervals are halved, and only those that could still hold the least value are.

Arithmetic is IEEE double, as in ``geom.proof``, with the same gap.
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
"""Largest radius of a drone's ball in a slab, as a share of the horizontal distance that is to be kept."""

SAMPLE_SLABS = 128
"""Slabs in whose middle the nearest pair is looked for first: the nearer it is, the fewer pairs count."""

BLOCK_PAIRS = 50_000
"""Pairs looked at together, which bounds the memory."""


PAIR = 2

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Nearest:
    """The nearest that any two drones come, metres of horizontal distance (see the module).

    proven : no two are ever nearer; attained : how near ``first`` and ``second`` are at ``time``
    first, second : their rows, in the first and (of two fleets) the second fleet
    position : half way between them, p_W; all of it is inf and 0 where there is no pair
    """

    proven: float
    attained: float
    first: int
    second: int
    time: float
    position: tuple[float, float, float]


def closest(breaks: Array, coef: Array, apart: Distances, counted: Mask | None = None) -> Nearest:
    """Return the nearest that two drones of one fleet ever come.

    breaks : shape (P + 1,), seconds; coef : shape (n, P + 3, 3), metres, as in ``geom.fleet_spline``
    counted : who counts on each piece, shape (n, P); all, if None
    """
    fleet = replace(_Fleet.of(breaks, coef, apart), counted=counted)
    return _Search(fleet, None, apart).run()


def closest_between(
    breaks: Array, coef: Array, other_breaks: Array, other_coef: Array, apart: Distances
) -> Nearest:
    """Return the nearest that a drone of one fleet ever comes to one of another; arguments as in ``closest``.

    A fleet stands where it begins before its first break, and where it ends after its last one.
    """
    one, other = _Fleet.of(breaks, coef, apart), _Fleet.of(other_breaks, other_coef, apart)
    return _Search(one, other, apart).run()


def first_nearer(
    flown: tuple[Array, Array], beside: tuple[Array, Array], apart: Distances, marks: Array, least: float
) -> Nearest | None:
    """Return the nearest of two fleets in the first span in which it is not proved that they keep a distance.

    flown, beside : breaks and control points, as in ``closest``; least : metres
    marks : ends of the spans, rising, shape (M,), seconds
    """
    one, other = _Fleet.of(*flown, apart), _Fleet.of(*beside, apart)
    found = (_Search(one, other, apart, span).run() for span in pairwise(marks.tolist()))
    return next((nearest for nearest in found if nearest.proven < least), None)


@dataclass(frozen=True, slots=True, eq=False)
class _Fleet:
    """A fleet's motion in stretched space; ctrl : Bernstein control points, shape (P, n, 4, 3).

    counted : who counts on each piece, shape (n, P); all, if None
    """

    breaks: Array
    ctrl: Array
    counted: Mask | None = None

    @staticmethod
    def of(breaks: Array, coef: Array, apart: Distances) -> _Fleet:
        ctrl = np.moveaxis(pieces(breaks, coef), 1, 0)
        return _Fleet(breaks, np.ascontiguousarray(ctrl * np.array([1.0, 1.0, stretch(apart)])))

    def rows(self, low: float, high: float) -> Index | None:
        """Return the drones that count on an interval that holds no break, shape (m,); None for all."""
        if self.counted is None:
            return None
        k = int(np.searchsorted(self.breaks, 0.5 * (low + high), side="right")) - 1
        return np.flatnonzero(self.counted[:, k])

    def on(self, low: float, high: float) -> Array:
        """Return control points on an interval that holds no break, shape (n, 4, 3)."""
        if high <= self.breaks[0]:
            return np.repeat(self.ctrl[0, :, :1], 4, axis=1)
        if low >= self.breaks[-1]:
            return np.repeat(self.ctrl[-1, :, -1:], 4, axis=1)
        k = int(np.searchsorted(self.breaks, 0.5 * (low + high), side="right")) - 1
        start, width = self.breaks[k], self.breaks[k + 1] - self.breaks[k]
        cut = _cut(float((low - start) / width), float((high - start) / width))
        return np.asarray(np.matmul(cut, self.ctrl[k]))


def _cut(low: float, high: float) -> Array:
    """Return the matrix from control points of a cubic to those between two parameters (its blossom)."""
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
        # Whatever was put aside could not be nearer than this.
        proven = min(self.rest, self.best - self.gap())
        return Nearest(proven, self.best, *self.pair, self.time, self._position())

    def _slabs(self) -> list[tuple[float, float]]:
        """Cut time so that no drone leaves its ball by more than the reach; nobody counts in the rest."""
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
        """Return the control points of all drones, of the second fleet after those of the first."""
        one = self.one.on(low, high)
        return one if self.other is None else np.concatenate([one, self.other.on(low, high)])

    def _counted(self, low: float, high: float) -> tuple[Array, Index | None]:
        """Return the control points of those that count, and which they are; None for all."""
        rows, ctrl = self.one.rows(low, high), self._ctrl(low, high)
        return (ctrl, None) if rows is None else (ctrl[rows], rows)

    def _sample(self, low: float, high: float) -> None:
        """Look for the nearest pair in the middle of a slab."""
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
            return  # There is no second drone.
        second = int(at[first])
        apart = float(self.size((middle[first] - middle[second + skip])[None])[0])
        pair = (first, second) if rows is None else (int(rows[first]), int(rows[second]))
        self.note(apart, pair, 0.5 * (low + high))

    def _open(self, low: float, high: float) -> Iterator[PairMotions]:
        """Give the pairs of a slab that could be nearer than the nearest found so far."""
        ctrl, rows = self._counted(low, high)
        ctrl = _steady(ctrl)
        centre, radius = _balls(ctrl)
        # A ball holds the cylinder: what is near in its sense is near in the tree's.
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
        """Return the pairs of rows, of the one fleet or of both, whose centres are within reach."""
        if not np.isfinite(reach):
            return np.zeros((0, 2), dtype=np.intp)  # Nowhere is there a second drone.
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
    """Take out the motion that all drones have in common, which changes no distance."""
    return np.asarray(ctrl - ctrl.mean(axis=0)) if len(ctrl) else ctrl


def _balls(ctrl: Array) -> tuple[Array, Array]:
    """Return centres (n, 3) and radii (n,) of balls that hold the control points, and so the motion."""
    # Four at a time: numpy is ten times as slow along an axis that short.
    one, two, three, four = (ctrl[:, k] for k in range(4))
    low = np.minimum(np.minimum(one, two), np.minimum(three, four))
    high = np.maximum(np.maximum(one, two), np.maximum(three, four))
    centre = 0.5 * (low + high)
    sizes = [norm(part - centre) for part in (one, two, three, four)]
    return centre, np.maximum(np.maximum(sizes[0], sizes[1]), np.maximum(sizes[2], sizes[3]))
