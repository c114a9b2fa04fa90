"""The elements of claims about a fleet: one claim per constraint, with the drone nearest to the limit."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.fleet_spline import pieces, places
from shotc.geom.proof import ProvedExtreme
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.phases import UPRIGHT
from shotc.ir.show import Fleet, drone_names
from shotc.ir.trajectory import Claim, Method
from shotc.passes.verify.claims import Limit, WorstValue, held

Span = tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class FleetFlight:
    """One fleet, its mission and its trajectory.

    names : of its drones, in the order of their numbers
    pads, ends : pads of take-off and of landing, shape (n, 3); a drone lands on its own pad, or on the one
        that it ends nearest to
    flown : positions in Bernstein form, over the whole flight
    """

    mission: MissionIR
    fleet: Fleet
    track: FleetTrajectory
    names: tuple[str, ...]
    pads: Array
    ends: Array
    flown: FleetPieces

    @staticmethod
    def of(mission: MissionIR, track: FleetTrajectory) -> FleetFlight:
        """Return the flight of a fleet of the mission."""
        fleet, breaks = mission.fleet(track.fleet), track.breaks
        flown = FleetPieces(breaks[:-1], breaks[1:], pieces(breaks, track.coef))
        pads = np.array(fleet.pads)
        ends = pads
        if fleet.returns == "any":
            ends = pads[cKDTree(pads).query(flown.ctrl[:, -1, -1])[1]]
        return FleetFlight(mission, fleet, track, drone_names(fleet), pads, ends, flown)

    def key(self, *keys: str) -> KeyPath:
        """Return the key path of one of the fleet's settings."""
        return (*self.fleet.path, *keys)

    def at(self, time: float, order: int = 0) -> Array:
        """Return the positions of all drones, or a derivative of these, shape (n, 3)."""
        return places(self.track.breaks, self.track.coef, np.array([time]), order)[:, 0]

    def free(self) -> list[Span]:
        """Return the times without take-off and landing."""
        return [(p.start, p.end) for p in self.track.phases if p.name not in UPRIGHT]

    def verticals(self) -> Iterator[tuple[list[Span], Array]]:
        """Yield the times of take-off, and of landing, if there are any, and the pads below, shape (n, 3).

        In a fleet that returns to any pad, two drones that land on the same one would violate their
        separation.
        """
        for name, pads in zip(UPRIGHT, (self.pads, self.ends), strict=True):
            spans = [(p.start, p.end) for p in self.track.phases if p.name == name and p.end > p.start]
            if spans:
                yield spans, pads


def of_drone(
    flight: FleetFlight, limit: Limit, extreme: tuple[float, float], drone: int, method: Method = "exact"
) -> Claim:
    """Return the claim of one drone's worst value and its time against a limit."""
    value, time = extreme
    x, y, z = (float(c) for c in flight.at(time)[drone])
    worst = WorstValue(value, time, method, (x, y, z))
    return held(flight.fleet.name, limit, worst, (flight.names[drone],))


def bounded(
    flight: FleetFlight, limit: Limit, bound: ProvedExtreme, value: Callable[[Array], Array], order: int = 0
) -> Claim:
    """Return the claim of a bound over all drones against a limit.

    value : function from positions, or a derivative of these, (n, 3), to the bounded quantity, (n,); it finds
        the worst drone
    """
    values = value(flight.at(bound.at, order))
    drone = int(np.argmax(values) if limit.upper else np.argmin(values))
    return of_drone(flight, limit, (bound.proven, bound.at), drone, "bounded")


def worse(limit: Limit, claims: Sequence[Claim]) -> Claim:
    """Return the claim of several about one limit that comes nearest to breaking it, or breaks it most."""
    return (max if limit.upper else min)(claims, key=lambda claim: claim.worst)
