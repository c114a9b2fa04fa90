"""The refiners: every filmed leg refined on its own, proved, and put back into the path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, nan
from typing import ClassVar, NamedTuple

import numpy as np

from shotc.plugin_api import (
    Diagnostic,
    Outcome,
    PassContext,
    PathIR,
    Piecewise,
    SolverState,
    fallback,
    impossible,
    solver_nan,
    stopped_early,
)
from shotc.refiner_api import Deviation, NoTransit, flight_room, leg_of, rejoined
from shotc_casadi import conditions
from shotc_casadi.camera import camera
from shotc_casadi.conditions import Condition
from shotc_casadi.problem import Margins, problem
from shotc_casadi.program import Problem, Solution, Solver, solve
from shotc_casadi.proof import Check, checked, hopeless, tighter
from shotc_casadi.stages import Stages, stages
from shotc_casadi.symbols import PITCH, TIME, YAW
from shotc_casadi.walls import half_spaces
from shotc_casadi.wishes import Subject, wishes

SOLVERS: tuple[Solver, ...] = ("fatrop", "ipopt")  # IPOPT is the fallback, and it is announced
ROUNDS = 6
HOLD_AFTER = 3  # rounds, after which the convex path is all but held: it is known to be clear
NOTICE = 0.1  # metres off the convex path that are worth telling
UNITS = {"speed": "m^2/s^2", "acceleration": "m^2/s^4", "jerk": "m^2/s^6", "clearance": "m"}


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """One shot refined.

    camera : x, y, z, yaw, pitch over the leg's s, or None where no solver found a way
    rounds : how often it was solved until it was proved between the nodes
    problem, solution : the last one
    seconds : of all solves; first : the solver that was tried and failed before, with its word
    """

    shot: str
    camera: Piecewise | None
    nodes: Stages
    rounds: int
    problem: Problem
    solution: Solution
    seconds: float
    first: Solution | None


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
        """Return the path with every moving shot refined; a shot that cannot be keeps its convex path."""
        done = self.shots(path, ctx)
        refined, unreached = self._joined(path, done)
        diagnostics = [*unreached, *(d for r in done if (d := self._report(path, r)) is not None)]
        stats = [entry for r in done for entry in _stats(r)]
        deviations = [d for r in done if r.camera is not None for d in _deviation(path, r)]
        return Outcome(
            replace(
                refined,
                stats=(*path.stats, *stats),
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
            if refined.first is None:
                return None
            why = _word(refined.first)
            return fallback(path, refined.shot, (refined.first.solver, solution.solver), why)
        state = self._state(refined, solution.constraint or "the motion from stage to stage")
        if solution.status == "nan":
            return solver_nan(path, state)
        if solution.status == "infeasible":
            return impossible(path, state)
        return stopped_early(path, state, _word(solution))

    def _state(self, refined: Refined, constraint: str) -> SolverState:
        solution = refined.solution
        return SolverState(
            shot=refined.shot,
            refiner=self.name,
            solver=solution.solver,
            stage=solution.stage,
            stages=len(solution.inputs),
            s=float(refined.nodes.s[solution.stage]),
            time=float(solution.states[solution.stage, TIME]),
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


def refine_shot(subject: Subject, condition: Condition, count: int | None = None) -> Refined:
    """Refine one shot, tightening what does not hold between the nodes until it does.

    count : stages, or None for as many as its keyframes need
    A shot whose duration the solver does not meet is refined for the least time: the time pass slows it
    down to its duration, or says best what it lacks.
    """
    if subject.leg.duration is None:
        return _refine(subject, condition, count, SOLVERS)[0]
    if not hopeless(subject):
        refined, check = _refine(subject, condition, count, SOLVERS[:1])
        if refined.camera is not None and check.late <= 0:
            return refined
    hasty = subject._replace(leg=replace(subject.leg, duration=None, pace=1.0))
    return _refine(hasty, condition, count, SOLVERS)[0]


def _refine(
    subject: Subject, condition: Condition, count: int | None, solvers: tuple[Solver, ...]
) -> tuple[Refined, Check]:
    leg = subject.leg
    assert leg.curve is not None
    assert leg.shot is not None
    nodes = stages(leg, subject.placed, subject.drone, count)
    wanted = wishes(subject, condition, nodes.s)
    walls = half_spaces(subject.room, leg.curve, nodes)
    margins = Margins()
    task = problem(subject, condition, nodes, wanted, walls, margins)
    ends = task.states[[0, -1]][:, [YAW, PITCH]]
    best = _Tried(None, Check(inf, inf, inf))
    seconds, first, rounds = 0.0, None, 0
    following = task
    for rounds in range(1, ROUNDS + 1):
        task = following
        solution, failed = _solved(task, solvers)
        seconds += solution.seconds + (failed.seconds if failed else 0.0)
        first = first or failed
        if solution.status != "solved":
            break
        found = camera(subject.drone, leg, nodes, solution.states, ends)
        tried = _Tried(found, checked(subject, condition, found))
        helped = tried.check.helped(best.check)
        best = min(best, tried, key=lambda t: t.check)
        if tried.check.holds or (best.check.lack <= 0 and not helped):
            break
        margins = tighter(margins, tried.check, hold=rounds >= HOLD_AFTER)
        tightened = problem(subject, condition, nodes, wanted, walls, margins)
        following = replace(tightened, states=solution.states, inputs=solution.inputs)
    clear = best.camera if best.check.lack <= 0 else None
    return Refined(leg.shot, clear, nodes, rounds, task, solution, seconds, first), best.check


class _Tried(NamedTuple):
    camera: Piecewise | None
    check: Check


def _solved(task: Problem, solvers: tuple[Solver, ...]) -> tuple[Solution, Solution | None]:
    """Solve by the first of the solvers, or else by the second; the second value is the first's failure."""
    solution = solve(task, solvers[0])
    if solution.status == "solved" or len(solvers) == 1:
        return solution, None
    return solve(task, solvers[1]), solution


def _word(solution: Solution) -> str:
    if solution.status == "nan":
        return "numbers that are none"
    return f"{solution.iterations} iterations"


def _stats(refined: Refined) -> list[tuple[str, float | str]]:
    solution = refined.solution
    return [
        (f"{refined.shot}.refine_stages", float(len(solution.inputs))),
        (f"{refined.shot}.refine_rounds", float(refined.rounds)),
        (f"{refined.shot}.refine_iterations", float(solution.iterations)),
        (f"{refined.shot}.refine_solver", solution.solver),
        (f"{refined.shot}.refine_status", solution.status),
    ]


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
