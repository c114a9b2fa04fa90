"""Proved bounds on the height of curves above ground, for every instant.

The pieces of pairs of a piece and a triangle are halved (branch and bound). Over one triangle the height
above its plane is a polynomial, which is at least the minimum of its control points. A triangle is not under
a piece if one of its sides separates it from all control points in the plan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.proof import MOST_HALVINGS, OPEN_PIECES_LIMIT
from shotc.geom.surface.distance import Gap, LeastSearch, Numbered, SurfaceBound, halve, middles, run
from shotc.geom.surface.ground import Ground, NoGround, heights, leaves, under
from shotc.geom.surface.tree import Pairs, plan_boxes_meet, search
from shotc.geom.surface.triangles import TINY_SQUARE, dot, highest, lowest

PARTED_M = 1e-9
"""Least separation of a triangle from a piece by a side, metres; at a common side both triangles count."""
SLIVER_RATIO = 1e-9
"""Area over the square of the longest side, in the plan, below which a triangle's plane is not used."""
_NEXT = [1, 2, 0]


def inf_height(pieces: Pieces, ground: Ground, gap: Gap) -> SurfaceBound | NoGround:
    """Bound the infimum of the height above ground along pieces of shape (M, n + 1, 3), metres.

    gap : admissible difference of ``proven`` and ``attained``, as a function of the least height so far
    Negative is below ground. Without pieces both are inf. The result is NoGround if a piece leaves the
    ground.
    """
    return leaves(ground, pieces) or _least(pieces, ground, gap, 1.0)


def sup_height(pieces: Pieces, ground: Ground, gap: Gap) -> SurfaceBound | NoGround:
    """Bound the supremum of the height above ground, as ``inf_height``; without pieces both are -inf."""
    bound = leaves(ground, pieces)
    if bound is not None:
        return bound
    least = _least(pieces, ground, lambda worst: gap(-worst), -1.0)
    return SurfaceBound(-least.proven, -least.attained, least.at, least.piece, least.triangle)


def least_where_ground(pieces: Pieces, ground: Ground, gap: Gap) -> SurfaceBound:
    """Bound the infimum as ``inf_height``, over the parts of curves that have ground; inf without any."""
    return _least(pieces, ground, gap, 1.0)


def _least(pieces: Pieces, ground: Ground, gap: Gap, sign: float) -> SurfaceBound:
    known = LeastSearch()
    if len(pieces):
        run(_Heights(known, ground, gap, sign), Numbered(pieces, np.arange(len(pieces))))
    return known.bound(ground.surface)


@dataclass(frozen=True, slots=True, eq=False)
class _Heights:
    """The minimisation of ``sign`` times the height above ground, for ``run``."""

    known: LeastSearch
    ground: Ground
    gap: Gap
    sign: float

    def look(self, parts: Numbered) -> None:
        """Evaluate the heights of the middles of all pieces as a first bound."""
        middle = middles(parts.pieces.ctrl)
        heights = under(self.ground.surface, middle[:, :2])
        there = np.flatnonzero(heights.triangle >= 0)
        values = self.sign * (middle[there, 2] - heights.height[there])
        self.known.meet(values, parts, there, heights.triangle[there])

    def long(self, parts: Numbered) -> Mask:
        """Return which pieces meet fewer boxes after halving: all."""
        return np.ones(len(parts), dtype=bool)

    def pairs(self, parts: Numbered, most: int | None) -> Pairs:
        """Return the pairs that meet in the plan and may have less than the least known value."""
        ctrl = parts.pieces.ctrl
        low, high = ctrl[..., :2].min(axis=1), ctrl[..., :2].max(axis=1)
        lowest_z = (self.sign * ctrl[..., 2]).min(axis=1)
        limit = self.known.best - self.gap(self.known.best)
        met = [self.known.closed]

        def meets(item: IntArray, its_low: Array, its_high: Array) -> Mask:
            over = plan_boxes_meet(low[item], high[item], its_low, its_high)
            lower = lowest_z[item] - self._top(its_low, its_high)
            met.append(float(lower[over & (lower >= limit)].min(initial=np.inf)))
            return np.asarray(over & (lower < limit))

        pairs = search(self.ground.surface, len(parts), meets, most)
        self.known.closed = min(met)
        return pairs

    def close(self, parts: Numbered, pairs: Pairs) -> None:
        """Halve pieces of pairs until no pair may have less than the least known value minus the gap."""
        lower = np.full(len(pairs), -np.inf)
        for _ in range(MOST_HALVINGS):
            triangles = self.ground.surface.triangles[pairs.triangle]
            met = ~_parted(triangles, parts.pieces.ctrl[pairs.item])
            pairs, lower, triangles = pairs.pick(met), lower[met], triangles[met]
            lower = np.maximum(lower, self._bounds(parts, pairs, triangles))
            self._take_middles(parts, pairs, triangles)
            pairs, lower = self.known.keep_open(pairs, lower, self.gap)
            if not len(pairs) or len(pairs) > OPEN_PIECES_LIMIT:
                break
            parts, pairs = halve(parts, pairs)
            lower = np.concatenate([lower, lower])

    def _top(self, low: Array, high: Array) -> Array:
        """Return the maximum of ``sign`` times z over boxes, (K,)."""
        return np.asarray(high[:, 2] if self.sign > 0 else -low[:, 2])

    def _bounds(self, parts: Numbered, pairs: Pairs, triangles: Array) -> Array:
        """Return lower bounds (K,) of values over pairs, by triangle plane and extreme corner."""
        ctrl = parts.pieces.ctrl[pairs.item]
        lowest_z = (self.sign * ctrl[..., 2]).min(axis=1)
        above = lowest_z - self._top(lowest(triangles), highest(triangles))
        one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
        turn = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
        sizes = dot(one[:, :2], one[:, :2]) + dot(other[:, :2], other[:, :2])
        whole = np.abs(turn) > SLIVER_RATIO * sizes
        turn = np.where(whole, turn, 1.0)
        slope_x = (one[:, 2] * other[:, 1] - other[:, 2] * one[:, 1]) / turn
        slope_y = (one[:, 0] * other[:, 2] - other[:, 0] * one[:, 2]) / turn
        offset = ctrl - triangles[:, :1]
        over = offset[..., 2] - slope_x[:, None] * offset[..., 0] - slope_y[:, None] * offset[..., 1]
        return np.asarray(np.where(whole, np.maximum(above, (self.sign * over).min(axis=1)), above))

    def _take_middles(self, parts: Numbered, pairs: Pairs, triangles: Array) -> None:
        middle = middles(parts.pieces.ctrl)[pairs.item]
        height = heights(triangles, middle[:, :2])
        there = np.flatnonzero(~np.isnan(height))
        values = self.sign * (middle[there, 2] - height[there])
        self.known.meet(values, parts, pairs.item[there], pairs.triangle[there])


def _parted(triangles: Array, ctrl: Array) -> Mask:
    """Return which triangles (K, 3, 3) a side separates in the plan from control points (K, n + 1, 3).

    Triangles without area in the plan are no ground and always separated.
    """
    plan = triangles[..., :2]
    edges = plan[:, _NEXT] - plan
    turn = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    inward = np.stack([-edges[..., 1], edges[..., 0]], axis=-1) * np.sign(turn)[:, None, None]
    reach = np.einsum("kmd,ked->kme", ctrl[..., :2], inward).max(axis=1)
    border = dot(plan, inward) - PARTED_M * np.sqrt(dot(edges, edges))
    return np.asarray((reach < border).any(axis=1) | (np.abs(turn) <= TINY_SQUARE))
