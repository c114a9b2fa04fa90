"""Check that a fleet's trajectory is one flight: complete, from pads to pads, at rest there, not too long.

Cubic splines with simple knots are smooth to the second derivative, so nothing can jump.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.proof import norm
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.tolerances import REST_TOLERANCE
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.advice import REPLAN
from shotc.passes.verify.claims import LIMIT_TOLERANCE, Limit
from shotc.passes.verify.fleets.flight import FleetFlight, of_drone
from shotc.passes.verify.shape import AT_HOME_M, LARGEST_M, LONGEST_S, SHORTEST_S, first_few, gaps


def fleet_structure(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Yield the faults that make a fleet's trajectory unreadable as a flight."""
    mission = ir.keyframes.mission
    known = {fleet.name: fleet for fleet in mission.fleets}
    for track in ir.fleets:
        if track.fleet not in known:
            text = f"the flight of `{track.fleet}` belongs to no fleet of the mission"
            yield Diagnostic("V014", text, help=REPLAN)
            continue
        label = mission.origins.key(known[track.fleet].path)
        for fault in first_few(_faults(mission, track)):
            text = f"the flight of `{track.fleet}` is not whole: {fault}"
            yield Diagnostic("V014", text, labels=(label,), help=REPLAN)


def _faults(mission: MissionIR, track: FleetTrajectory) -> Iterator[str]:
    breaks, coef, pads = track.breaks, track.coef, mission.fleet(track.fleet).pads
    expected = (len(pads), len(breaks) + 2, 3)
    if breaks.ndim != 1 or len(breaks) < 2 or coef.shape != expected:
        yield f"it has control points of shape {coef.shape} for {len(pads)} pads and {len(breaks)} breaks"
        return
    if not (np.isfinite(breaks).all() and np.isfinite(coef).all()) or np.abs(coef).max() > LARGEST_M:
        yield "its curves reach beyond any flight"
        return
    if breaks[-1] > LONGEST_S:
        yield f"it lasts until {breaks[-1]:.6g} s, longer than {LONGEST_S:g} s"
        return
    if np.diff(breaks).min() < SHORTEST_S:
        yield f"a piece of its curves lasts {np.diff(breaks).min():.3g} s"
        return
    times = [t for p in track.phases for t in (p.start, p.end)]
    times += [t for s in track.shown for t in (s.start, s.end)]
    if not all(map(isfinite, times)):
        yield "a time is not a finite number"
        return
    if abs(float(breaks[0])) > LIMIT_TOLERANCE:
        yield f"it begins at {breaks[0]:.6g} s, not at 0 s"
    yield from gaps(track.phases, float(breaks[0]), float(breaks[-1]))
    own = {d.id for d in mission.displays if d.fleet == track.fleet}
    named = {p.shot for p in track.phases if p.shot is not None} | {s.display for s in track.shown}
    if named - own:
        yield f"it names displays that the fleet does not have: {', '.join(sorted(named - own))}"
    if any((p.name == "shot") != (p.shot is not None) for p in track.phases):
        yield "a phase is a shot without a name, or has one without being a shot"


def shape(flight: FleetFlight) -> Iterator[Claim]:
    """Yield claims on the pads and rest at both ends, and on endurance."""
    breaks, coef = flight.track.breaks, flight.track.coef
    ends = np.array([breaks[0], breaks[-1]])
    off_home = norm(
        np.stack([flight.at(float(t)) for t in ends], axis=1) - np.stack([flight.pads, flight.ends], 1)
    )
    home = Limit("distance from home", AT_HOME_M, "m", flight.key("layout"))
    yield _farthest(flight, home, off_home, ends)
    still = np.stack([np.abs(flight.at(float(t), n)).max(axis=1) for n in (1, 2) for t in ends], axis=1)
    rest = Limit("rate at start and end", REST_TOLERANCE, "m/s", flight.fleet.path)
    yield _farthest(flight, rest, still, np.tile(ends, 2))
    airborne = _airborne(breaks, coef)
    longest = int(np.argmax(airborne))
    endurance = Limit("endurance", flight.fleet.endurance, "s", flight.key("endurance"))
    yield of_drone(flight, endurance, (float(airborne[longest]), float(ends[1])), longest)


def landed(flight: FleetFlight) -> Claim:
    """Return the claim that a flight ends on the pads."""
    end = np.array([float(flight.track.breaks[-1])])
    off_home = norm(flight.at(float(end[0])) - flight.ends)[:, None]
    return _farthest(flight, Limit("distance from home", AT_HOME_M, "m", flight.key("layout")), off_home, end)


def _farthest(flight: FleetFlight, limit: Limit, values: Array, times: Array) -> Claim:
    """Return the claim on the largest of values (n, m) at m times."""
    drone, k = np.unravel_index(int(np.argmax(values)), values.shape)
    return of_drone(flight, limit, (float(values[drone, k]), float(times[k])), int(drone))


def _airborne(breaks: Array, coef: Array) -> Array:
    """Return how long every drone is off its pad, seconds, shape (n,).

    It stands on a piece if all four control points are at its start, or at its end.
    """
    pieces = len(breaks) - 1
    left = (coef != coef[:, :1]).any(axis=2)
    not_back = (coef != coef[:, -1:]).any(axis=2)
    first = np.where(left.any(axis=1), np.argmax(left, axis=1) - 3, pieces)
    last = np.where(not_back.any(axis=1), coef.shape[1] - np.argmax(not_back[:, ::-1], axis=1), 0)
    lifted, landed = breaks[np.clip(first, 0, pieces)], breaks[np.clip(last, 0, pieces)]
    return np.asarray(np.maximum(landed - lifted, 0.0))
