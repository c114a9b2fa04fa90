"""Check the clearances of transfers from subjects, other targets and keep-out zones.

The claims are hard where the mission states the clearance; otherwise they report where there was not enough
free space for it. ``ir.transits`` defines the clearance at each place.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import cut
from shotc.geom.proof import ProvedExtreme, inf_tapered
from shotc.geom.solids import Solid, distance
from shotc.geom.taper import TAPER_SLOPE, Taper
from shotc.ir.sampling import beside
from shotc.ir.trajectory import Claim
from shotc.ir.transits import SolidClearance, TransitInterval, from_target, from_zones, transit_intervals
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, first_least, gap, less

ENDING = " on transits"
"""Ending of these claims."""


def transits(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield claims on the clearances of all transfers of one flight, one claim per solid."""
    mission, own = flight.mission, flight.track.curve.channels(0, 1, 2)
    for target in mission.targets:
        apart = from_target(mission, target.name)
        if apart is not None:
            yield from _clearance(
                flight, f"target {target.name}", (target.kept_clear, beside(own, target)), apart
            )
    apart = from_zones(mission)
    for zone in mission.zones:
        if apart is not None and zone.keep == "out":
            yield from _clearance(flight, f"zone {zone.name}", (zone.solid, own), apart)


def _clearance(
    flight: JudgedFlight, name: str, near: tuple[Solid, Piecewise], apart: SolidClearance
) -> Iterator[Claim]:
    """Yield the claim on the clearance of one solid; near : the solid, and the flight relative to it."""
    clearance = apart.metres + flight.drone.radius
    bounds = [on_way(near, clearance, interval) for interval in transit_intervals(flight.track.phases)]
    if not bounds:
        return
    worst = first_least(bounds, gap(clearance))
    path = ("rules", "transit_clearance", apart.key)
    limit = Limit(name + ENDING, apart.metres, "m", path, upper=False, hard=apart.required)
    yield bounded(flight, limit, less(worst, flight.drone.radius))


def on_way(near: tuple[Solid, Piecewise], clearance: float, interval: TransitInterval) -> ProvedExtreme:
    """Return a bound on the distance from a solid, plus what the taper allows, on a transfer.

    near : the solid, and the flight relative to it
    clearance : of the body's centre, metres
    """
    solid, curve = near
    taper = taper_of(solid, curve, clearance, interval)
    return inf_tapered(cut(curve, interval.start, interval.end), solid, taper, gap(clearance))


def taper_of(solid: Solid, curve: Piecewise, clearance: float, interval: TransitInterval) -> Taper:
    """Return the tapered clearance on a transfer, for a curve relative to a solid.

    clearance : of the body's centre, metres
    """
    ends = curve(np.array([interval.start, interval.end]))
    gaps = np.array([distance(solid, (float(end[0]), float(end[1]), float(end[2]))) for end in ends])
    return Taper(clearance, TAPER_SLOPE, ends, gaps)
