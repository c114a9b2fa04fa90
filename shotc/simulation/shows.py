"""The fleets of a plan, flown in many runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from shotc.ir.fleet import FleetTrajectory
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.fleets.near import Near
from shotc.simulation.fleets.rehearse import Rehearsal, rehearse
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
        return float("inf") if near is None else near.distance - 2 * self.radius


def fly_fleets(
    ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]
) -> tuple[tuple[FleetCourse, ...], ...]:
    """Return for every run how each fleet of the plan kept to it, in gusts."""
    fleets = {fleet.name: fleet for fleet in ir.keyframes.mission.fleets}
    gusts = Gusts(conditions.wind.gusts)

    def course(track: FleetTrajectory, run: int) -> FleetCourse:
        fleet, seed = fleets[track.fleet], conditions.seed_of(run, f"gusts {track.fleet}")
        return FleetCourse(track.fleet, rehearse(fleet, track, gusts, seed), fleet.radius)

    return tuple(tuple(course(track, run) for track in ir.fleets) for run in runs)
