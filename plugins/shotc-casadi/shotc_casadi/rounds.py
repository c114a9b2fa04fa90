"""Refines a shot in rounds: solve, check between the nodes, tighten, solve again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import inf, nan
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array, NoTransit, shortfall
from shotc_casadi.camera import Given, NoFit, camera
from shotc_casadi.conditions import AimCondition
from shotc_casadi.drawn import beside_legs
from shotc_casadi.edges import level_beside
from shotc_casadi.frames import first_margins, next_margins
from shotc_casadi.horizon import Solver
from shotc_casadi.margins import Check, Margins, tighter
from shotc_casadi.place_times import place_times, unhurried
from shotc_casadi.problem import problem
from shotc_casadi.program import Problem, solve
from shotc_casadi.proof import checked, hopeless
from shotc_casadi.references import References, ShotContext, references_at
from shotc_casadi.solving import SOLVERS, Attempt, Solution, by_one_of
from shotc_casadi.stages import Stages, stages
from shotc_casadi.symbols import PITCH, YAW
from shotc_casadi.walls import half_spaces

MOST_ROUNDS = 6
HOLD_AFTER_ROUNDS = 3  # rounds; later ones almost hold the convex path, which is known to be clear


class UnprovedPlace(NamedTuple):
    """Where a camera is not proved clear although its nodes are: path parameter, and lack in metres.

    metres : NaN if no camera fits the nodes within the gimbal's pitch range
    """

    s: float
    metres: float


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """One shot refined.

    camera : x, y, z, yaw, pitch over the leg's s, or None if no solver found one
    rounds : number of solves
    problem, solution : those of the camera, or the last ones
    seconds : of all solves
    first : the solution of the solver that failed before
    gap : what stands against the camera of a solved problem
    shows_less : whether its camera is clear but shows less of its targets than the convex path
    """

    shot: str
    camera: Piecewise | None
    nodes: Stages
    rounds: int
    problem: Problem
    solution: Solution
    seconds: float
    first: Solution | None
    gap: UnprovedPlace | None
    shows_less: bool = False


def refine_shot(subject: ShotContext, condition: AimCondition, count: int | None = None) -> Refined:
    """Return one shot refined; each round tightens what fails between the nodes.

    If the solver misses the deadlines, the shot is refined for the shortest time. The time pass then slows it
    down to the deadlines, or reports best what is missing.

    count : number of stages, or None for as many as its keyframes need
    """
    if not place_times(subject.leg):
        return _refine(subject, condition, count, SOLVERS)[0]
    if not hopeless(subject):
        refined, check = _refine(subject, condition, count, SOLVERS[:1])
        if refined.camera is not None and check.late <= 0:
            return refined
    hasty = subject._replace(leg=unhurried(subject.leg))
    return _refine(hasty, condition, count, SOLVERS)[0]


def _refine(
    subject: ShotContext, condition: AimCondition, count: int | None, solvers: tuple[Solver, ...]
) -> tuple[Refined, Check]:
    leg = subject.leg
    assert leg.shot is not None
    nodes = stages(leg, subject.placed, subject.drone, count)
    references = first_margins(subject, nodes, references_at(subject, condition, nodes.s))
    margins = Margins()
    walls = _walls(subject, nodes, margins)
    following = problem(subject, condition, nodes, references, walls, margins)
    given = _given(nodes, references, following)
    tries: list[_RefinementRound] = []
    for rounds in range(1, MOST_ROUNDS + 1):
        attempt = by_one_of(solvers, partial(solve, following))
        tried = _tried(subject, condition, nodes, following, attempt, given)
        helped = not tries or tried.check.helped(min(t.check for t in tries))
        tries.append(tried)
        best = min(tries, key=lambda t: t.check)
        if tried.camera is None or tried.check.holds or (best.check.lack <= 0 and not helped):
            break
        margins = tighter(margins, tried.check, hold=rounds >= HOLD_AFTER_ROUNDS)
        walls = _walls(subject, nodes, margins)
        if tried.check.cropped > 0:
            references = next_margins(subject, nodes, references, tried.camera)
        tightened = problem(subject, condition, nodes, references, walls, margins)
        following = replace(tightened, states=attempt.solution.states, inputs=attempt.solution.inputs)
    return _result(subject, nodes, tries, best), best.check


def _walls(subject: ShotContext, nodes: Stages, margins: Margins) -> Array:
    """Return the half-spaces of the nodes."""
    others = [] if subject.beside is None else [subject.beside(nodes.s)]
    if subject.drawn is not None:
        others.append(beside_legs(subject.drawn, nodes.s, subject.leg.curve(nodes.s)[:, :3]))
    return half_spaces(subject.space, subject.leg.curve, nodes, margins, others)


def _given(nodes: Stages, references: References, task: Problem) -> Given:
    """Return the angles that bind: at both ends, and at keyframes whose target has a place on screen."""
    inner = nodes.pins[1:-1]
    at = np.concatenate([[0], inner[references.framed[inner] > 0], [len(nodes.s) - 1]])
    return Given(nodes.s[at], task.states[at][:, [YAW, PITCH]])


class _RefinementRound(NamedTuple):
    """One round: its camera or None, the remaining errors, its problem and the solver's attempt."""

    camera: Piecewise | None
    check: Check
    problem: Problem
    attempt: Attempt


