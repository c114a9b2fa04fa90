"""Checks of pyrotechnic products on drones: distances of others and of what stands around from them, and that
the drone is in the air.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_spline import pieces
from shotc.geom.proof import ProvedExtreme
from shotc.ir.mission import MissionIR
from shotc.ir.parked import bodies, parked_fleets
from shotc.ir.show import Display, Fleet, PyroCue, drone_names, rows_of
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.burning import PYRO, NearestToProduct, near_surfaces
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.nearness import nearest


class FleetSpline(NamedTuple):
    """The flight of a fleet: breaks, shape (P + 1,), s, and control points (n, P + 3, 3), metres."""

    fleet: Fleet
    breaks: Array
    coef: Array


def pyro(ir: TrajectoryIR, flights: Sequence[FleetFlight]) -> Iterator[Claim]:
    """Yield claims for every burning product: all others, the audience, ground and meshes."""
    for flight in flights:
        for product in _products(flight):
            yield from _cue(ir, flights, product)


def cue_claims(
    ir: TrajectoryIR, flights: Sequence[FleetFlight], flight: FleetFlight, display: Display, cue: PyroCue
) -> Iterator[Claim]:
    """Yield those claims for one cue of a display, which may differ from the mission's."""
    yield from _cue(ir, flights, _Burning(flight, display, cue, f"{PYRO}{cue.product}", cue.ignition))


def still_burning(ir: TrajectoryIR, flight: FleetFlight, called_off: float) -> Iterator[Claim]:
    """Yield those claims for products that burn when a show is called off; later ones are not lit.

    flight : from that time on, s
    """
    for product in _products(flight):
        if product.cue.ignition < called_off < product.cue.end:
            yield from _cue(ir, [flight], replace(product, begin=called_off))


def burning_beside(
    mission: MissionIR, burning: FleetSpline, other: FleetSpline, called_off: float
) -> Iterator[Claim]:
    """Yield the claims for products that burn when a show is called off, beside another fleet.

    burning, other : both fleets from that time on, s
    """
    fleet, breaks, coef = burning
    last = float(breaks[-1])
    cues = [
        each for each in _cues(mission, fleet) if each.cue.ignition < called_off < min(each.cue.end, last)
    ]
    if not cues:
        return
    names, own = drone_names(fleet), pieces(breaks, coef)
    beside = other.breaks, pieces(other.breaks, other.coef)
    for _, cue, name in cues:
        span = (called_off, min(cue.end, last))
        bounds = {
            row: nearest(Piecewise(breaks, own[row]), *beside, span, cue.clear) for row in rows_of(fleet, cue)
        }
        row = min(bounds, key=lambda row: bounds[row].proven)
        constraint = f"{name} from drones of {other.fleet.name}"
        limit = Limit(constraint, cue.clear, "m", (*cue.path, "clear"), upper=False)
        worst = WorstValue(bounds[row].proven, bounds[row].at, "bounded")
        yield held(fleet.name, limit, worst, (names[row],))


def burning_at(mission: MissionIR, fleet: str, time: float) -> bool:
    """Tell whether a product of a fleet burns at a time, s."""
    cues = (cue for d in mission.displays if d.fleet == fleet for cue in d.pyro)
    return any(cue.ignition < time < cue.end for cue in cues)


def _products(flight: FleetFlight) -> Iterator[_Burning]:
    for display, cue, name in _cues(flight.mission, flight.fleet):
        yield _Burning(flight, display, cue, name, cue.ignition)


class _NamedCue(NamedTuple):
    """A cue of a display, and its name in claims."""

    display: Display
    cue: PyroCue
    name: str


def _cues(mission: MissionIR, fleet: Fleet) -> Iterator[_NamedCue]:
    for display in (d for d in mission.displays if d.fleet == fleet.name):
        for index, cue in enumerate(display.pyro):
            yield _NamedCue(display, cue, f"{PYRO}{index + 1} {cue.product}")


@dataclass(frozen=True, slots=True, eq=False)
class _Burning:
    """One product on drones of a fleet, in the air; name : in claims; begin : from when it is judged, s."""

    flight: FleetFlight
    display: Display
    cue: PyroCue
    name: str
    begin: float


def _cue(ir: TrajectoryIR, flights: Sequence[FleetFlight], burns: _Burning) -> Iterator[Claim]:
    cue, flight = burns.cue, burns.flight
    aloft = flight.free()
    low, high = aloft[0][0], aloft[-1][1]
    outside = max(low - burns.begin, cue.end - high, 0.0)
    path = (*cue.path, "at")
    limit = Limit(f"{burns.name} outside the flight", 0.0, "s", path, shot=burns.display.id)
    yield held(flight.fleet.name, limit, WorstValue(outside, burns.begin, "exact"))
    span = (max(burns.begin, low), min(cue.end, high))
    if span[0] >= span[1]:
        return
    rows = rows_of(flight.fleet, cue)
    near: dict[str, NearestToProduct] = {}
    for row in rows:
        for what, bound in _distances(ir, flights, burns, row, span):
            if what not in near or bound.proven < near[what].bound.proven:
                near[what] = NearestToProduct(what, bound, row)
    for approach in (*near.values(), *near_surfaces(flight, rows, span, cue.clear)):
        name, key = f"{burns.name} from {approach.what}", (*cue.path, "clear")
        limit = Limit(name, cue.clear, "m", key, upper=False, shot=burns.display.id)
        worst = WorstValue(approach.bound.proven, approach.bound.at, "bounded", approach.position)
        yield held(flight.fleet.name, limit, worst, (flight.names[approach.drone],))


def _distances(
    ir: TrajectoryIR,
    flights: Sequence[FleetFlight],
    burns: _Burning,
    drone: int,
    span: tuple[float, float],
) -> Iterator[tuple[str, ProvedExtreme]]:
    """Yield the least distances of all others and of the audience from one drone while its product burns."""
    flight, least = burns.flight, burns.cue.clear
    breaks = flight.track.breaks
    own = Piecewise(breaks, flight.flown.ctrl[drone])
    for others in _others(ir, flights, flight, drone):
        if len(others.ctrl):
            yield others.what, nearest(own, others.breaks, others.ctrl, span, least)
    if burns.display.viewpoint is not None:
        eye = np.array(burns.display.viewpoint).reshape(1, 1, 1, 3)
        yield "the audience", nearest(own, breaks[[0, -1]], eye, span, least)


class _Others(NamedTuple):
    """Vehicles by a name for all; breaks and Bernstein points as in ``nearest``."""

    what: str
    breaks: Array
    ctrl: Array


def _others(
    ir: TrajectoryIR, flights: Sequence[FleetFlight], flight: FleetFlight, drone: int
) -> Iterator[_Others]:
    """Yield all drones except one."""
    for fleet in flights:
        ctrl = fleet.flown.ctrl
        others = np.delete(ctrl, drone, axis=0) if fleet is flight else ctrl
        yield _Others(f"drones of {fleet.fleet.name}", fleet.track.breaks, others)
    still = flight.track.breaks[[0, -1]]
    for parked in parked_fleets(ir):
        yield _Others(f"drones of {parked.name}", still, np.array(parked.pads).reshape(-1, 1, 1, 3))
    for camera in bodies(ir):
        curve = camera.curve.channels(0, 1, 2)
        yield _Others(f"camera {camera.drone}", curve.breaks, curve.ctrl[None])
