"""MAVLink mission files: QGroundControl ``.plan`` for PX4 and ArduPilot, ``.waypoints`` for ArduPilot.

The emitter thins the verified trajectory to straight legs and writes them. It reads the written bytes back
and flies them in a model of the autopilot's interpolation. It reports the error that the format adds to the
picture. The planned return is flown by waypoints, because that is the verified path, and the flight ends with
a landing at home.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.emit.base import Artifact, Emission
from shotc.emit.mavlink.build import Builder
from shotc.emit.mavlink.dialect import DIALECTS, Dialect
from shotc.emit.mavlink.fence import fence_of
from shotc.emit.mavlink.focus import Focus, focus_of
from shotc.emit.mavlink.items import CHANGE_SPEED, MissionItem
from shotc.emit.mavlink.plan_file import read_plan, write_plan
from shotc.emit.mavlink.refly import refly
from shotc.emit.mavlink.report import (
    clockless,
    coarsened,
    cut,
    in_step,
    left_out,
    note,
    raised,
    sidenotes,
)
from shotc.emit.mavlink.speed import DEFAULTS
from shotc.emit.mavlink.steps import WaypointStep, steps_of, whole_seconds
from shotc.emit.mavlink.style import Style, style_of
from shotc.emit.mavlink.thin import StraightLeg, Tolerance, thinner_of
from shotc.emit.mavlink.wpl import read_waypoints, write_waypoints
from shotc.emit.waypoints.clearance import Obstacle, keep_outs
from shotc.emit.waypoints.compare import Error, compare, nearest_miss
from shotc.emit.waypoints.geo import METRE_DECIMALS, Geo, GeoPosition, tie
from shotc.emit.waypoints.link import link_notes
from shotc.emit.waypoints.reflown import ReflownSamples
from shotc.emit.waypoints.report import PROMISED, fleets_left_out, flown_here, no_origin, zoom_not_carried
from shotc.emit.waypoints.timing import evenly, kept_apart_by_time
from shotc.emit.waypoints.track import SAMPLE_STEP_S, SampledFlight, track_of
from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

COARSEST_RATIO = 16.0  # largest factor on the tolerances; framing is loosened first, then position
COARSENESS_HALVINGS = 6  # steps of the search for the least coarseness that fits the autopilot's memory


class MavlinkEmitter:
    """Writes one or two mission files for each drone."""

    name: ClassVar[str] = "mavlink"
    summary: ClassVar[str] = "QGroundControl plans, and waypoints for ArduPilot"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the mission files, with warnings and notes on the error that the format adds."""
        mission = plan.trajectory.keyframes.mission
        fleets = fleets_left_out(mission, plan.trajectory.fleets, self.name)
        if fleets and not plan.trajectory.drones:
            return Emission((), fleets)
        flown, notes, others = flown_here(mission, plan.trajectory.drones, self.name, tuple(DIALECTS))
        if not flown:
            return Emission((), (*fleets, *others))
        if mission.origin is None:
            return Emission((), (*fleets, *others, no_origin(mission, self.name)))
        emitted = [_Job.of(mission, flight).emit() for flight in flown]
        places = {
            flight.drone: evenly(positions)
            for flight, (_, positions) in zip(flown, emitted, strict=True)
            if positions is not None
        }
        meeting = [in_step(mission, each) for each in kept_apart_by_time(mission, places, ())]
        emissions = [emission for emission, _ in emitted]
        return Emission(
            tuple(a for e in emissions for a in e.artifacts),
            (*fleets, *others, *(d for e in emissions for d in e.diagnostics), *meeting),
            (*notes, *(n for e in emissions for n in e.notes)),
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Flight:
    """A flight list, and whether the tolerances were loosened to make it fit.

    intended : steps with the intended holds
    steps : steps with the holds that the autopilot can carry
    """

    items: list[MissionItem]
    intended: list[WaypointStep]
    steps: list[WaypointStep]
    coarser: bool


@dataclass(frozen=True, slots=True, eq=False)
class _Job:
    """The emission for one drone."""

    mission: MissionIR
    flight: DroneTrajectory
    drone: Drone
    dialect: Dialect
    geo: Geo
    track: SampledFlight
    style: Style
    obstacles: tuple[Obstacle, ...]
    focus: Focus | None

    @staticmethod
    def of(mission: MissionIR, flight: DroneTrajectory) -> _Job:
        assert mission.origin is not None
        drone = mission.drone(flight.drone)
        track, dialect = track_of(mission, flight), DIALECTS[drone.autopilot]
        return _Job(
            mission,
            flight,
            drone,
            dialect,
            tie(mission.origin, drone.home),
            track,
            style_of(mission, flight, track),
            keep_outs(mission, drone),
            focus_of(mission, drone, flight, track) if dialect.focuses else None,
        )

    def emit(self) -> tuple[Emission, Array | None]:
        """Return the files and the positions (n, 3) of their re-flight; None if no file is written."""
        not_carried = [] if self.style.zooms else zoom_not_carried(self.mission, self.flight)
        faults = [d for d in not_carried if d.code == PROMISED]
        if faults:
            return Emission((), tuple(faults)), None
        flight = self._fit()
        everywhere = self.flight.curve(
            np.arange(self.flight.curve.start, self.flight.curve.end + SAMPLE_STEP_S, SAMPLE_STEP_S)
        )
        fence = fence_of(
            self.mission, self.geo, everywhere[:, :3], one_inclusion=self.drone.autopilot == "px4"
        )
        hover = next((i.params[1] for i in flight.items if i.command == CHANGE_SPEED), None)
        speed = DEFAULTS[self.drone.autopilot].ground if hover is None else hover
        name = f"{self.drone.name}.plan"
        data = write_plan(flight.items, self.geo, fence, self.dialect.firmware, speed, self._rally())
        artifacts = [Artifact(name, data)]
        flown, error = self._check(*read_plan(data))
        notes = [note(name, self.drone, len(flight.items), error)]
        if self.drone.autopilot == "ardupilot":
            name = f"{self.drone.name}.waypoints"
            data = write_waypoints(flight.items, self.geo)
            artifacts.append(Artifact(name, data))
            notes.append(note(name, self.drone, len(flight.items), self._check(*read_waypoints(data))[1]))
        diagnostics = [left_out(self.mission, self.drone, left) for left in fence.left_out]
        diagnostics += [*self._warnings(flight, flown, error), *not_carried]
        notes += [
            *sidenotes(self.drone, flight.intended, flight.steps),
            *link_notes(self.drone, 0.0, written=False),
        ]
        return Emission(tuple(artifacts), tuple(diagnostics), tuple(notes)), flown.position

    def _rally(self) -> list[GeoPosition]:
        """Return the rally points, at the return height if the mission states one, else at the flight's
        greatest height.
        """
        safety = self.drone.safety
        if safety is None:
            return []
        highest = float(self.track.poses.position[:, 2].max()) - self.drone.home[2]
        height = round(safety.return_height or highest, METRE_DECIMALS)
        return [replace(self.geo.place(place), alt=height) for place in safety.rally]

    def _check(
        self, items: list[MissionItem], home: tuple[float, float, float]
    ) -> tuple[ReflownSamples, Error]:
        flown = refly(items, Geo(self.geo.origin, *home), self.drone)
        return flown, compare(self.mission, self.flight, flown)

    def _warnings(self, flight: _Flight, flown: ReflownSamples, error: Error) -> list[Diagnostic]:
        height = float(self.track.poses.position[0, 2]) - self.drone.home[2]
        warnings: list[Diagnostic | None] = [
            coarsened(self.mission, self.drone, error, self.dialect.most_items) if flight.coarser else None,
            raised(self.mission, self.drone, height, self.dialect.least_takeoff),
            cut(self.mission, self.drone, *nearest_miss(self.obstacles, flown)),
        ]
        return [d for d in warnings if d is not None] + clockless(self.mission, self.flight)

    def _fit(self) -> _Flight:
        thinner = thinner_of(self.track, self.drone, self.style, self.obstacles, self.focus)
        intended = Tolerance()
        flight = self._write(thinner.legs(intended), coarser=False)
        if len(flight.items) <= self.dialect.most_items:
            return flight
        low, high = 0.0, 2.0
        for _ in range(COARSENESS_HALVINGS):
            middle = (low + high) / 2
            trial = self._write(thinner.legs(_coarse(intended, middle), even=False), coarser=True)
            low, high = (low, middle) if len(trial.items) <= self.dialect.most_items else (middle, high)
        return self._write(thinner.legs(_coarse(intended, high), even=False), coarser=True)

    def _write(self, legs: list[StraightLeg], *, coarser: bool) -> _Flight:
        intended = steps_of(self.track, self.style, legs)
        steps = whole_seconds(intended) if self.dialect.whole_seconds else intended
        speeds = DEFAULTS[self.drone.autopilot]
        photos = {s.id: s.photos for s in self.mission.shots if s.photos is not None}
        builder = Builder(
            self.drone, self.style, self.dialect, self.geo, speeds, photos=photos, focus=self.focus
        )
        return _Flight(builder.build(self.track, steps), intended, steps, coarser)


def _coarse(intended: Tolerance, degree: float) -> Tolerance:
    """Return the tolerance at a degree of coarseness from 0 to 2.

    From 0 to 1 the tolerances of framing grow; from 1 to 2 those of position grow.
    """
    return intended.scaled(COARSEST_RATIO ** min(degree, 1.0), COARSEST_RATIO ** max(degree - 1.0, 0.0))


EMITTER = MavlinkEmitter()
