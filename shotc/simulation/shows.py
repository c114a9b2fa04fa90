"""Simulates the fleets of a plan in many runs, all together on one clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.show import Apart, Fleet, kept_from_cameras, stricter
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.fleets.near import Across, ClosestPair
from shotc.simulation.fleets.rehearse import PERIOD_S, FleetRecord, FleetRehearsal, moments
from shotc.simulation.fleets.vehicle import Gusts
from shotc.simulation.flight import DroneRuns
from shotc.simulation.world import at_times


@dataclass(frozen=True, slots=True)
class FleetCourse:
    """A fleet's deviation from its plan in one run.

    radius : of a drone's body, metres
    """

    fleet: str
    flown: FleetRehearsal
    radius: float

    @property
    def nearest(self) -> ClosestPair | None:
        """The nearest pair, in the air or on pads; None for a fleet of one."""
        nearest = [near for near in (self.flown.near, self.flown.beside) if near is not None]
        return min(nearest, key=lambda near: near.distance, default=None)

    @property
    def clearance(self) -> float:
        """Least distance between bodies, metres; infinite for a fleet of one."""
        near = self.nearest
        return inf if near is None else near.distance - 2 * self.radius


@dataclass(frozen=True, slots=True)
class FleetPair:
    """The nearest drones of a fleet and of another fleet or a camera's drone, in one run.

    one : a fleet
    other : a fleet, or the drone of a camera
    near : its rows refer to ``one`` and to ``other``
    required : separation without margins, metres
    radii : sum of the radii of a body of each, metres
    """

    one: str
    other: str
    near: ClosestPair
    required: float
    radii: float

    @property
    def clearance(self) -> float:
        """Least distance between bodies, metres."""
        return self.near.distance - self.radii


class FleetRun(NamedTuple):
    """The results of all fleets in one run.

    pairs : of fleets, and of fleets and cameras
    """

    fleets: tuple[FleetCourse, ...]
    pairs: tuple[FleetPair, ...]


class _Meeting(NamedTuple):
    """Two groups whose distance is watched, by their indices: fleets first, then cameras."""

    one: int
    other: int
    search: Across
    names: tuple[str, str]
    required: float
    radii: float

    def pair(self) -> FleetPair:
        return FleetPair(*self.names, self.search.nearest(), self.required, self.radii)


def fly_fleets(
    ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int], cameras: Sequence[DroneRuns] = ()
) -> tuple[FleetRun, ...]:
    """Return for every run the result of each fleet of the plan, in gusts.

    cameras : their flights in these runs
    """
    return tuple(_flown(ir, conditions, (r, run), cameras) for r, run in enumerate(runs))


def _flown(
    ir: TrajectoryIR, conditions: Conditions, which: tuple[int, int], cameras: Sequence[DroneRuns]
) -> FleetRun:
    """Return the result of a run.

    which : its index among the cameras' runs, and its number
    """
    r, run = which
    if not ir.fleets:
        return FleetRun((), ())
    fleets = [ir.keyframes.mission.fleet(track.fleet) for track in ir.fleets]
    gusts = Gusts(conditions.wind.gusts)
    watches = [FleetRecord(fleet, track) for fleet, track in zip(fleets, ir.fleets, strict=True)]
    flights = [
        moments(fleet, track, gusts, conditions.seed_of(run, f"gusts {track.fleet}"))
        for fleet, track in zip(fleets, ir.fleets, strict=True)
    ]
    ends = [*(float(track.breaks[-1]) for track in ir.fleets), *(float(c.times[-1]) for c in cameras)]
    times = np.arange(round(max(ends) / PERIOD_S) + 1, dtype=np.float64) * PERIOD_S
    filming = [at_times(camera.position[:, r], camera.times, times)[:, None] for camera in cameras]
    meetings = list(_meetings(ir.keyframes.mission, fleets, cameras))
    # Every flight begins at 0 and has the same period; a drone that has landed stays where it is.
    last: list[Array] = [track.coef[:, 0] for track in ir.fleets]
    for k, time in enumerate(times.tolist()):
        for i, (flight, watch) in enumerate(zip(flights, watches, strict=True)):
            moment = next(flight, None)
            if moment is not None:
                last[i] = watch.add(moment)
        places = [*last, *(each[k] for each in filming)]
        for meeting in meetings:
            meeting.search.add(time, places[meeting.one], places[meeting.other])
    courses = (
        FleetCourse(fleet.name, watch.result(), fleet.radius)
        for fleet, watch in zip(fleets, watches, strict=True)
    )
    return FleetRun(tuple(courses), tuple(meeting.pair() for meeting in meetings))


def _meetings(
    mission: MissionIR, fleets: Sequence[Fleet], cameras: Sequence[DroneRuns]
) -> Iterator[_Meeting]:
    for (i, one), (j, other) in combinations(enumerate(fleets), 2):
        least = max(one.apart.horizontal, other.apart.horizontal)
        search, radii = Across(stricter(one.apart, other.apart), least), one.radius + other.radius
        yield _Meeting(i, j, search, (one.name, other.name), least, radii)
    for (i, one), (j, camera) in product(enumerate(fleets), enumerate(cameras, len(fleets))):
        drone, least = mission.drone(camera.drone), kept_from_cameras(mission.rules.separation, one)
        search = Across(Apart("ellipsoid", least, least, 0.0), least)
        yield _Meeting(i, j, search, (one.name, drone.name), least, one.radius + drone.radius)
