"""Camera position over mission time: the spline nearest to the ideal that keeps limits and clearances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import DEGREE, SplineFunctionals, control_rows, count, energy_rows, spline, value_rows
from shotc.ir.preference import Price, prefers_free_pictures
from shotc.ir.smoothing import NORMAL_S
from shotc.planning.clock.between import lacking, sides_apart, standing_apart
from shotc.planning.clock.bounds import held_ends, limits_of, with_ends
from shotc.planning.clock.moving import LinearMotion, Moving, linearised, motion_rows, shortfalls, sides
from shotc.planning.clock.preferred import cost
from shotc.planning.clock.task import ClockTask, drawn_to, ideal_of
from shotc.planning.clock.visibility import PictureHalfSpaces, keep_free
from shotc.planning.corridor import LinearisedCorridor, with_corridor
from shotc.planning.free_space import HalfSpaces, shortfall
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import Equalities, Goal, HalfSpaceRows, SplineProblem
from shotc.solvers.spline_qp import SplineSolution, least_of, minimise
from shotc.solvers.spline_relax import Relaxation, relax

SAMPLES_PER_PIECE = 3  # samples of the ideal
FAINT_WEIGHT = 1e-3  # weight of the reference outside the film, over that in the film
UNSEEN_WEIGHT = 0.005  # weight of the jerk outside the film, over that in the film
MOST_ROUNDS = 6
PICTURE_ROUNDS = 5  # rounds for free pictures
SAME_SHARE = 0.02  # share of the distance to the subject that an unstated clearance may cost
NEAR_M = 0.35  # metres beyond a clearance, within which half-spaces bind a place of rest
CLEARANCE_ROUNDS = 3  # rounds for the clearances of transfers
REACH_M = 4.0  # metres beyond its clearance, within which a standing obstacle counts
SHARES = (0.5, 0.95)  # as in planning.path.position
PROVED_M = 1e-6  # metres
ROUNDING_S = 1e-9  # seconds
GAIN_SHARE = 0.01
ASTRAY_M = 50.0  # metres, mean distance from the ideal beyond which a motion is refused
HOPE_SHARE = 0.8  # largest share of the lack that may remain after a round, to go on


@dataclass(frozen=True, slots=True, eq=False)
class PositionResult:
    """The position over mission time, or why there is none.

    objective : m^2 s
    rounds : number of programmes solved
    freed : whether it deviates to keep pictures free
    given_up : the price of free pictures, where they are given up
    """

    curve: Piecewise | None
    status: Status
    objective: float
    rounds: int
    relaxation: Relaxation | None = None
    freed: bool = False
    given_up: Price | None = None


def fly(task: ClockTask) -> PositionResult:
    """Return the position curve of a shot, with clearances proved by its convex hulls.

    It stays out of pictures as far as possible. Where free pictures are only preferred, and their price is
    too high or they stay occupied, the result ignores them.
    """
    task, plain = _apart(task, _fly(task, ()))
    if plain.curve is None:
        return plain
    best = plain
    pictures = _picture_half_spaces(task, plain.curve)
    for _ in range(PICTURE_ROUNDS):
        if pictures.worst >= 0.0 or best.curve is None:
            break
        freer = _fly(task, pictures.half_spaces)
        if freer.curve is None:
            break
        later = _picture_half_spaces(task, freer.curve)
        if later.worst <= pictures.worst + PROVED_M:
            break
        best, pictures = replace(freer, rounds=best.rounds + freer.rounds, freed=True), later
    if not prefers_free_pictures(task.mission) or best.curve is None:
        return best
    span, free = (task.clock.start, task.clock.end), pictures.worst >= 0.0
    price = cost(task.camera_task, span, plain.curve, best.curve)
    if free and price.little:
        return best
    return replace(plain, rounds=best.rounds, given_up=Price(price.moved, price.share, free))


def _apart(task: ClockTask, plain: PositionResult) -> tuple[ClockTask, PositionResult]:
    """Return the motion whose run-up and run-out keep the clearances of transfers, and its task.

    Clearances that the mission does not state may hardly change the film; otherwise the plain motion is
    returned.
    """
    if plain.curve is None or not task.motions:
        return task, plain
    span = (task.clock.start, task.clock.end)
    best, lack = (task, plain), lacking(task.motions, plain.curve, span)
    for _ in range(CLEARANCE_ROUNDS):
        if max(lack) <= 0.0 or best[1].curve is None:
            break
        wider = replace(task, apart=_apart_floors(task, best[1].curve))
        flown = _fly(wider, ())
        if flown.curve is None:
            break
        price = cost(task.camera_task, span, plain.curve, flown.curve)
        if lack.required <= 0.0 and (price.share > SAME_SHARE or price.crops):
            break
        later = lacking(task.motions, flown.curve, span)
        if later >= lack:
            break
        best, lack = (wider, replace(flown, rounds=best[1].rounds + flown.rounds)), later
    return best


def _apart_floors(task: ClockTask, course: Piecewise) -> tuple[HalfSpaceRows, ...]:
    """Return half-spaces for the clearances of the run-up and the run-out beside a course."""
    span, breaks, first = (task.clock.start, task.clock.end), task.clock.breaks, len(task.walls.owners)
    rows = motion_rows(breaks, sides_apart(task.motions, course, span), first)
    stands = zip(standing_apart(task.motions, course, span), (0, -1), strict=True)
    ends = [_standing(breaks, sides(at.motions, at.stands), first, row) for at, row in stands]
    return tuple(half_spaces for half_spaces in (rows, *ends) if len(half_spaces.offset))


def _picture_half_spaces(task: ClockTask, course: Piecewise) -> PictureHalfSpaces:
    span = (task.clock.start, task.clock.end)
    return keep_free(task.camera_task, task.visibility, span, task.clock.breaks, course)


@dataclass(frozen=True, slots=True, eq=False)
class _Round:
    """The state of the sequential convex programme: the linearisation of the next round, and results so far.

    hulls, reach, share : as of ``planning.corridor.Around``
    relaxation : of the last infeasible programme
    lacked : metres that it lacked, summed
    """

    hulls: Array
    reach: float = REACH_M
    share: float = SHARES[0]
    rounds: int = 0
    status: Status = Status.INFEASIBLE
    best: SplineSolution | None = None
    relaxation: Relaxation | None = None
    lacked: float = inf
    ended: bool = False


def _fly(task: ClockTask, free: tuple[HalfSpaceRows, ...]) -> PositionResult:
    """Return the position curve under additional half-spaces that keep pictures free."""
    breaks, base = task.clock.breaks, _base(task)
    places = ideal_of(task, breaks) if task.course is None else task.course.places
    chords = np.stack([places[:-1], places[1:]], axis=1)
    now, least = _Round(chords), least_of(base)
    while not now.ended and now.rounds < MOST_ROUNDS:
        problem = _walled(task, base, now.hulls, now.reach, now.share)
        problem = replace(problem, half_spaces=(*problem.half_spaces, *task.apart, *free))
        near = None if now.best is None else now.best.coef
        solution = minimise(problem, least=least, near=near)
        now = replace(now, rounds=now.rounds + 1, status=solution.status)
        if solution.coef is None:
            now = _relaxed(task, problem, now, HOPE_SHARE if free else inf)
            continue
        points = _points(breaks, solution.coef)
        if not _clear(task, points):
            hulls = points if now.rounds % 2 else chords
            now = replace(now, hulls=hulls, reach=2.0 * now.reach, share=SHARES[0])
        elif _astray(task, solution):
            now = replace(now, status=Status.INFEASIBLE, ended=True)
        else:
            now = _improved(now, solution, points, done=not problem.half_spaces)
    if now.best is None:
        return PositionResult(None, now.status, float("nan"), now.rounds, now.relaxation)
    assert now.best.coef is not None
    coef = with_ends(breaks, now.best.coef, _begin(task), None)
    return PositionResult(spline(breaks, coef), now.best.status, now.best.objective, now.rounds)


def _astray(task: ClockTask, solution: SplineSolution) -> bool:
    """Return whether a motion is far from its ideal.

    Planes that almost contradict each other leave a feasible point only where they cross, kilometres away.
    """
    return solution.objective > ASTRAY_M**2 * (task.clock.end - task.clock.start)


def _relaxed(task: ClockTask, problem: SplineProblem, now: _Round, hope: float) -> _Round:
    """Return the round that follows an infeasible programme.

    Half-spaces about a course that runs through an obstacle may contradict each other. The curve that
    violates them least gives a better linearisation.

    hope : largest ratio of the lack to the one before, for which it is worth going on
    """
    relaxed = relax(problem, len(task.owners)) if now.status is Status.INFEASIBLE else None
    after = replace(now, relaxation=relaxed)
    if now.best is not None or relaxed is None or relaxed.coef is None:
        return replace(after, ended=True)
    lacked = float(relaxed.owner_lack.sum())
    hulls = _points(task.clock.breaks, relaxed.coef)
    return replace(after, hulls=hulls, share=SHARES[0], lacked=lacked, ended=lacked > hope * now.lacked)


def _improved(now: _Round, solution: SplineSolution, points: Array, *, done: bool) -> _Round:
    """Return the round that follows a feasible motion; done : there is nothing to linearise again."""
    best = now.best
    if best is not None and solution.objective > (1 - GAIN_SHARE) * best.objective:
        return replace(now, ended=True)
    return replace(now, hulls=points, share=SHARES[1], best=solution, ended=done)


def _points(breaks: Array, coef: Array) -> Array:
    """Return the control points of every piece of a spline, shape (P, 6, 3)."""
    return control_rows(breaks).apply(coef).reshape(-1, 6, 3)


def _clear(task: ClockTask, points: Array) -> bool:
    """Return whether the hulls of a motion prove its clearances."""
    if shortfall(task.walls, points).max() > PROVED_M:
        return False
    stands = ((end.passing, end.place) for end in _stands(task, points))
    return all(
        shortfalls(motions, hulls, 0.0).max() <= PROVED_M
        for motions, hulls in ((task.motions, points), *stands)
    )


def _base(task: ClockTask) -> SplineProblem:
    breaks = task.clock.breaks
    step = np.diff(breaks)
    inner = (np.arange(SAMPLES_PER_PIECE) + 0.5) / SAMPLES_PER_PIECE
    times = (breaks[:-1, None] + step[:, None] * inner).ravel()
    rows = value_rows(breaks, times)
    weight = np.sqrt(np.where(task.clock.filmed, 1.0, FAINT_WEIGHT) * step / SAMPLES_PER_PIECE)[rows.piece]
    jerk = energy_rows(breaks, 3)
    gentle = np.where(task.clock.filmed, task.shot.smoothing**3, NORMAL_S**3 * sqrt(UNSEEN_WEIGHT))
    goals = (
        Goal(_scaled(rows, weight), weight[:, None] * drawn_to(task, times)),
        Goal(_scaled(jerk, gentle[jerk.piece]), np.zeros((len(jerk.piece), 3))),
    )
    held = _through(task, held_ends(breaks, _begin(task)))
    return SplineProblem(count(breaks), goals, held, (), limits_of(task.drone.limits, breaks))


def _begin(task: ClockTask) -> Array | None:
    """Return the state in which the motion begins, shape (3, 3); None for rest at any place."""
    return None if task.begins is None else task.begins.position


def _through(task: ClockTask, ends: Equalities) -> Equalities:
    """Return the constraints of both ends, and of given places at their times.

    Where the camera stands still in W for a while, all coefficients of that interval equal its place. For a
    hold beside a moving target the place is constrained at the start and at the end of the hold.
    """
    breaks, rows, values = task.clock.breaks, [ends.rows], [ends.value]
    for bound in (*task.held, *(() if task.free else task.bound)):
        if bound.still:
            first, last = np.searchsorted(breaks, np.array([bound.start, bound.end]) - ROUNDING_S)
            block = _coefficients(int(first), int(last) + DEGREE, len(breaks) - 1)
        else:
            block = value_rows(breaks, np.array([bound.start]))
        rows.append(block)
        values.append(np.tile(np.array(bound.place), (len(block.piece), 1)))
    every = SplineFunctionals(
        np.concatenate([r.piece for r in rows]), np.concatenate([r.weight for r in rows])
    )
    return Equalities(every, np.concatenate(values))


def _coefficients(first: int, last: int, pieces: int) -> SplineFunctionals:
    """Return rows that select the spline coefficients from index ``first`` to ``last``, exclusive."""
    index = np.arange(first, last)
    piece = np.minimum(index, pieces - 1)
    return SplineFunctionals(piece, np.eye(DEGREE + 1)[index - piece])


def _walled(task: ClockTask, base: SplineProblem, hulls: Array, reach: float, share: float) -> SplineProblem:
    breaks = task.clock.breaks
    problem = with_corridor(base, LinearisedCorridor(task.walls, breaks, hulls, reach, share))
    first = len(task.walls.owners)
    half_spaces = [motion_rows(breaks, sides(task.motions, hulls), first)]
    half_spaces += [
        _standing(breaks, sides(end.passing, end.place), first, end.row) for end in _stands(task, hulls)
    ]
    return replace(problem, half_spaces=(*problem.half_spaces, *(f for f in half_spaces if len(f.offset))))


def standing_by(
    motions: Sequence[Moving], breaks: Array, seconds: float
) -> tuple[tuple[LinearMotion, ...], tuple[LinearMotion, ...]]:
    """Return the obstacles' motions while the drone stands at the start of a motion, and at its end.

    breaks : shape (P + 1,), mission times of the motion, seconds
    seconds : how long it stands
    """
    begin, end = breaks[0], breaks[-1]
    windows = np.array([[begin - seconds, begin], [end, end + seconds]])
    before, after = (tuple(linearised(m, window) for m in motions) for window in windows)
    return before, after


def held_where_it_rests(task: ClockTask, curve: Piecewise) -> bool:
    """Return whether a motion rests so near to something that the half-spaces there may bind."""
    return any(
        shortfalls(end.passing, end.place, -NEAR_M).max() > -NEAR_M for end in _stands(task, curve.ctrl)
    )


class _RestEnd(NamedTuple):
    """An end of a motion: the obstacles while the drone stands there, its place, and its control row.

    place : as a piece's hull, shape (1, 2, 3)
    """

    passing: tuple[LinearMotion, ...]
    place: Array
    row: int


def _stands(task: ClockTask, hulls: Array) -> tuple[_RestEnd, ...]:
    """Return both ends of a motion."""
    ends = ((hulls[0, 0], 0), (hulls[-1, -1], -1))
    return tuple(
        _RestEnd(passing, np.tile(place, (1, 2, 1)), row)
        for passing, (place, row) in zip(task.passing, ends, strict=True)
    )


def _standing(breaks: Array, beside: HalfSpaces, first: int, row: int) -> HalfSpaceRows:
    """Return the half-spaces that hold for a control point the whole time."""
    every, number = control_rows(breaks), len(beside.piece)
    rows = SplineFunctionals(
        np.repeat(every.piece[[row]], number), np.repeat(every.weight[[row]], number, axis=0)
    )
    return HalfSpaceRows(
        rows, beside.normal, beside.offset.max(axis=1, initial=-np.inf), first + beside.owner
    )


def _scaled(rows: SplineFunctionals, factor: Array) -> SplineFunctionals:
    return SplineFunctionals(rows.piece, rows.weight * factor[:, None])
