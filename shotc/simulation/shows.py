"""The fleets of a plan, flown in many runs: all of them at once, on one clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, zip_longest
from math import inf
from typing import NamedTuple

from shotc.geom.bernstein import Array
from shotc.ir.show import stricter
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.fleets.near import Across, Near
from shotc.simulation.fleets.rehearse import Rehearsal, Watch, moments
from shotc.simulation.fleets.vehicle import Gusts


@dataclass(frozen=True, slots=True)
class FleetCourse:
    """How a fleet kept to its plan in one run; radius : of its drones' bodies, metres."""

    fleet: str
    flown: Rehearsal
    radius: float

    @property
    def nearest(self) -> Near | None:
        """The nearest that two came, in the air or on pads; None for a fleet of one."""
        found = [near for near in (self.flown.near, self.flown.beside) if near is not None]
        return min(found, key=lambda near: near.distance, default=None)

    @property
    def clearance(self) -> float:
        """The least distance from body to body, metres; infinite for a fleet of one."""
        near = self.nearest
        return inf if near is None else near.distance - 2 * self.radius


@dataclass(frozen=True, slots=True)
class FleetPair:
    """How near drones of two fleets came in one run.

    near : its rows are of the one fleet and of the other; radii : of a body of each together, metres
    """

    one: str
    other: str
    near: Near
    radii: float

    @property
    def clearance(self) -> float:
        """The least distance from body to body, metres."""
        return self.near.distance - self.radii


class FleetRun(NamedTuple):
    """What came of all fleets in one run; pairs : of fleets."""

    fleets: tuple[FleetCourse, ...]
    pairs: tuple[FleetPair, ...]


def fly_fleets(ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]) -> tuple[FleetRun, ...]:
    """Return for every run how each fleet of the plan kept to it, in gusts."""
    return tuple(_flown(ir, conditions, run) for run in runs)


def _flown(ir: TrajectoryIR, conditions: Conditions, run: int) -> FleetRun:
    fleets = [ir.keyframes.mission.fleet(track.fleet) for track in ir.fleets]
    gusts = Gusts(conditions.wind.gusts)
    watches = [Watch(fleet, track) for fleet, track in zip(fleets, ir.fleets, strict=True)]
    pairs = {
        (i, j): Across(
            stricter(fleets[i].apart, fleets[j].apart),
            max(fleets[i].apart.horizontal, fleets[j].apart.horizontal),
        )
        for i, j in combinations(range(len(fleets)), 2)
    }
    flights = [
        moments(fleet, track, gusts, conditions.seed_of(run, f"gusts {track.fleet}"))
        for fleet, track in zip(fleets, ir.fleets, strict=True)
    ]
    # Every flight begins at 0 and has the same period; who has landed stays where it is.
    last: list[Array] = [track.coef[:, 0] for track in ir.fleets]
    for now in zip_longest(*flights):
        last = [
            place if moment is None else watch.add(moment)
            for place, watch, moment in zip(last, watches, now, strict=True)
        ]
        time = next(moment.time for moment in now if moment is not None)
        for (i, j), pair in pairs.items():
            pair.add(time, last[i], last[j])
    courses = [
        FleetCourse(fleet.name, watch.found(), fleet.radius)
        for fleet, watch in zip(fleets, watches, strict=True)
    ]
    met = [
        FleetPair(fleets[i].name, fleets[j].name, pair.found(), fleets[i].radius + fleets[j].radius)
        for (i, j), pair in pairs.items()
    ]
    return FleetRun(tuple(courses), tuple(met))
