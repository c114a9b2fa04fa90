"""Keeps the expansion of a fleet on arcs within its heights and clear of obstacles, by moving the arcs'
centre.

On arcs about a point c a formation is wider half-way than before and after. Along a direction n the support
of the drones is n.c + a u0 + b u1, where u0 and u1 are how far the two formations reach beyond c. So the
control points of (a, b) bound all positions along every n; on a full arc the bound is the root of u0^2 +
u1^2. The point c is free: with a lower c all drones pass higher. If c is above the lowest drone of both
formations, no drone goes below that one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.fleet_spline import pieces
from shotc.geom.proof import bounds, box_gap, inf_distance, sup_outside
from shotc.planning.clearances import ROUNDING_M, Clearance
from shotc.show.assignment.score import Motion
from shotc.show.goals.room import DisplaySurroundings, RoomLack
from shotc.show.solvers.arc_move import ArcMove

GAP_M = 1e-3
"""Accuracy of the distance bounds, metres."""
BEYOND_M = 0.05
"""Metres by which the fleet is moved aside in addition to the lack."""
WIDEST_SHARE = 0.41
"""Shift of the fleet half-way over the opposite shift of c: sqrt(2) - 1."""
SAFE_SHARE = 0.95
"""Weight of the just sufficient height of c against the safe one."""
HEIGHT_LEVELS = 8
"""Most heights of c that are tried."""
FARTHEST_M = 1000.0
"""Largest distance of c, metres; wider arcs take longer than any show."""

Ends = tuple[Array, Array]
"""Positions of all drones before and after a move, shape (n, 3) each."""


@dataclass(frozen=True, slots=True, eq=False)
class Heights:
    """Lowest and highest z for the centres of all drones, metres."""

    low: float
    high: float

    def lack(self, ends: Ends, ctrl: Array, pivot: Array) -> float:
        """Return the lack of height by the closed-form bound; the formations' own lack is not counted.

        ctrl : as in ``ArcMove``, shape (P + 3, 2); pivot : c, shape (3,)
        """
        low, high = self.beside(ends)
        before, after = (e[:, 2] - pivot[2] for e in ends)
        down = float((ctrl @ [before.min(), after.min()]).min()) + pivot[2]
        up = float((ctrl @ [before.max(), after.max()]).max()) + pivot[2]
        return float(max(low - down, up - high, 0.0))

    def pivot(self, ends: Ends, ctrl: Array, height: float) -> float:
        """Return the height of c nearest to the wanted one that keeps both heights, or the lower one.

        ctrl : as in ``ArcMove``, shape (P + 3, 2)
        """
        low, high = self.beside(ends)
        swell = 1.0 - ctrl.sum(axis=1)
        out = swell < -1e-6
        (l0, l1), (h0, h1) = ((e[:, 2].min() for e in ends), (e[:, 2].max() for e in ends))
        most = float(((low - ctrl @ [l0, l1])[out] / swell[out]).min(initial=np.inf))
        least = float(((high - ctrl @ [h0, h1])[out] / swell[out]).max(initial=-np.inf))
        # The height is moved towards the safe one, because another c has other control points.
        most = most if most == np.inf else SAFE_SHARE * most + (1.0 - SAFE_SHARE) * min(l0, l1)
        least = least if least == -np.inf else SAFE_SHARE * least + (1.0 - SAFE_SHARE) * max(h0, h1)
        return min(max(height, least), most)

    def beside(self, ends: Ends) -> tuple[float, float]:
        """Return the lowest and the highest z for a move between two formations, which keep their own."""
        lowest = min(float(e[:, 2].min()) for e in ends)
        highest = max(float(e[:, 2].max()) for e in ends)
        return min(self.low, lowest), max(self.high, highest)


def led(
    ends: Ends, heights: Heights, surroundings: DisplaySurroundings, fastest: Callable[[Array], ArcMove]
) -> tuple[ArcMove, RoomLack]:
    """Return a move that is clear of everything, or that with the least lack, and the lack.

    fastest : returns the fastest move about a point c, shape (3,)
    """
    best: tuple[ArcMove, RoomLack] | None = None
    for move in _tries(ends, heights, surroundings, fastest):
        lack = lack_of(ends, heights, surroundings, move)
        if lack.metres <= ROUNDING_M:
            return move, lack
        if best is None or lack.metres < best[1].metres:
            best = move, lack
    assert best is not None
    return best


def _tries(
    ends: Ends, heights: Heights, surroundings: DisplaySurroundings, fastest: Callable[[Array], ArcMove]
) -> Iterator[ArcMove]:
    """Yield the move about the middle at a suitable height, then moves led aside if that is not clear."""
    middle = 0.25 * sum((e.min(axis=0) + e.max(axis=0) for e in ends), np.zeros(3))
    first = _level(ends, heights, fastest, middle)
    yield first
    lack = lack_of(ends, heights, surroundings, first)
    if isinstance(lack.of, Clearance):
        for shift in sorted(_shifts(ends, first, lack), key=lambda shift: float(np.linalg.norm(shift))):
            yield _level(ends, heights, fastest, first.pivot - shift)


def _shifts(ends: Ends, move: ArcMove, lack: RoomLack) -> Iterator[Array]:
    """Yield shifts of c with which the fleet passes an obstacle on each of six sides."""
    assert isinstance(lack.of, Clearance)
    boxes = _boxes(ends, move)
    swell = np.lib.stride_tricks.sliding_window_view(move.ctrl.sum(axis=1) - 1.0, 4).min(axis=1)
    low, high = bounds(lack.of.solid)
    clearance = lack.of.metres + BEYOND_M
    for axis, side in product(range(3), (1.0, -1.0)):
        if lack.of.inside:
            far = (lack.metres + BEYOND_M) / WIDEST_SHARE
        else:
            near = (boxes[:, 0] < high + clearance).all(axis=1) & (boxes[:, 1] > low - clearance).all(axis=1)
            reach = high[axis] - boxes[near, 0, axis] if side > 0 else boxes[near, 1, axis] - low[axis]
            far = float(((reach + clearance) / np.maximum(swell[near], 1e-9)).max(initial=0.0))
        if far < FARTHEST_M:
            yield side * far * np.eye(3)[axis]


def _level(ends: Ends, heights: Heights, fastest: Callable[[Array], ArcMove], pivot: Array) -> ArcMove:
    """Return the move about a point or above or below it, whichever lacks least height."""
    move = best = fastest(pivot)
    lack = least = heights.lack(ends, move.heights, move.pivot)
    for _ in range(HEIGHT_LEVELS):
        if lack <= ROUNDING_M:
            return move
        # Arcs about another point differ, and may need it lower or higher still.
        move = fastest(np.array([*pivot[:2], heights.pivot(ends, move.heights, float(pivot[2]))]))
        lack = heights.lack(ends, move.heights, move.pivot)
        if lack < least:
            best, least = move, lack
    return best


def lack_of(ends: Ends, heights: Heights, surroundings: DisplaySurroundings, move: ArcMove) -> RoomLack:
    """Return a move's largest lack of height or of clearance, proved."""
    worst = RoomLack(heights.lack(ends, move.heights, move.pivot), None)
    boxes = _boxes(ends, move)
    flown: FleetPieces | None = None
    for obstacle in surroundings.obstacles:
        if not obstacle.inside and (box_gap(boxes, obstacle.solid) >= obstacle.metres).all():
            continue
        flown = flown_of(ends, move) if flown is None else flown
        lack = _beside(obstacle, flown)
        worst = RoomLack(lack, obstacle) if lack > worst.metres else worst
    for surface in surroundings.surfaces:
        flown = flown_of(ends, move) if flown is None else flown
        lack = surface.worst(flown.bag())
        worst = RoomLack(lack, surface) if lack > worst.metres else worst
    return worst


