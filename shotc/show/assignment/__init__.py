"""assign-goals: GoalIR to ShowIR.

The pass takes the goal sets of every fleet. It gives each fleet a trajectory on one clock: which drone flies
to which goal, from frame to frame, and when. Drones rise vertically from the pads, move on straight lines or
arcs from picture to picture, over what is in the way, return to above the pads, and descend vertically.

Every move keeps all limits by its own control points. It takes the requested time, or the time that the pace
of the limits allows. The frames of an animation are the control points of a spline with their period
(*display*, Sec. IV). It may still break limits, which ``bound-splines`` repairs.
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
from shotc.show.assignment.song_length import song_faults


@dataclass(frozen=True, slots=True)
class AssignGoals:
    """The pass; it has no options."""

    name: ClassVar[str] = "assign-goals"

    def run(self, ir: GoalIR, ctx: PassContext) -> Outcome[ShowIR]:
        """Return the trajectories of all fleets, with goals and times for every drone."""
        mission = ir.keyframes.mission
        images = images_of(mission)
        if isinstance(images, list):
            return Outcome(None, tuple(images))
        directors: list[Director] = []
        for goals in ir.fleets:
            ctx.progress(f"who goes where in fleet {goals.fleet}")
            fleet = mission.fleet(goals.fleet)
            directors.append(Director(mission, fleet, cast_of(fleet, goals)))
        # A display may wait for one of another fleet, so the fleets advance in turn.
        ends: dict[str, float] = {}
        while any(director.advance(ends) for director in directors):
            pass
        diagnostics: list[Diagnostic] = [d for director in directors for d in director.finish()]
        diagnostics += song_faults(mission, max(ends.values(), default=0.0))
        if has_errors(diagnostics):
            return Outcome(None, tuple(diagnostics))
        changed = beside(mission, directors)
        trajectories = [director.trajectory(images) for director in directors]
        fleets = tuple(flight for flight, _ in trajectories)
        diagnostics += [d for _, faults in trajectories for d in faults]
        diagnostics += [d for flight in fleets for d in flashing(mission, flight)]
        stats = tuple(
            entry
            for director, flight in zip(directors, fleets, strict=True)
            for entry in _stats(director, flight)
        )
        goals_ctrl = tuple(fleet.coef for fleet in fleets)
        return Outcome(ShowIR(ir, fleets, goals_ctrl, (*ir.stats, *stats, *changed)), tuple(diagnostics))


def _stats(director: Director, flight: FleetTrajectory) -> list[tuple[str, float | str]]:
    name = flight.fleet
    return [
        (f"fleet {name} drones", float(len(flight.coef))),
        (f"fleet {name} control points", float(flight.coef.shape[1])),
        (f"fleet {name} arcs", float(director.arcs)),
        *([(f"fleet {name} lifted m", director.lifted)] if director.lifted else []),
        (f"fleet {name} time", float(flight.breaks[-1])),
        *_take_off(director, flight),
        *_own_pads(director),
    ]


def _own_pads(director: Director) -> list[tuple[str, float | str]]:
    """Return statistics on the levels above own pads: their number, and the greatest height."""
    heights, name = director.levels, f"fleet {director.fleet.name} own pads"
    return [(f"{name} levels", float(len(heights))), (f"{name} highest m", heights[0])] if heights else []


def _take_off(director: Director, flight: FleetTrajectory) -> list[tuple[str, float | str]]:
    """Return statistics on take-off and landing in layers, if the fleet uses them."""
    take_off, name = take_off_of(director.fleet), f"fleet {flight.fleet} take-off"
    if not take_off.layered or any(f.up is not None or f.down is not None for f in director.cast.recorded):
        return []  # recorded flights have their own take-off and landing
    up, down = flight.phases[0], flight.phases[-1]
    return [
        (f"{name} layers", float(len(take_off.heights))),
        (f"{name} lowest m", take_off.heights[-1]),
        (f"{name} highest m", take_off.heights[0]),
        (f"{name} s", up.end - director.waited),
        (f"{name} landing s", down.end - down.start),
    ]
