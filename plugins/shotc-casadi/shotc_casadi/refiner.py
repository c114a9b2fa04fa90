"""The refiners: they refine and check every filmed leg and put it back into the path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

from shotc.plugin_api import Diagnostic, Outcome, PassContext, PathIR, Piecewise, impossible
from shotc.plugin_api.refiner import MovingLeg, NoTransit, rejoined
from shotc_casadi import conditions
from shotc_casadi.company import refine_in_company
from shotc_casadi.conditions import AimCondition
from shotc_casadi.messages import stats
from shotc_casadi.references import ShotContext, subject_of
from shotc_casadi.report import deviation, report, state_of
from shotc_casadi.rounds import Refined, refine_shot


@dataclass(frozen=True, slots=True)
class ConditionRefiner:
    """A refiner that applies one condition."""

    condition: AimCondition
    api: ClassVar[int] = 1

    @property
    def name(self) -> str:
        """Name of the condition."""
        return self.condition.name

    @property
    def summary(self) -> str:
        """The condition in one line."""
        return self.condition.summary

    def refine(self, path: PathIR, ctx: PassContext) -> Outcome[PathIR]:
        """Return the path with every moving shot refined; what cannot be refined keeps its convex path."""
        if path.timed:
            return refine_in_company(path, ctx, self.condition)
        results = self.shots(path, ctx)
        refined, unreached = self._joined(path, results)
        diagnostics = [*unreached, *(d for r in results if (d := report(path, r, self.name)) is not None)]
        entries = [entry for r in results for entry in stats(r.shot, r.rounds, r.solution)]
        deviations = [d for r in results if r.camera is not None for d in deviation(path, r)]
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
        refined: list[Refined] = []
        for subject in subjects(path):
            ctx.progress(f"refine shot {subject.leg.shot}")
            refined.append(refine_shot(subject, self.condition))
        return refined

    def _joined(self, path: PathIR, results: list[Refined]) -> tuple[PathIR, list[Diagnostic]]:
        """Return the path with the refined shots; without a transfer to its ends a shot stays unrefined."""
        cameras = {r.shot: r.camera for r in results if r.camera is not None}
        try:
            return rejoined(path, cameras), []
        except NoTransit:
            pass
        curves: dict[str, Piecewise] = {}
        unreached: list[Diagnostic] = []
        for refined in results:
            if refined.shot not in cameras:
                continue
            try:
                rejoined(path, curves | {refined.shot: cameras[refined.shot]})
            except NoTransit as fault:
                unreached.append(impossible(path, state_of(refined, str(fault), self.name)))
            else:
                curves[refined.shot] = cameras[refined.shot]
        return rejoined(path, curves), unreached


def subjects(path: PathIR) -> list[ShotContext]:
    """Return the shots of drones without a clock whose camera moves, in the order of flight."""
    return [
        subject_of(path, flown.drone, leg)
        for flown in path.drones
        for leg in flown.legs
        if isinstance(leg, MovingLeg) and leg.shot is not None
    ]


OURS = ConditionRefiner(conditions.OURS)
OURS_4PT = ConditionRefiner(conditions.OURS_4PT)
FRAMING_ONLY = ConditionRefiner(conditions.FRAMING_ONLY)
LOOK_AT = ConditionRefiner(conditions.LOOK_AT)
ANG = ConditionRefiner(conditions.ANG)
