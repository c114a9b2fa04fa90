"""Separation between drones, centre to centre, at every instant of the common clock.

Two drones that the plan does not fly stand at their homes, and there is no claim about them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from math import inf

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import held_until, restrict
from shotc.geom.pieces import Pieces, pieces
from shotc.geom.proof import ProvedExtreme, box_gap, inf_distance
from shotc.geom.solids import point
from shotc.ir.parked import parked_fleets
from shotc.ir.show import Fleet
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap

POINT = point((0.0, 0.0, 0.0))


def separation(flights: list[JudgedFlight], on_pads: list[JudgedFlight]) -> Iterator[Claim]:
    """Yield claims on the separation of every pair of drones of which one flies; landed drones stand at home.

    on_pads : the drones that the plan does not fly
    """
    for one, other in (*combinations(flights, 2), *product(flights, on_pads)):
        least = one.mission.rules.separation
        apart = _difference(one.track.curve.channels(0, 1, 2), other.track.curve.channels(0, 1, 2))
        limit = Limit(f"separation from {other.drone.name}", least, "m", ("rules", "separation"), upper=False)
        yield bounded(one, limit, inf_distance(apart, POINT, gap(least)))


def from_fleets(ir: TrajectoryIR, flights: list[JudgedFlight]) -> Iterator[Claim]:
    """Yield claims on the separation of every drone from the pads of fleets that the plan does not fly."""
    least = ir.keyframes.mission.rules.separation
    for flight, fleet in product(flights, parked_fleets(ir)):
        limit = Limit(f"separation from {fleet.name}", least, "m", ("rules", "separation"), upper=False)
        yield bounded(flight, limit, _from_pads(pieces(flight.track.curve.channels(0, 1, 2)), fleet, least))


def _from_pads(flown: Pieces, fleet: Fleet, least: float) -> ProvedExtreme:
    """Return a bound on the distance from the nearest pad; pads are excluded by their boxes where
    possible.
    """
    boxes = np.array([box_gap(flown.ctrl, point(pad)).min() for pad in fleet.pads])
    best = ProvedExtreme(inf, inf, 0.0)
    for k in np.argsort(boxes, kind="stable"):
        if boxes[k] >= best.proven:
            break
        bound = inf_distance(flown, point(fleet.pads[k]), gap(least))
        best = bound if bound.proven < best.proven else best
    return best


def _difference(one: Piecewise, other: Piecewise) -> Pieces:
    """Return the first curve minus the second on their common pieces; each stands still after its end."""
    end = max(one.end, other.end)
    breaks = np.union1d(one.breaks, other.breaks)
    first, second = (restrict(held_until(curve, end), breaks) for curve in (one, other))
    return Pieces(breaks[:-1], breaks[1:], first.ctrl - second.ctrl)
