"""The refiners: every filmed leg refined on its own, proved, and put back into the path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite, isnan, nan
from typing import ClassVar

import numpy as np

from shotc.plugin_api import (
    Diagnostic,
    Outcome,
    PassContext,
    PathIR,
    Piecewise,
    SolverState,
    impossible,
)
from shotc.refiner_api import Deviation, NoTransit, flight_room, leg_of, rejoined
from shotc_casadi import conditions
from shotc_casadi.clock.refiner import refine_clocks
from shotc_casadi.conditions import Condition
from shotc_casadi.rounds import Gap, Refined, refine_shot
from shotc_casadi.solving import MOTION
from shotc_casadi.symbols import TIME
from shotc_casadi.telling import UNITS, fallen_back, given_up, stats
from shotc_casadi.wishes import Subject

NOTICE = 0.1  # metres off the convex path that are worth telling


@dataclass(frozen=True, slots=True)
class Refiner:
    """A condition in the refiner seat."""

    condition: Condition
    api: ClassVar[int] = 1

    @property
    def name(self) -> str:
        """Return the condition's name."""
        return self.condition.name

    @property
    def summary(self) -> str:
        """Return the condition in one line."""
        return self.condition.summary

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return the path with every moving shot refined; a shot that cannot be keeps its convex path.

        Shots on their own clock have no keyframes to interpolate; the conditions that do leave them alone.
        """
        if path.timed and self.condition.aims == "framing":
            clocked, told = refine_clocks(path, ctx, self.name)
            return Outcome(clocked, told)
        done = self.shots(path, ctx)
        refined, unreached = self._joined(path, done)
        diagnostics = [*unreached, *(d for r in done if (d := self._report(path, r)) is not None)]
        entries = [entry for r in done for entry in stats(r.shot, r.rounds, r.solution)]
        deviations = [d for r in done if r.camera is not None for d in _deviation(path, r)]
        return Outcome(
            replace(
                refined,
                stats=(*path.stats, *entries),
                deviations=(*path.deviations, *deviations),
            ),
            tuple(diagnostics),
        )

    def shots(self, path: PathIR, ctx: PassContext) -> list[Refined]:
        """Refine every moving shot."""
        done: list[Refined] = []
        for subject in subjects(path):
            ctx.progress(f"refine shot {subject.leg.shot}")
            done.append(refine_shot(subject, self.condition))
        return done

    def _joined(self, path: PathIR, done: list[Refined]) -> tuple[PathIR, list[Diagnostic]]:
        """Put the shots back; one whose new ends cannot be reached keeps its convex path."""
        cameras = {r.shot: r.camera for r in done if r.camera is not None}
        try:
            return rejoined(path, cameras), []
        except NoTransit:
            pass
        kept: dict[str, Piecewise] = {}
        unreached: list[Diagnostic] = []
        for refined in done:
            if refined.shot not in cameras:
                continue
            try:
                rejoined(path, kept | {refined.shot: cameras[refined.shot]})
            except NoTransit as fault:
                unreached.append(impossible(path, self._state(refined, str(fault))))
            else:
                kept[refined.shot] = cameras[refined.shot]
        return rejoined(path, kept), unreached

    def _report(self, path: PathIR, refined: Refined) -> Diagnostic | None:
        """Return what has to be said of one shot's solver."""
        solution = refined.solution
        if refined.camera is not None:
            return fallen_back(path, refined.shot, refined.first, solution)
        if refined.gap is not None:
            return given_up(path, self._between(refined, refined.gap), solution)
        return given_up(path, self._state(refined, solution.constraint or MOTION), solution)

    def _between(self, refined: Refined, gap: Gap) -> SolverState:
        """Return the state of a problem whose solution does not hold between its nodes."""
        k = min(int(np.searchsorted(refined.nodes.s, gap.s)), len(refined.nodes.s) - 1)
        what = "the gimbal's pitch range" if isnan(gap.metres) else "the clearances between stages"
        return self._state(refined, what)._replace(
            stage=k, s=gap.s, time=float(refined.solution.states[k, TIME]), excess=gap.metres, unit="m"
        )

    def _state(self, refined: Refined, constraint: str) -> SolverState:
        solution = refined.solution
        time = float(solution.states[solution.stage, TIME])
        return SolverState(
            shot=refined.shot,
            refiner=self.name,
            solver=solution.solver,
            stage=solution.stage,
            stages=len(solution.inputs),
            s=float(refined.nodes.s[solution.stage]),
            time=time if isfinite(time) else None,
            constraint=constraint,
            excess=solution.residual if constraint == solution.constraint else nan,
            unit=UNITS.get(constraint, ""),
        )


def subjects(path: PathIR) -> list[Subject]:
    """Return the shots of a path whose camera moves, in the order they are flown."""
    mission = path.keyframes.mission
    placed = {p.shot.id: p for p in path.keyframes.shots}
    found: list[Subject] = []
    for flown in path.drones:
        drone = mission.drone(flown.drone)
        room = flight_room(mission, drone)
        found += [
            Subject(mission, drone, room, placed[leg.shot], leg)
            for leg in flown.legs
            if leg.shot is not None and leg.curve is not None
        ]
    return found


def _deviation(path: PathIR, refined: Refined) -> list[Deviation]:
    """Return where a refined shot is farthest from its convex path, if that is worth telling."""
    assert refined.camera is not None
    leg = leg_of(path, refined.shot)
    assert leg.curve is not None
    away = np.linalg.norm(
        (refined.camera(refined.nodes.s) - leg.curve(refined.nodes.s)[:, :5])[:, :3], axis=1
    )
    k = int(away.argmax())
    if away[k] < NOTICE:
        return []
    return [
        Deviation(
            refined.shot, float(away[k]), float(refined.nodes.s[k]), "its framing and a smoother flight"
        )
    ]


OURS = Refiner(conditions.OURS)
OURS_4PT = Refiner(conditions.OURS_4PT)
LOOK_AT = Refiner(conditions.LOOK_AT)
ANG = Refiner(conditions.ANG)
