"""Fleets against themselves and each other: how near any two drones come, at every instant.

"How near" is measured as horizontal distance, heights being stretched so that the vertical distance that is
kept counts as much as the horizontal one (``geom.separation``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from shotc.geom.separation import Nearest, closest, closest_between
from shotc.ir.origin import KeyPath
from shotc.ir.show import Apart
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, Worst, held
from shotc.passes.verify.fleets.flight import FleetFlight


def separations(flights: Sequence[FleetFlight]) -> Iterator[Claim]:
    """Claim the separation of all pairs of each fleet's drones, and of every two fleets."""
    for flight in flights:
        if len(flight.names) > 1:
            apart = flight.fleet.apart
            found = closest(flight.track.breaks, flight.track.coef, apart)
            yield _claim((flight, flight), "separation", apart, found)
    for one, other in combinations(flights, 2):
        apart = stricter(one.fleet.apart, other.fleet.apart)
        first, second = one.track, other.track
        found = closest_between(first.breaks, first.coef, second.breaks, second.coef, apart)
        yield _claim((one, other), f"separation from {other.fleet.name}", apart, found)


def stricter(one: Apart, other: Apart) -> Apart:
    """Return distances that keep what both of two fleets ask for."""
    shape = one.shape if one.shape == "cylinder" else other.shape
    return Apart(shape, max(one.across, other.across), max(one.upright, other.upright), 0.0)


def _claim(of: tuple[FleetFlight, FleetFlight], name: str, apart: Apart, found: Nearest) -> Claim:
    one, other = of
    limit = Limit(name, apart.across, "m", _path(one), upper=False)
    worst = Worst(found.proven, found.time, "bounded", found.position)
    return held(one.fleet.name, limit, worst, (one.names[found.first], other.names[found.second]))


def _path(flight: FleetFlight) -> KeyPath:
    own, origins = flight.key("separation"), flight.mission.origins
    return own if own in origins.keys or own in origins.values else ("rules", "separation")
