"""The drones of all fleets by their numbers in files, sampled at common times, with their pyro products."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import merge
from operator import itemgetter
from typing import TypeVar

from shotc.emit.fleet_rows import BATCH_DRONES
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import Colors, FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, PyroCue, drone_names, fleet_name, rows_of
from shotc.ir.trajectory import VerifiedIR

Of = TypeVar("Of")


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


def by_number(mission: MissionIR, drones: Mapping[str, Iterable[Of]]) -> Iterator[tuple[int, Of]]:
    """Yield (number, item) for every drone that flies.

    The number counts from 1 in the whole fleet, after the drones of the fleets before.

    drones : items of each fleet or group, in the order of its drones; they are consumed lazily
    """
    whole: dict[str, list[str]] = {}
    for name in drones:
        whole.setdefault(fleet_name(name), []).append(name)
    before = 0
    for names in whole.values():
        rows = (zip(mission.fleet(name).numbers, drones[name], strict=True) for name in names)
        for number, drone in merge(*rows, key=itemgetter(0)):
            yield before + number, drone
        first = mission.fleet(names[0])
        before += len(first.pads) if first.group is None else first.group.total


def carried(displays: Sequence[Display], fleet: Fleet) -> list[list[PyroCue]]:
    """Return the pyro cues of every drone of a fleet, in the order of ignition."""
    by_drone: list[list[PyroCue]] = [[] for _ in fleet.pads]
    cues = [cue for display in displays if display.fleet == fleet.name for cue in display.pyro]
    for cue in sorted(cues, key=lambda cue: cue.ignition):
        for row in rows_of(fleet, cue):
            by_drone[row].append(cue)
    return by_drone