def _tried(
    subject: ShotContext,
    condition: AimCondition,
    nodes: Stages,
    task: Problem,
    attempt: Attempt,
    given: Given,
) -> _RefinementRound:
    nothing = _RefinementRound(None, Check(inf, inf, inf, inf), task, attempt)
    if attempt.solution.status != "solved":
        return nothing
    try:
        turned = camera(subject.drone, subject.leg, nodes, attempt.solution.states, given, subject.space)
        tried = nothing._replace(camera=turned, check=checked(subject, condition, turned))
    except (NoFit, NoTransit):
        return nothing
    if condition.visibility != "silhouette":
        return tried
    level = level_beside(subject, nodes, turned, given)
    return tried if not len(level.through) else _leveled(subject, condition, tried, (nodes, level))


def _leveled(
    subject: ShotContext, condition: AimCondition, tried: _RefinementRound, to: tuple[Stages, Given]
) -> _RefinementRound:
    """Return a round whose camera crops nothing beside keyframes, unless it is worse elsewhere."""
    nodes, given = to
    try:
        turned = camera(
            subject.drone, subject.leg, nodes, tried.attempt.solution.states, given, subject.space
        )
        check = checked(subject, condition, turned)
    except (NoFit, NoTransit):
        return tried
    return tried if check > tried.check else tried._replace(camera=turned, check=check)


def _result(
    subject: ShotContext, nodes: Stages, rounds: list[_RefinementRound], best: _RefinementRound
) -> Refined:
    """Return the best camera if it is clear, else the state of the last round."""
    leg = subject.leg
    assert leg.shot is not None
    clear = best.check.lack <= 0
    shows_less = clear and best.check.hidden > 0
    chosen = best if clear else rounds[-1]
    if not clear or shows_less:
        chosen = chosen._replace(camera=None)
    solution, failed = chosen.attempt
    seconds = sum(t.attempt.seconds for t in rounds)
    gap = None
    if chosen.camera is None and solution.status == "solved" and not shows_less:
        gap = UnprovedPlace(float(nodes.s[0]), nan) if best.camera is None else _widest(subject, best.camera)
    of = (leg.shot, chosen.camera, nodes, len(rounds), chosen.problem, solution, seconds, failed, gap)
    return Refined(*of, shows_less)


def _widest(subject: ShotContext, curve: Piecewise) -> UnprovedPlace:
    lack = shortfall(subject.space, curve.ctrl[:, :, :3])
    k = int(lack.argmax())
    return UnprovedPlace(float(curve.breaks[k]), float(lack[k]))
