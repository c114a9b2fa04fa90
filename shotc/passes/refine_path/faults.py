"""What a refiner reports of its solver: the words for every way in which it does not succeed.

A refiner builds these from plain values and returns them beside the path. Each error labels the shot it
is about, which is how the refine-path pass knows whose convex path to keep where the mission allows it.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.path import DronePath, Leg, PathIR, TimedLeg, TimedPath
from shotc.passes.verify.numbers import measure

UNREFINED = "R014"
NO_HELP = "let this shot fly its convex path by `refine: {optional: true}`, or plan with `--refiner none`"


class SolverState(NamedTuple):
    """Where the problem of one shot stood when its solver gave up.

    shot, refiner, solver : their names
    stage : index of the worst stage from 0, of ``stages`` intervals; s : its path parameter in metres
    time : seconds from the shot's first frame, None where the solver had none
    constraint : what was worst, as people call it ("gimbal pitch rate", "zone tree")
    excess : by how much it was broken, in ``unit``, in SI and radians; NaN where it is not known
    limit : where the mission writes the limit down; its shot where empty
    """

    shot: str
    refiner: str
    solver: str
    stage: int
    stages: int
    s: float
    time: float | None
    constraint: str
    excess: float
    unit: str
    limit: KeyPath = ()


def solver_nan(path: PathIR, state: SolverState) -> Diagnostic:
    """Return the error of a solver whose iterate is not a number; ``state`` is the last one that was."""
    return Diagnostic(
        "R010",
        f"{_who(state)} reached values that are not numbers in shot `{state.shot}`",
        _labels(path, state),
        _notes(path, state),
        _help(path, state, "bring no keyframe straight above or below a target"),
    )


def stopped_early(path: PathIR, state: SolverState, after: str) -> Diagnostic:
    """Return the error of a solver that stopped before it was done; after : e.g. "300 iterations"."""
    return Diagnostic(
        "R011",
        f"{_who(state)} stopped after {after} in shot `{state.shot}`, before it had a path",
        _labels(path, state),
        _notes(path, state),
        _help(path, state, "add a keyframe there", loosen=True),
    )


def impossible(path: PathIR, state: SolverState) -> Diagnostic:
    """Return the error of a problem in which constraints contradict one another near ``state``."""
    return Diagnostic(
        "R012",
        f"{_who(state)} finds no path for shot `{state.shot}` that keeps {state.constraint}",
        _labels(path, state),
        _notes(path, state),
        _help(path, state, "move the keyframes next to it", loosen=True),
    )


def fallback(path: PathIR, shot: str, solvers: tuple[str, str], why: str) -> Diagnostic:
    """Return the warning of a shot that a second solver had to solve.

    solvers : the one that failed and the one used; why : the first one's word, e.g. "300 iterations"
    """
    first, second = solvers
    return Diagnostic(
        "R013",
        f"shot `{shot}` was refined by {second}, since {first} did not converge",
        (path.keyframes.mission.origins.key(shot_named(path.keyframes.mission, shot).path),),
        (f"{first}: {why}",),
        "the plan is proved as any other; it only took longer",
    )


def unrefined(path: PathIR, shot: str, why: str) -> Diagnostic:
    """Return the warning of a shot that stays as it was; why : a clause, e.g. "no path is clear"."""
    mission = path.keyframes.mission
    return Diagnostic(
        UNREFINED,
        f"shot `{shot}` is not refined: {why}",
        (mission.origins.key(shot_named(mission, shot).path, "flies its convex path"),),
        (),
        "the plan is proved as any other; only the framing between keyframes may be worse",
    )


def shot_named(mission: MissionIR, name: str) -> Shot:
    """Return the shot of that name; KeyError if there is none."""
    for shot in mission.shots:
        if shot.id == name:
            return shot
    raise KeyError(name)


def nearest_keyframe(leg: Leg, s: float) -> int | None:
    """Return the index of the keyframe nearest to a path parameter, None where the leg has none."""
    return min(leg.marks, key=lambda mark: abs(mark.s - s)).index if leg.marks else None


def place(leg: Leg | TimedLeg, s: float) -> str:
    """Write where on a leg something is."""
    if isinstance(leg, TimedLeg):
        return f"at t = {s:.2f} s of the mission"
    near = nearest_keyframe(leg, s)
    keyframe = "" if near is None else f", nearest keyframe {near + 1}"
    return f"{s - leg.stops[0].s:.1f} m along the {leg.phase}{keyframe}"


def leg_of(path: PathIR, shot: str) -> Leg:
    """Return the leg that films a shot on a path; KeyError if there is none."""
    leg = filmed(path, shot)
    if not isinstance(leg, Leg):
        raise KeyError(shot)
    return leg


def filmed(path: PathIR, shot: str) -> Leg | TimedLeg:
    """Return the leg that films a shot, whatever it is a curve over; KeyError if there is none."""
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for drone in every:
        for leg in drone.legs:
            if leg.shot == shot:
                return leg
    raise KeyError(shot)


def _help(path: PathIR, state: SolverState, keyframes: str, *, loosen: bool = False) -> str:
    """Return what to change; keyframes : of a shot that has any."""
    clocked = isinstance(filmed(path, state.shot), TimedLeg)
    remedies = ["give the shot more time" if clocked else keyframes]
    if loosen and not state.excess <= 0.0:
        remedies.insert(0, f"loosen {state.constraint}")
    return f"{', or '.join(remedies)}; or {NO_HELP}"


def _who(state: SolverState) -> str:
    return f"{state.solver} of refiner `{state.refiner}`"


def _labels(path: PathIR, state: SolverState) -> tuple[Label, ...]:
    mission = path.keyframes.mission
    first = mission.origins.key(shot_named(mission, state.shot).path, "this shot")
    if not state.limit:
        return (first,)
    second = mission.origins.value(state.limit, f"{state.constraint} was worst")
    return (first,) if second.span == first.span else (first, second)


def _notes(path: PathIR, state: SolverState) -> tuple[str, ...]:
    time = "" if state.time is None else f", {state.time:.2f} s into the shot"
    where = (
        f"worst at stage {state.stage} of {state.stages}{time}, {place(filmed(path, state.shot), state.s)}"
    )
    if not isfinite(state.excess):
        return (where, f"{state.constraint} was worst there, its excess is not a number")
    return (where, f"{state.constraint} was broken by {measure(state.excess, state.unit)} there")
