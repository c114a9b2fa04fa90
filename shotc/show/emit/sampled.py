"""The drones of all fleets one after another, sampled at common times, for files with one part a drone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from shotc.emit.fleet_rows import BATCH_DRONES
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import Colors, FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.mission import MissionIR
from shotc.ir.show import PyroCue, drone_names
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.numbered import by_number
from shotc.show.emit.pyro_cues import carried


@dataclass(frozen=True, slots=True, eq=False)
class Sampled:
    """One drone, sampled.

    places : (T, 3), W, metres
    colors : of its light, (L, 3)
    pyro : products that it fires
    number : from 1, among the drones of all fleets that fly
    """

    fleet: str
    name: str
    places: Array
    colors: Colors
    pyro: tuple[PyroCue, ...] = ()
    number: int = 1


def sampled(plan: VerifiedIR, times: Array, lit: Array) -> Iterator[Sampled]:
    """Yield all drones in the order of their numbers.

    times : of positions, (T,), seconds
    lit : of colours, (L,), seconds
    """
    mission = plan.trajectory.keyframes.mission
    flights = {f.fleet: _sampled(mission, f, times, lit) for f in plan.trajectory.fleets}
    for number, drone in by_number(mission, flights):
        yield replace(drone, number=number)


def _sampled(mission: MissionIR, flight: FleetTrajectory, times: Array, lit: Array) -> Iterator[Sampled]:
    fleet = mission.fleet(flight.fleet)
    names, fired = drone_names(fleet), carried(mission.displays, fleet)
    for first in range(0, len(names), BATCH_DRONES):
        some = slice(first, first + BATCH_DRONES)
        at = places(flight.breaks, flight.coef[some], times)
        shone = light_colors(flight, lit, some)
        for name, there, colors, cues in zip(names[some], at, shone, fired[some], strict=True):
            yield Sampled(flight.fleet, name, there, colors, tuple(cues))


def count(plan: VerifiedIR) -> int:
    """Return the number of drones of all fleets."""
    return sum(len(flight.coef) for flight in plan.trajectory.fleets)
