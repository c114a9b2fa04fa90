"""A proved bound on the least distance of any two of many flights on one clock, each with its own breaks.

It does what ``geom.separation`` does, for cubics without common breaks. Time is cut into slabs. Within a slab
a drone has the bounding ball of its control points, minus the common motion of all drones. A k-d tree of
these balls gives every pair that may be the nearest. A flight stands before its start and after its end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import held_until, restrict
from shotc.geom.nearest_pair import Index, NearestPair, PairMotions
from shotc.geom.proof import norm
from shotc.geom.separation import Nearest

SLAB_S = 0.5
"""Seconds of a slab of flights without common breaks."""
MOST_SLABS = 20_000
BLOCK_PAIRS = 20_000
"""Pairs that are processed together, to bound the memory."""


def closest_of(
    flights: Sequence[Piecewise],
    apart: Distances,
    first: int | None = None,
    spans: Array | None = None,
) -> Nearest:
    """Return the nearest approach of two flights, in the metric of ``apart``.

    flights : cubics x, y, z over seconds, metres, at least two
    first : one flight of a pair is among the first so many, the other among the rest; None for any pair
    spans : interval in which each flight counts, shape (n, 2), seconds; its ends are breaks of the flight or
        beyond all of them; None for always
    """
    search = NearestPair(upright=apart.shape == "cylinder")
    high = stretch(apart)
    scale = np.array([1.0, 1.0, high])
    slabs = _slabs([Piecewise(f.breaks, f.ctrl * scale) for f in flights], spans)
    _sampled(search, slabs, first)
    pairs, index = _candidates(search, slabs, first)
    for at in range(0, len(pairs), BLOCK_PAIRS):
        part = slice(at, at + BLOCK_PAIRS)
        near = slabs.apart(pairs[part], index[part]) < search.best * _ball(search)
        if near.any():
            search.close(slabs.bag(pairs[part][near], index[part][near]))
    proven = min(search.rest, search.best - search.gap())
    return Nearest(proven, search.best, *search.pair, search.time, _between(flights, search))


def _ball(search: NearestPair) -> float:
    """Return the factor from the separation to the radius of a ball that contains its shape."""
    return float(np.sqrt(2.0)) if search.upright else 1.0


def _between(flights: Sequence[Piecewise], search: NearestPair) -> tuple[float, float, float]:
    if not np.isfinite(search.best):
        return (0.0, 0.0, 0.0)
    x, y, z = (0.5 * (flights[search.pair[0]](search.time) + flights[search.pair[1]](search.time))).tolist()
    return (x, y, z)


@dataclass(frozen=True, slots=True, eq=False)
class _Slabs:
    """Flights cut at the ends of slabs.

    ends : (S + 1,), seconds; cut : the flights on breaks that include these ends
    at : positions at the ends, (n, S + 1, 3)
    centre, radius : of bounding balls of each flight in each slab, minus the common motion, (n, S, 3), (n, S)
    spans : interval in which each flight counts, (n, 2), seconds
    """

    ends: Array
    cut: tuple[Piecewise, ...]
    at: Array
    centre: Array
    radius: Array
    spans: Array

    def counted(self, low: float, high: float) -> Index:
        """Return the indices of the flights that count at any time of an interval."""
        return np.flatnonzero((self.spans[:, 0] <= high) & (self.spans[:, 1] >= low))

    def apart(self, pairs: Index, slab: Index) -> Array:
        """Return the gaps between the balls of pairs, (M,)."""
        one, other = pairs[:, 0], pairs[:, 1]
        distance = norm(self.centre[one, slab] - self.centre[other, slab])
        return np.asarray(distance - self.radius[one, slab] - self.radius[other, slab])

    def bag(self, pairs: Index, slab: Index) -> PairMotions:
        """Return the relative motions of pairs in slabs."""
        parts = [self._relative(int(i), int(j), int(k)) for (i, j), k in zip(pairs, slab, strict=True)]
        count = [len(ends) for ends, _ in parts]
        return PairMotions(
            np.repeat(pairs, count, axis=0),
            np.concatenate([ends for ends, _ in parts]),
            np.concatenate([ctrl for _, ctrl in parts]),
        )

    def _relative(self, one: int, other: int, slab: int) -> tuple[Array, Array]:
        (a, x), (b, y) = self._part(one, slab), self._part(other, slab)
        if len(a) != len(b) or (a != b).any():
            breaks = np.union1d(a, b)
            x, y = (restrict(Piecewise(*each), breaks).ctrl for each in ((a, x), (b, y)))
            a = breaks
        middle, both = 0.5 * (a[:-1] + a[1:]), self.spans[[one, other]]
        counts = (middle > both[:, 0].max()) & (middle < both[:, 1].min())
        return np.stack([a[:-1], a[1:]], axis=1)[counts], (x - y)[counts]

    def _part(self, drone: int, slab: int) -> tuple[Array, Array]:
        curve = self.cut[drone]
        low, high = np.searchsorted(curve.breaks, self.ends[slab : slab + 2])
        return curve.breaks[low : high + 1], curve.ctrl[low:high]


def _slabs(flights: Sequence[Piecewise], spans: Array | None) -> _Slabs:
    end = max(f.end for f in flights)
    begin = min(f.start for f in flights)
    whole = [_standing(f, begin, end) for f in flights]
    common = whole[0].breaks
    if len(common) > MOST_SLABS or any(not np.array_equal(f.breaks, common) for f in whole):
        common = np.linspace(begin, end, min(max(1, ceil((end - begin) / SLAB_S)), MOST_SLABS) + 1)
    cut = tuple(restrict(f, np.union1d(f.breaks, common)) for f in whole)
    first = [np.searchsorted(f.breaks, common[:-1]) for f in cut]
    at = np.stack([np.concatenate([f.ctrl[k, 0], f.ctrl[-1:, -1]]) for f, k in zip(cut, first, strict=True)])
    shared = at.mean(axis=0)
    low, high = [], []
    for curve, k in zip(cut, first, strict=True):
        thirds = np.linspace(0.0, 1.0, 4)
        times = curve.breaks[:-1, None] + thirds * np.diff(curve.breaks)[:, None]
        moved = np.stack([np.interp(times, common, shared[:, d]) for d in range(3)], axis=-1)
        own = curve.ctrl - moved
        low.append(np.minimum.reduceat(own.min(axis=1), k))
        high.append(np.maximum.reduceat(own.max(axis=1), k))
    least, most = np.stack(low), np.stack(high)
    if spans is None:
        spans = np.tile([-np.inf, np.inf], (len(flights), 1))
    return _Slabs(common, cut, at, 0.5 * (least + most), 0.5 * norm(most - least), spans)


def _standing(curve: Piecewise, begin: float, end: float) -> Piecewise:
    """Return a curve extended by rest, from time ``begin`` to time ``end``."""
    if curve.start > begin:
        still = np.repeat(curve.ctrl[:1, :1], curve.degree + 1, axis=1)
        curve = Piecewise(np.insert(curve.breaks, 0, begin), np.concatenate([still, curve.ctrl]))
    return held_until(curve, end)


def _sampled(search: NearestPair, slabs: _Slabs, first: int | None) -> None:
    """Search the nearest pair at the ends of slabs, and one pair whose flights both count at some time."""
    by_start = np.argsort(slabs.spans[:, 0], kind="stable")
    for one, other in pairwise(by_start.tolist()):
        begin = float(np.clip(slabs.spans[other, 0], slabs.ends[0], slabs.ends[-1]))
        if first is None and slabs.spans[one, 1] >= begin:
            near = slabs.cut[one](begin) - slabs.cut[other](begin)
            search.note(float(search.size(near[None])[0]), (one, other), begin)
            break
    for k, time in enumerate(slabs.ends.tolist()):
        places = slabs.at[:, k]
        if first is None:
            rows = slabs.counted(time, time)
            if len(rows) < 2:
                continue
            distance, index = cKDTree(places[rows]).query(places[rows], k=2)
            row = int(np.argmin(distance[:, 1]))
            one = int(rows[row])
            other = int(rows[index[row, 1] if index[row, 1] != row else index[row, 0]])
        else:
            distance, index = cKDTree(places[first:]).query(places[:first])
            one = int(np.argmin(distance))
            other = first + int(index[one])
        search.note(float(search.size((places[one] - places[other])[None])[0]), (one, other), time)


def _candidates(search: NearestPair, slabs: _Slabs, first: int | None) -> tuple[Index, Index]:
    """Return pairs and slabs that may be nearer than the least distance so far, nearest first."""
    near_pairs, where = [np.zeros((0, 2), dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    bound = search.best * _ball(search)
    for k in range(len(slabs.ends) - 1):
        centre, radius = slabs.centre[:, k], slabs.radius[:, k]
        reach = bound + 2.0 * float(radius.max())
        if not np.isfinite(reach):
            continue
        if first is None:
            rows = slabs.counted(*slabs.ends[k : k + 2])
            pairs = rows[cKDTree(centre[rows]).query_pairs(reach, output_type="ndarray")]
        else:
            near = cKDTree(centre[:first]).sparse_distance_matrix(
                cKDTree(centre[first:]), reach, output_type="ndarray"
            )
            pairs = np.stack([near["i"], near["j"] + first], axis=1)
        index = np.full(len(pairs), k, dtype=np.intp)
        # A standing pair at an attained distance is no nearer.
        near_enough = slabs.apart(pairs, index) < bound - search.gap()
        near_pairs.append(pairs[near_enough])
        where.append(index[near_enough])
    pairs, index = np.concatenate(near_pairs), np.concatenate(where)
    order = np.argsort(slabs.apart(pairs, index), kind="stable")
    return pairs[order], index[order]
