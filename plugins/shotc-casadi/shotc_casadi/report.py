"""Diagnostics about a shot on a path: the solver's failure, and the distance from the convex path."""

from __future__ import annotations

from math import isfinite, isnan, nan

import numpy as np

from shotc.plugin_api import Diagnostic, PathIR, SolverState, unrefined
from shotc.plugin_api.refiner import PathDeviation, leg_of
from shotc_casadi.messages import UNITS, fallen_back, unsolved
from shotc_casadi.rounds import Refined, UnprovedPlace
from shotc_casadi.solving import MOTION
from shotc_casadi.symbols import TIME

NOTICE_M = 0.1  # metres off the convex path that are reported
SHOWS_LESS = "its convex path shows more of its targets"


def report(path: PathIR, refined: Refined, name: str) -> Diagnostic | None:
    """Return the diagnostic about one shot's solver, None if there is none; name : of the refiner."""
    solution = refined.solution
    if refined.camera is not None:
        return fallen_back(path, refined.shot, refined.first, solution)
    if refined.shows_less:
        return unrefined(path, refined.shot, SHOWS_LESS)
    if refined.gap is not None:
        return unsolved(path, _between(refined, refined.gap, name), solution)
    return unsolved(path, state_of(refined, solution.constraint, name), solution)


def _between(refined: Refined, gap: UnprovedPlace, name: str) -> SolverState:
    """Return the state of a problem whose solution breaks a constraint between its nodes."""
    k = min(int(np.searchsorted(refined.nodes.s, gap.s)), len(refined.nodes.s) - 1)
    what = "the gimbal's pitch range" if isnan(gap.metres) else "the clearances between stages"
    state = state_of(refined, what, name)
    if isnan(gap.metres):
        return state
    time = float(refined.solution.states[k, TIME])
    return state._replace(stage=k, s=gap.s, time=time, excess=gap.metres, unit="m")


def state_of(refined: Refined, constraint: str, name: str) -> SolverState:
    """Return the state of a shot's last problem, for a constraint; name : of the refiner."""
    solution = refined.solution
    time = float(solution.states[solution.stage, TIME])
    worst = bool(constraint) and constraint == solution.constraint
    return SolverState(
        shot=refined.shot,
        refiner=name,
        solver=solution.solver,
        stage=solution.stage if worst else None,
        stages=len(solution.inputs),
        s=float(refined.nodes.s[solution.stage]),
        time=time if isfinite(time) else None,
        constraint=constraint,
        excess=solution.residual if worst or not constraint else nan,
        unit=UNITS.get(constraint, ""),
        inner=constraint == MOTION,
    )


def deviation(path: PathIR, refined: Refined) -> list[PathDeviation]:
    """Return where a refined shot is farthest from its convex path, if it is far enough to report."""
    assert refined.camera is not None
    leg = leg_of(path, refined.shot)
    s = refined.nodes.s
    distances = np.linalg.norm(refined.camera(s)[:, :3] - leg.curve(s)[:, :3], axis=1)
    k = int(distances.argmax())
    if distances[k] < NOTICE_M:
        return []
    return [
        PathDeviation(
            refined.shot, float(distances[k]), float(refined.nodes.s[k]), "its framing and a smoother flight"
        )
    ]
