"""Find the reason why there is no path: which obstacle alone blocks it, and which gap is too narrow."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import closest_points, support
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import GROUND, Owner
from shotc.planning.free_space import MARGIN_M, FreeSpace, Obstacle, Wall
from shotc.planning.obstacles import flight_space
from shotc.planning.path.route import find_route
from shotc.rounding import down

MOST_HALVINGS = 7
OFF_M = 0.3  # metres, tolerance between a gap's lack and the loan's
LACK_SHARE = 0.8  # largest loan over the least clearance


@dataclass(frozen=True, slots=True)
class NarrowPassage:
    """A narrow gap: a note with the numbers, and a remedy."""

    note: str
    help: str


def opening(space: FreeSpace, start: Array, end: Array) -> tuple[Owner, ...]:
    """Return the owners whose removal alone opens a path; the ground is never removed.

    start, end : shape (3,)
    """
    names = (name for name in space.owners if name != GROUND)
    return tuple(name for name in names if find_route(space.without(name), start, end) is not None)


def lower_clearance(mission: MissionIR, drone: Drone, start: Array, end: Array) -> float | None:
    """Return the ground clearance that opens a path, metres, rounded down; None if none does.

    start, end : shape (3,)
    """

    def opens(clearance: float) -> bool:
        rules = mission.rules._replace(ground_clearance=clearance)
        return find_route(flight_space(mission._replace(rules=rules), drone), start, end) is not None

    low, high = 0.0, mission.rules.ground_clearance
    if high <= 0.0 or not opens(low):
        return None
    for _ in range(MOST_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if opens(middle) else (low, middle)
    return down(low)


class _Pair(NamedTuple):
    """Two owners, the gap between them and the gap that is needed, metres."""

    owners: tuple[Owner, Owner]
    gap: float
    needed: float

    @property
    def lack(self) -> float:
        """How much too narrow the gap is."""
        return self.needed - self.gap

    def off(self, lent: float) -> float:
        """Return how much its lack differs from twice the loan: a loan opens the gap on both sides."""
        return abs(self.lack - 2 * lent)


def narrow_gap(
    space: FreeSpace, start: Array, end: Array, openers: tuple[Owner, ...]
) -> NarrowPassage | None:
    """Return the narrowest gap that closes the path, and a remedy; None if no smaller clearance opens one.

    start, end : shape (3,)
    """
    lent = _least_loan(space, start, end)
    if lent is None:
        return None
    pair = _closing_pair(space, openers, lent)
    if pair is None:
        return NarrowPassage(
            f"with {lent:.2f} m less clearance to everything there would be a way",
            f"use a drone with a radius {lent:.2f} m smaller, or make that much room",
        )
    (first, second), gap, needed = pair.owners, pair.gap, pair.needed
    return NarrowPassage(
        f"the gap between {first.words} and {second.words} is {gap:.2f} m; the drone needs {needed:.2f} m",
        f"widen the gap by {needed - gap + MARGIN_M:.2f} m, "
        f"or use a drone with a radius {lent:.2f} m smaller",
    )


def _least_loan(space: FreeSpace, start: Array, end: Array) -> float | None:
    """Return the least reduction of all clearances that opens a path, metres, by bisection."""
    clearances = [*(o.clearance for o in space.obstacles), *(m.clearance for m in space.meshes)]
    most = LACK_SHARE * min(clearances, default=0.0)
    if most <= 0.0 or find_route(space.lent(most), start, end) is None:
        return None
    low, high = 0.0, most
    for _ in range(MOST_HALVINGS):
        middle = 0.5 * (low + high)
        if find_route(space.lent(middle), start, end) is None:
            low = middle
        else:
            high = middle
    return high


def _closing_pair(space: FreeSpace, openers: tuple[Owner, ...], lent: float) -> _Pair | None:
    """Return the two owners whose gap fits the loan best."""
    best: _Pair | None = None
    for a, b in combinations(space.obstacles, 2):
        if a.owner == b.owner or (openers and not {a.owner, b.owner} & set(openers)):
            continue
        gap = _between(a, b)
        best = _closer(best, lent, _Pair((a.owner, b.owner), gap, a.clearance + b.clearance))
    for o in space.obstacles:
        for w in space.walls:
            gap = _to_wall(o, w)
            if o.owner != w.owner and (not openers or {o.owner, w.owner} & set(openers)):
                best = _closer(best, lent, _Pair((o.owner, w.owner), gap, o.clearance + w.clearance))
    return best


def _closer(best: _Pair | None, lent: float, pair: _Pair) -> _Pair | None:
    if pair.lack <= 0.0 or pair.gap <= 0.0 or pair.off(lent) > OFF_M:
        return best
    return best if best is not None and best.off(lent) <= pair.off(lent) else pair


def _between(a: Obstacle, b: Obstacle) -> float:
    """Return the distance between two convex solids, metres, by alternating projections."""
    p = np.array([[0.0, 0.0, 0.0]])
    q = closest_points(a.part, p)
    for _ in range(200):
        p = closest_points(b.part, q)
        q = closest_points(a.part, p)
    return float(np.linalg.norm(p - q))


def _to_wall(o: Obstacle, w: Wall) -> float:
    """Return the distance of an obstacle from the border of a half-space, metres."""
    n = np.array(w.normal)
    nearest = -float(support(o.part, -n[None])[0])
    return nearest - (w.offset - w.clearance)
