"""What is kept on ways between shots: from what is filmed, from other targets, from keep-out zones.

The claims are requirements where the mission writes the clearance down; else they tell where there was no
room for it. See ``ir.transits`` for what is needed where.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import cut
from shotc.geom.proof import Bound, inf_tapered
from shotc.geom.solids import Solid, distance
from shotc.geom.taper import SLOPE, Taper
from shotc.ir.sampling import beside
from shotc.ir.trajectory import Claim
from shotc.ir.transits import Apart, Way, from_target, from_zones, ways
from shotc.passes.verify.claims import Flight, Limit, bounded, gap, less

ENDING = " on transits"
"""Of the constraints of these claims."""


def transits(flight: Flight) -> Iterator[Claim]:
    """Claim the clearances on all ways of one flight, one claim for each solid."""
    mission, own = flight.mission, flight.track.curve.channels(0, 1, 2)
    for target in mission.targets:
        apart = from_target(mission, target.name)
        if apart is not None:
            yield from _kept(flight, f"target {target.name}", (target.kept_clear, beside(own, target)), apart)
    apart = from_zones(mission)
    for zone in mission.zones:
        if apart is not None and zone.keep == "out":
            yield from _kept(flight, f"zone {zone.name}", (zone.solid, own), apart)


def _kept(flight: Flight, name: str, near: tuple[Solid, Piecewise], apart: Apart) -> Iterator[Claim]:
    """Claim what is kept from one solid by a curve as the solid sees it."""
    clearance = apart.metres + flight.drone.radius
    bounds = [on_way(near, clearance, way) for way in ways(flight.track.phases)]
    worst = min(bounds, key=lambda bound: bound.proven, default=None)
    if worst is None or worst.proven == inf:
        return
    path = ("rules", "transit_clearance", apart.key)
    limit = Limit(name + ENDING, apart.metres, "m", path, upper=False, hard=apart.required)
    yield bounded(flight, limit, less(worst, flight.drone.radius))


def on_way(near: tuple[Solid, Piecewise], clearance: float, way: Way) -> Bound:
    """Bound the distance from a solid, and what the taper gives, on a way of a curve as the solid sees it.

    clearance : of the body's centre, metres
    """
    solid, curve = near
    taper = taper_of(solid, curve, clearance, way)
    return inf_tapered(cut(curve, way.start, way.end), solid, taper, gap(clearance))


def taper_of(solid: Solid, curve: Piecewise, clearance: float, way: Way) -> Taper:
    """Return what is needed on a way of a curve as a solid sees it; clearance : of the body's centre."""
    ends = curve(np.array([way.start, way.end]))
    gaps = np.array([distance(solid, (float(end[0]), float(end[1]), float(end[2]))) for end in ends])
    return Taper(clearance, SLOPE, ends, gaps)
