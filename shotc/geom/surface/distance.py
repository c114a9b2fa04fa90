"""Proved bounds on the distance of curves from a surface, for every instant.

The pieces of pairs of a piece and a triangle are halved (branch and bound). The distance of a piece from a
triangle is at least that of its control points along a fixed direction, here the direction from the triangle
to the middle of the piece. The surface has no inside: the distance is 0 where a curve crosses it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask, Pieces, join
from shotc.geom.proof import MOST_HALVINGS, OPEN_PIECES_LIMIT, ProvedExtreme
from shotc.geom.surface.near import nearest, some_distance
from shotc.geom.surface.tree import Pairs, Surface, TooMany, box_distances, search
from shotc.geom.surface.triangles import closest, dot, highest, lowest

Gap = Callable[[float], float]
PIECES_LIMIT = 50_000
"""Most pieces into which curves are cut, so that each one meets fewer boxes."""

MEASURED_PIECES = 8
"""Pieces whose middles are measured exactly before the search."""


@dataclass(frozen=True, slots=True)
class SurfaceBound(ProvedExtreme):
    """A bound, and the piece and triangle at which its value is attained.

    piece    : index of the given piece; -1 if there is none
    triangle : index of the triangle that the surface was made of; -1 if there is none
    """

    piece: int = -1
    triangle: int = -1


@dataclass(frozen=True, slots=True, eq=False)
class Numbered:
    """Pieces with the index of the given piece that each is a part of, shape (M,)."""

    pieces: Pieces
    source: IntArray

    def __len__(self) -> int:
        return len(self.source)

    def pick(self, which: Mask | IntArray) -> Numbered:
        """Return some of them, by a mask of shape (M,) or by indices."""
        p = self.pieces
        return Numbered(Pieces(p.low[which], p.high[which], p.ctrl[which]), self.source[which])

    def halves(self) -> Numbered:
        """Return the halves of every piece, the left ones first."""
        return Numbered(self.pieces.halves(), np.concatenate([self.source, self.source]))

    def and_also(self, other: Numbered) -> Numbered:
        """Return the union with other pieces."""
        return Numbered(join([self.pieces, other.pieces]), np.concatenate([self.source, other.source]))


@dataclass(slots=True)
class LeastSearch:
    """The state of a minimisation: the least value, and the least bound of pieces not halved further."""

    best: float = np.inf
    at: float = 0.0
    piece: int = -1
    triangle: int = -1
    closed: float = np.inf
    rest: float = np.inf

    def meet(self, values: Array, parts: Numbered, index: IntArray, triangles: IntArray) -> None:
        """Update the least value with values (K,) of the middles of pieces at triangles."""
        k = int(np.argmin(values)) if len(values) else -1
        if k >= 0 and values[k] < self.best:
            i, pieces = int(index[k]), parts.pieces
            self.best, self.at = float(values[k]), float(0.5 * (pieces.low[i] + pieces.high[i]))
            self.piece, self.triangle = int(parts.source[i]), int(triangles[k])

    def keep_open(self, pairs: Pairs, lower: Array, gap: Gap) -> tuple[Pairs, Array]:
        """Return the pairs with bounds (K,) below the least known value minus the gap, and these bounds."""
        is_open = lower < self.best - gap(self.best)
        self.closed = min(self.closed, float(lower[~is_open].min(initial=np.inf)))
        self.rest = float(lower[is_open].min(initial=np.inf))
        return pairs.pick(is_open), lower[is_open]

    def bound(self, surface: Surface) -> SurfaceBound:
        """Return the proved bound."""
        triangle = int(surface.source[self.triangle]) if self.triangle >= 0 else -1
        proven = min(self.closed, self.best, self.rest)
        return SurfaceBound(proven, self.best, self.at, self.piece, triangle)


def inf_distance(pieces: Pieces, surface: Surface, gap: Gap) -> SurfaceBound:
    """Bound the infimum of the distance from a surface along pieces of shape (M, n + 1, 3), metres.

    gap : admissible difference of ``proven`` and ``attained``, as a function of the least distance so far
    Without pieces or triangles both are inf. The distance has no sign: if a curve crosses the surface the
    value is 0, or at most the gap.
    """
    known = LeastSearch()
    if len(surface) and len(pieces):
        run(_Distances(known, surface, gap), Numbered(pieces, np.arange(len(pieces))))
    return known.bound(surface)


class DistanceProblem(Protocol):
    """A minimisation over pairs of pieces and triangles, for ``run``."""

    @property
    def known(self) -> LeastSearch:
        """The state of the search."""

    def look(self, parts: Numbered) -> None:
        """Evaluate some values as a first bound."""

    def long(self, parts: Numbered) -> Mask:
        """Return which pieces, (M,), to halve if they meet too many boxes."""

    def pairs(self, parts: Numbered, most: int | None) -> Pairs:
        """Return the pairs that may have the least value; raise TooMany if they are more than ``most``."""

    def close(self, parts: Numbered, pairs: Pairs) -> None:
        """Bound the value over pairs, by halving."""


def run(problem: DistanceProblem, parts: Numbered) -> None:
    """Find the least value; where all pieces together meet too many boxes, process fewer or shorter ones."""
    problem.look(parts)
    rest, closed = [parts], np.inf
    while rest:
        parts = rest.pop()
        try:
            problem.close(parts, problem.pairs(parts, OPEN_PIECES_LIMIT if len(parts) > 1 else None))
            closed = min(closed, problem.known.rest)
        except TooMany:
            rest += _fewer(problem, parts)
    problem.known.rest = closed


def _fewer(problem: DistanceProblem, parts: Numbered) -> list[Numbered]:
    long = problem.long(parts)
    if long.any() and len(parts) < PIECES_LIMIT:
        shorter = parts.pick(long).halves()
        problem.look(shorter)
        parts = parts.pick(~long).and_also(shorter)
        return [parts]
    half = len(parts) // 2
    return [parts.pick(np.arange(half)), parts.pick(np.arange(half, len(parts)))]


def middles(ctrl: Array) -> Array:
    """Return the middle points (M, 3) of pieces (M, n + 1, 3), by de Casteljau."""
    while ctrl.shape[1] > 1:
        ctrl = 0.5 * (ctrl[:, :-1] + ctrl[:, 1:])
    return ctrl[:, 0]


@dataclass(frozen=True, slots=True, eq=False)
class _Distances:
    """The minimisation of the distance, for ``run``."""

    known: LeastSearch
    surface: Surface
    gap: Gap

    def look(self, parts: Numbered) -> None:
        """Evaluate the middles of pieces as a first bound: an upper bound for all, the distance for the
        likeliest.
        """
        middle = middles(parts.pieces.ctrl)
        some = some_distance(self.surface, middle)
        likely = np.argsort(some)[:MEASURED_PIECES]
        limit = np.nextafter(min(self.known.best, float(some.min())), np.inf)
        closest_points = nearest(self.surface, middle[likely], limit)
        self.known.meet(closest_points.distance, parts, likely, closest_points.triangle)

    def long(self, parts: Numbered) -> Mask:
        """Return which pieces meet fewer boxes after halving."""
        size = np.ptp(parts.pieces.ctrl, axis=1)
        return np.asarray(np.sqrt(dot(size, size)) > self.known.best)

    def pairs(self, parts: Numbered, most: int | None) -> Pairs:
        """Return the pairs whose boxes are nearer than the least known distance."""
        low, high = parts.pieces.ctrl.min(axis=1), parts.pieces.ctrl.max(axis=1)
        limit = self.known.best - self.gap(self.known.best)
        met = [self.known.closed]

        def meets(item: IntArray, its_low: Array, its_high: Array) -> Mask:
            apart = box_distances(low[item], high[item], its_low, its_high)
            near = apart < limit
            met.append(float(apart[~near].min(initial=np.inf)))
            return near

        pairs = search(self.surface, len(parts), meets, most)
        self.known.closed = min(met)
        return pairs

    def close(self, parts: Numbered, pairs: Pairs) -> None:
        """Halve pieces of pairs until no pair may be nearer than the least known distance minus the gap."""
        lower = np.zeros(len(pairs))
        for _ in range(MOST_HALVINGS):
            lower = np.maximum(lower, self._boxes_apart(parts, pairs))
            pairs, lower = self.known.keep_open(pairs, lower, self.gap)
            if not len(pairs) or len(pairs) > OPEN_PIECES_LIMIT:
                break
            lower = np.maximum(lower, self._bounds(parts, pairs))
            pairs, lower = self.known.keep_open(pairs, lower, self.gap)
            parts, pairs = halve(parts, pairs)
            lower = np.concatenate([lower, lower])

    def _boxes_apart(self, parts: Numbered, pairs: Pairs) -> Array:
        ctrl, triangles = parts.pieces.ctrl, self.surface.triangles[pairs.triangle]
        low, high = ctrl.min(axis=1)[pairs.item], ctrl.max(axis=1)[pairs.item]
        return box_distances(low, high, lowest(triangles), highest(triangles))

    def _bounds(self, parts: Numbered, pairs: Pairs) -> Array:
        """Return lower bounds (K,) of the distances of pairs, and update the least value with the middles."""
        triangles = self.surface.triangles[pairs.triangle]
        middle = middles(parts.pieces.ctrl)[pairs.item]
        closest_points = closest(triangles, middle)
        self.known.meet(closest_points.distance, parts, pairs.item, pairs.triangle)
        normal = (middle - closest_points.point) / np.maximum(closest_points.distance, 1e-300)[:, None]
        ctrl = parts.pieces.ctrl[pairs.item] - closest_points.point[:, None]
        along = np.einsum("kmd,kd->km", ctrl, normal).min(axis=1)
        behind = np.einsum("kvd,kd->kv", triangles - closest_points.point[:, None], normal).max(axis=1)
        # Near a crossing the direction is noise. A bound below 0 has no information.
        length = np.maximum(np.sqrt(dot(normal, normal)), 1.0)
        return np.asarray(np.maximum((along - behind) / length, 0.0))


def halve(parts: Numbered, pairs: Pairs) -> tuple[Numbered, Pairs]:
    """Halve the pieces of pairs; each pair becomes two."""
    used, item = np.unique(pairs.item, return_inverse=True)
    parts = parts.pick(used).halves()
    triangle = np.concatenate([pairs.triangle, pairs.triangle])
    return parts, Pairs(np.concatenate([item, item + len(used)]), triangle)
