"""Separation of drones within a fleet and between fleets, at every instant.

For a fleet whose pads are nearer than its separation there are two claims, which together hold at every
instant. Any two drones in the air keep the separation. While any drone stands on its pad, no two bodies are
nearer than the margin (centre to centre twice the radius plus the margin). The distance is horizontal, with
heights scaled so that the vertical separation counts as much as the horizontal one (``geom.separation``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import combinations, product
from math import isfinite

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.on_pads import on_pads
from shotc.geom.proof import norm
from shotc.geom.separation import Nearest, closest, closest_between
from shotc.geom.solids import point
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.parked import parked, parked_fleets
from shotc.ir.show import Apart, Fleet, drone_names, stricter
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import Limit, WorstValue, gap, held
from shotc.passes.verify.fleets.flight import FleetFlight, bounded
from shotc.passes.verify.fleets.space import nearest
from shotc.planning.take_off import bodies_of, take_off_of


def separations(flights: Sequence[FleetFlight]) -> Iterator[Claim]:
    """Yield claims on the separation of all pairs within each fleet, and of every two fleets."""
    for flight in flights:
        if len(flight.names) > 1 and take_off_of(flight.fleet).layered:
            yield from _in_layers(flight)
        elif len(flight.names) > 1:
            apart = flight.fleet.apart
            nearest = closest(*_spline(flight), apart)
            yield _claim(flight.mission, (flight.fleet, flight.names), "separation", (apart, nearest))
    for one, other in combinations(flights, 2):
        yield between(one.mission, (one.fleet, other.fleet), _spline(one), _spline(other))


def _in_layers(flight: FleetFlight) -> Iterator[Claim]:
    """Yield claims on the separation in the air, and on the distance of bodies while any drone is on
    its pad.
    """
    standing = on_pads(flight.track.coef, flight.pads)
    some = np.broadcast_to(standing.any(axis=0), standing.shape)
    named = (
        ("separation in the air", flight.fleet.apart, ~standing),
        ("separation on pads", bodies_of(flight.fleet), some),
    )
    for name, apart, counted in named:
        nearest = closest(*_spline(flight), apart, counted)
        if isfinite(nearest.proven):
            yield _claim(flight.mission, (flight.fleet, flight.names), name, (apart, nearest))


Spline = tuple[Array, Array]
"""Breaks and control points of a fleet's flight."""


def between(mission: MissionIR, fleets: tuple[Fleet, Fleet], flown: Spline, beside: Spline) -> Claim:
    """Return the claim on the separation of every drone of one fleet from every drone of another.

    flown, beside : splines of the first and the second fleet, over the same mission times
    """
    one, other = fleets
    apart = stricter(one.apart, other.apart)
    separation = apart, closest_between(*flown, *beside, apart)
    return _claim(mission, (one, drone_names(other)), f"separation from {other.name}", separation)


def from_parked(ir: TrajectoryIR, flights: Sequence[FleetFlight]) -> Iterator[Claim]:
    """Yield claims on the separation of every fleet from drones and fleets that the plan does not fly."""
    least = ir.keyframes.mission.rules.separation
    for flight, track in product(flights, parked(ir)):
        pad = track.curve(0.0)[:3]
        limit = Limit(f"separation from {track.drone}", least, "m", ("rules", "separation"), upper=False)
        bound = nearest(flight.flown.bag(), point((float(pad[0]), float(pad[1]), float(pad[2]))), gap(least))
        yield bounded(flight, limit, bound, partial(_distances, pad))
    for flight, fleet in product(flights, parked_fleets(ir)):
        pads = np.repeat(np.array(fleet.pads)[:, None], 4, axis=1)
        yield between(flight.mission, (flight.fleet, fleet), _spline(flight), (np.array([0.0, 1.0]), pads))


def _spline(flight: FleetFlight) -> Spline:
    return flight.track.breaks, flight.track.coef


def _distances(pad: Array, places: Array) -> Array:
    return norm(places - pad)


def _claim(
    mission: MissionIR, of: tuple[Fleet, tuple[str, ...]], name: str, separation: tuple[Apart, Nearest]
) -> Claim:
    """Return the claim on the distance of a fleet's drones from others.

    of : the fleet, and the names of the others
    separation : the separation, and the least distance
    """
    (one, others), (apart, nearest) = of, separation
    limit = Limit(name, apart.across, "m", _path(mission, one), upper=False)
    worst = WorstValue(nearest.proven, nearest.time, "bounded", nearest.position)
    return held(one.name, limit, worst, (drone_names(one)[nearest.first], others[nearest.second]))


def _path(mission: MissionIR, fleet: Fleet) -> KeyPath:
    own, origins = (*fleet.path, "separation"), mission.origins
    return own if own in origins.keys or own in origins.values else ("rules", "separation")
