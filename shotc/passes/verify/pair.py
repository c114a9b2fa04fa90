"""Drones against each other: separation, centre to centre, at every instant of the common clock."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Pieces, cut, join
from shotc.geom.proof import inf_distance
from shotc.geom.solids import Cylinder
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import Flight, Limit, bounded, gap

POINT = Cylinder((0.0, 0.0), 0.0, 0.0, 0.0)


def separation(ir: TrajectoryIR, flights: list[Flight]) -> Iterator[Claim]:
    """Claim the separation of every pair of drones; one that has landed stands at its home."""
    least = ir.keyframes.mission.rules.separation
    for one, other in combinations(flights, 2):
        apart = _difference(one.track.curve.channels(0, 1, 2), other.track.curve.channels(0, 1, 2))
        limit = Limit(f"separation from {other.drone.name}", least, "m", ("rules", "separation"), upper=False)
        yield bounded(one, limit, inf_distance(apart, POINT, gap(least)))


def _difference(one: Piecewise, other: Piecewise) -> Pieces:
    """Return the first curve less the second on their common pieces, each standing still after its end."""
    end = max(one.end, other.end)
    breaks = np.union1d(one.breaks, other.breaks)
    bags = []
    for low, high in pairwise(breaks):
        if low < end:
            first, second = _on(one, low, high), _on(other, low, high)
            bags.append(Pieces(np.array([low]), np.array([high]), (first - second)[None]))
    return join(bags)


def _on(curve: Piecewise, low: float, high: float) -> Array:
    found = cut(curve, low, high)
    if len(found):
        return np.asarray(found.ctrl[0])
    return np.repeat(curve(curve.end)[None], curve.degree + 1, axis=0)