def _boxes(ends: Ends, move: ArcMove) -> Array:
    """Return boxes, one for each piece, which contain all drones, shape (K, 2, 3)."""
    reach = [(e.min(axis=0) - move.pivot, e.max(axis=0) - move.pivot) for e in ends]
    scalars = move.scalars
    boxes = [np.einsum("kd,cd->kcd", scalars[:, k], np.array(reach[k])) for k in range(2)]
    corners = boxes[0] + boxes[1] + move.pivot
    # A piece lies in the hull of four consecutive control points, and so in the box around their boxes.
    windows = np.lib.stride_tricks.sliding_window_view(corners, 4, axis=0)
    return np.stack([windows[:, 0].min(axis=-1), windows[:, 1].max(axis=-1)], axis=1)


def flown_of(ends: Ends, move: Motion) -> FleetPieces:
    """Return the pieces of a move from rest to rest, on a clock of its own."""
    before, after = ([e] * 3 for e in ends)
    coef = np.stack([*before, *move.between(*ends), *after], axis=1)
    breaks = np.arange(coef.shape[1] - 2, dtype=np.float64)
    return FleetPieces(breaks[:-1], breaks[1:], pieces(breaks, coef))


def _beside(obstacle: Clearance, flown: FleetPieces) -> float:
    """Return the largest missing clearance from an obstacle; at most 0 if there is none."""
    bag = flown.bag()
    if obstacle.inside:
        return sup_outside(bag, obstacle.solid, _gap).proven + obstacle.metres
    near = box_gap(bag.ctrl, obstacle.solid) < obstacle.metres
    if not near.any():
        return 0.0
    return obstacle.metres - inf_distance(bag.pick(near), obstacle.solid, _gap).proven


def _gap(_: float) -> float:
    return GAP_M
