"""The replanner for the seat ``shotc.replanners``."""

from __future__ import annotations

from typing import ClassVar

from shotc.plugin_api.replanner import ChasePlanner, ChaseProblem, FramingPlanner, FramingProblem
from shotc_casadi.replan.chase import ShotChase
from shotc_casadi.replan.framing import Framing


class Ours:
    """One Gauss-Newton step a replan, so that its computing time is known in advance."""

    name: ClassVar[str] = "ours"
    summary: ClassVar[str] = "one Gauss-Newton step a replan by PIQP, from the plan that is flown"
    api: ClassVar[int] = 1

    def chase(self, problem: ChaseProblem) -> ChasePlanner:
        """Return the planner of a shot of one target."""
        return ShotChase(problem)

    def framing(self, problem: FramingProblem) -> FramingPlanner:
        """Return the planner of a shot that composes subjects."""
        return Framing(problem)


OURS = Ours()
