"""assign-goals: GoalIR to ShowIR.

Takes the goal sets of every fleet. Gives each fleet a flight on one clock: which drone goes to which goal,
from frame to frame, and when; straight up from the pads, straight or on arcs from picture to picture, back
over the pads, straight down. Every move keeps every limit by its own control points and takes the time that
is asked for, or what the pace of the limits allows. The frames of an animation are the control points of a
spline of their period (*display*, Sec. IV), which may break limits yet: ``bound-splines`` mends that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.fleet import FleetTrajectory, GoalIR, ShowIR
from shotc.ir.passes import Outcome, PassContext
from shotc.planning.take_off import take_off_of
from shotc.show.assignment.beside import beside
from shotc.show.assignment.director import Director
from shotc.show.assignment.flashes import flashing
from shotc.show.assignment.images import images_of
from shotc.show.assignment.order import cast_of
from shotc.show.assignment.song import song_faults


@dataclass(frozen=True, slots=True)
class AssignGoals:
    """The pass; it has no options."""

    name: ClassVar[str] = "assign-goals"

    def run(self, ir: GoalIR, ctx: PassContext) -> Outcome[ShowIR]:
        """Give every drone its goals and every fleet its times."""
        mission = ir.keyframes.mission
        images = images_of(mission)
        if isinstance(images, list):
            return Outcome(None, tuple(images))
        directors: list[Director] = []
        for goals in ir.fleets:
            ctx.progress(f"who goes where in fleet {goals.fleet}")
            fleet = mission.fleet(goals.fleet)
            directors.append(Director(mission, fleet, cast_of(fleet, goals)))
        # A display that waits for one of another fleet comes after it, so the fleets take turns.
        ends: dict[str, float] = {}
        while any(director.advance(ends) for director in directors):
            pass
        diagnostics: list[Diagnostic] = [d for director in directors for d in director.finish()]
        diagnostics += song_faults(mission, max(ends.values(), default=0.0))
        if has_errors(diagnostics):
            return Outcome(None, tuple(diagnostics))
        changed = beside(mission, directors)
        made = [director.trajectory(images) for director in directors]
        fleets = tuple(flight for flight, _ in made)
        diagnostics += [d for _, told in made for d in told]
        diagnostics += [d for flight in fleets for d in flashing(mission, flight)]
        stats = tuple(
            entry
            for director, flight in zip(directors, fleets, strict=True)
            for entry in _stats(director, flight)
        )
        wanted = tuple(fleet.coef for fleet in fleets)
        return Outcome(ShowIR(ir, fleets, wanted, (*ir.stats, *stats, *changed)), tuple(diagnostics))


def _stats(director: Director, flight: FleetTrajectory) -> list[tuple[str, float | str]]:
    name = flight.fleet
    return [
        (f"fleet {name} drones", float(len(flight.coef))),
        (f"fleet {name} control points", float(flight.coef.shape[1])),
        (f"fleet {name} arcs", float(director.arcs)),
        (f"fleet {name} time", float(flight.breaks[-1])),
        *_take_off(director, flight),
        *_own_pads(director),
    ]


def _own_pads(director: Director) -> list[tuple[str, float | str]]:
    """Return on how many levels drones fly over their own pads, and how high above them the highest is."""
    heights, name = director.levels, f"fleet {director.fleet.name} own pads"
    return [(f"{name} levels", float(len(heights))), (f"{name} highest m", heights[0])] if heights else []


def _take_off(director: Director, flight: FleetTrajectory) -> list[tuple[str, float | str]]:
    """Return how a fleet rises and lands in layers, if it does."""
    take_off, name = take_off_of(director.fleet), f"fleet {flight.fleet} take-off"
    if not take_off.layered or any(f.up is not None or f.down is not None for f in director.cast.recorded):
        return []  # recorded flights take off and land as they were recorded
    up, down = flight.phases[0], flight.phases[-1]
    return [
        (f"{name} layers", float(len(take_off.heights))),
        (f"{name} lowest m", take_off.heights[-1]),
        (f"{name} highest m", take_off.heights[0]),
        (f"{name} s", up.end - director.waited),
        (f"{name} landing s", down.end - down.start),
    ]
