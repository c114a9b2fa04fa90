"""Diagnostics for a refiner whose solver does not succeed.

A refiner builds these from plain values and returns them with the path. Each error labels the shot that it is
about. So the refine-path pass knows which shot keeps its convex path, where the mission allows this.
"""

from __future__ import annotations

from math import isfinite, radians
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.measures import measure
from shotc.ir.origin import KeyPath
from shotc.ir.path import ClockLeg, HoldLeg, Leg, PathIR, PathLeg, filmed

UNREFINED = "R014"
EVERYTHING = "all constraints"
NO_NUMBERS = "the solver left no numbers that identify a place or a constraint"
NOTHING_BROKEN = (
    "where it stopped no constraint is broken; it had not settled, so nothing there can be loosened"
)
STEEP_RAD = radians(80.0)  # pitch of a camera almost vertically above or below its target


class SolverState(NamedTuple):
    """The state of one shot's problem when its solver stopped.

    shot, refiner, solver : their names
    stage : index of the worst stage from 0, of ``stages`` intervals; None where nothing was violated or the
        solver left no numbers
    s : its path parameter, metres, or mission time for a shot on its own clock, seconds
    time : seconds from the shot's first frame; None where the solver had none
    constraint : the worst constraint in plain words ("gimbal pitch rate", "zone tree"); empty where there is
        none
    excess : its violation in ``unit``, in SI and radians; NaN where it is not known
    limit : key path of the limit in the mission; empty for the shot itself
    inner : whether the constraint is internal to the solver, so that no mission can relax it
    """

    shot: str
    refiner: str
    solver: str
    stage: int | None
    stages: int
    s: float
    time: float | None
    constraint: str
    excess: float
    unit: str
    limit: KeyPath = ()
    inner: bool = False


def solver_nan(path: PathIR, state: SolverState) -> Diagnostic:
    """Return the error of a solver whose iterate is not a number; ``state`` is the last finite one."""
    return Diagnostic(
        "R010",
        f"{_who(state)} reached values that are not numbers in shot `{state.shot}`",
        _labels(path, state),
        _notes(path, state),
        "bring no keyframe straight above or below a target" if _steep(path, state.shot) else "",
    )


def stopped_early(path: PathIR, state: SolverState, after: str) -> Diagnostic:
    """Return the error of a solver that stopped before convergence; after : e.g. "300 iterations"."""
    return Diagnostic(
        "R011",
        f"{_who(state)} stopped after {after} in shot `{state.shot}`, before it had a path",
        _labels(path, state),
        _notes(path, state),
        _help(path, state, "add a keyframe there"),
    )


def impossible(path: PathIR, state: SolverState) -> Diagnostic:
    """Return the error of a problem whose constraints contradict one another near ``state``."""
    return Diagnostic(
        "R012",
        f"{_who(state)} finds no path for shot `{state.shot}` that keeps {state.constraint or EVERYTHING}",
        _labels(path, state),
        _notes(path, state),
        _help(path, state, "move the keyframes next to it"),
    )


def fallback(path: PathIR, shot: str, solvers: tuple[str, str], why: str) -> Diagnostic:
    """Return the warning of a shot that a second solver had to solve.

    solvers : the one that failed and the one used
    why : reason of the first failure, e.g. "300 iterations"
    """
    first, second = solvers
    return Diagnostic(
        "R013",
        f"shot `{shot}` was refined by {second}, since {first} did not converge",
        (path.keyframes.mission.origins.key(path.keyframes.mission.shot(shot).path),),
        (f"{first}: {why}",),
        "the plan is proved as any other; it only took longer",
    )


def unrefined(path: PathIR, shot: str, why: str) -> Diagnostic:
    """Return the warning of a shot that is not refined; why : a clause, e.g. "no path is clear"."""
    mission = path.keyframes.mission
    return Diagnostic(
        UNREFINED,
        f"shot `{shot}` is not refined: {why}",
        (mission.origins.key(mission.shot(shot).path, "flies its convex path"),),
        (),
        "the plan is proved as any other; only the framing between keyframes may be worse",
    )


def nearest_keyframe(leg: PathLeg, s: float) -> int | None:
    """Return the index of the keyframe nearest to a path parameter, None where the leg has none."""
    return min(leg.marks, key=lambda mark: abs(mark.s - s)).index if leg.marks else None


def place(leg: Leg, s: float) -> str:
    """Return a phrase for a place on a leg."""
    if isinstance(leg, ClockLeg):
        return f"at t = {s:.2f} s of the mission"
    if isinstance(leg, HoldLeg):
        return "where its camera stands"
    near = nearest_keyframe(leg, s)
    keyframe = "" if near is None else f", nearest keyframe {near + 1}"
    return f"{s - leg.stops[0].s:.1f} m along the {leg.phase}{keyframe}"


def _help(path: PathIR, state: SolverState, keyframes: str) -> str:
    """Return a remedy if one is known; keyframes : the remedy for a shot with keyframes."""
    if state.stage is None:
        return ""
    clocked = isinstance(filmed(path, state.shot), ClockLeg)
    loosen = [] if state.inner or state.excess <= 0.0 else [f"loosen {state.constraint}"]
    return ", or ".join([*loosen, *([] if clocked else [keyframes])])


def _steep(path: PathIR, shot: str) -> bool:
    """Return whether a keyframe of a shot is almost vertically above or below its target."""
    placed = next(p for p in path.keyframes.shots if p.shot.id == shot)
    return any(abs(keyframe.pitch) > STEEP_RAD for keyframe in placed.keyframes)


def _who(state: SolverState) -> str:
    return f"{state.solver} of refiner `{state.refiner}`"


def _labels(path: PathIR, state: SolverState) -> tuple[Label, ...]:
    mission = path.keyframes.mission
    first = mission.origins.key(mission.shot(state.shot).path, "this shot")
    if not state.limit:
        return (first,)
    second = mission.origins.value(state.limit, f"{state.constraint} was worst")
    return (first,) if second.span == first.span else (first, second)


def _notes(path: PathIR, state: SolverState) -> tuple[str, ...]:
    if state.stage is None:
        if state.constraint:
            return (f"where {state.constraint} is worst is not known",)
        return (NOTHING_BROKEN if isfinite(state.excess) else NO_NUMBERS,)
    time = "" if state.time is None else f", {state.time:.2f} s into the shot"
    where = (
        f"worst at stage {state.stage} of {state.stages}{time}, {place(filmed(path, state.shot), state.s)}"
    )
    if not isfinite(state.excess):
        return (where, f"{state.constraint} was worst there, its excess is not a number")
    return (where, f"{state.constraint} was broken by {measure(state.excess, state.unit)} there")
