"""Where the camera is: the spline over time nearest to the ideal that the limits and the free space allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import DEGREE, Rows, control_rows, count, energy_rows, spline, value_rows
from shotc.ir.preference import Price, prefers_free_pictures
from shotc.ir.smoothing import NORMAL_S
from shotc.planning.clock.between import lacking, sides_apart, standing_apart
from shotc.planning.clock.bounds import at_rest, limits_of
from shotc.planning.clock.moving import LinearMotion, Moving, linearised, motion_rows, shortfalls, sides
from shotc.planning.clock.preferred import cost
from shotc.planning.clock.task import Task, drawn_to, ideal_of
from shotc.planning.clock.visibility import Kept, keep_free
from shotc.planning.corridor import Around, with_corridor
from shotc.planning.free_space import HalfSpaces, shortfall
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import Equalities, Goal, HalfSpaceRows, SplineProblem
from shotc.solvers.spline_qp import SplineSolution, minimise
from shotc.solvers.spline_relax import Relaxation, relax

SAMPLES_PER_PIECE = 3  # of the ideal, a piece
FAINT_WEIGHT = 1e-3  # weight of the ideal's course beyond the film's ends, against that in the film
UNSEEN_WEIGHT = 0.005  # weight of jerk beyond the film's ends, against that in the film
ROUNDS = 6
PICTURE_ROUNDS = 5  # rounds in which pictures are kept free
SAME_SHARE = 0.02  # of its distance from whom it films, by which a camera moves for what is not written
NEAR_M = 0.35  # metres beyond a clearance, within which a place of rest is held: planes keep COMFORT
CLEARANCE_ROUNDS = 3  # rounds in which the clearances of ways between shots are sought
REACH_M = 4.0  # metres beyond its clearance within which something that stands counts
SHARES = (0.5, 0.95)  # as in planning.path.position
PROVED_M = 1e-6  # metres
ROUNDING_S = 1e-9  # seconds
GAIN_SHARE = 0.01
ASTRAY_M = 50.0  # metres off its ideal on average over the film: a motion so far off is none
HOPE_SHARE = 0.8  # what is left of the lack by which a picture is not free, from round to round, to go on


@dataclass(frozen=True, slots=True, eq=False)
class Flown:
    """The position over mission time, or why there is none.

    objective : m^2 s; rounds : programmes solved
    freed : whether it gives way to keep pictures free; given_up : what that would cost, where it does not
    """

    curve: Piecewise | None
    status: Status
    objective: float
    rounds: int
    relaxation: Relaxation | None = None
    freed: bool = False
    given_up: Price | None = None


def fly(task: Task) -> Flown:
    """Return the position curve of a shot, proved clear by its hulls, out of pictures as far as it can be.

    As if nobody looked, where that is only preferred and takes more than a preference may, or does not do.
    """
    task, plain = _apart(task, _fly(task, ()))
    if plain.curve is None:
        return plain
    best = plain
    kept = _kept(task, plain.curve)
    for _ in range(PICTURE_ROUNDS):
        if kept.worst >= 0.0 or best.curve is None:
            break
        freer = _fly(task, kept.half_spaces)
        if freer.curve is None:
            break
        later = _kept(task, freer.curve)
        if later.worst <= kept.worst + PROVED_M:
            break
        best, kept = replace(freer, rounds=best.rounds + freer.rounds, freed=True), later
    if not prefers_free_pictures(task.mission) or best.curve is None:
        return best
    span, free = (task.clock.start, task.clock.end), kept.worst >= 0.0
    price = cost(task.camera_task, span, plain.curve, best.curve)
    if free and price.little:
        return best
    return replace(plain, rounds=best.rounds, given_up=Price(price.moved, price.share, free))


def _apart(task: Task, plain: Flown) -> tuple[Task, Flown]:
    """Return the motion whose ways into and out of the film keep the clearances of such ways, and its task.

    Where they are not written down they hardly move the film: where they would, it is the plain motion.
    """
    if plain.curve is None or not task.motions:
        return task, plain
    span = (task.clock.start, task.clock.end)
    best, lack = (task, plain), lacking(task.motions, plain.curve, span)
    for _ in range(CLEARANCE_ROUNDS):
        if max(lack) <= 0.0 or best[1].curve is None:
            break
        wider = replace(task, apart=_apart_floors(task, best[1].curve))
        made = _fly(wider, ())
        if made.curve is None:
            break
        price = cost(task.camera_task, span, plain.curve, made.curve)
        if lack.required <= 0.0 and (price.share > SAME_SHARE or price.crops):
            break
        later = lacking(task.motions, made.curve, span)
        if later >= lack:
            break
        best, lack = (wider, replace(made, rounds=best[1].rounds + made.rounds)), later
    return best


def _apart_floors(task: Task, course: Piecewise) -> tuple[HalfSpaceRows, ...]:
    """Return half-spaces beside a course for the clearances of the ways into the film and out of it."""
    span, breaks, first = (task.clock.start, task.clock.end), task.clock.breaks, len(task.walls.owners)
    ways = motion_rows(breaks, sides_apart(task.motions, course, span), first)
    stands = zip(standing_apart(task.motions, course, span), (0, -1), strict=True)
    ends = [_standing(breaks, sides(at.motions, at.stands), first, row) for at, row in stands]
    return tuple(half_spaces for half_spaces in (ways, *ends) if len(half_spaces.offset))


def _kept(task: Task, course: Piecewise) -> Kept:
    span = (task.clock.start, task.clock.end)
    return keep_free(task.camera_task, task.visibility, span, task.clock.breaks, course)


@dataclass(frozen=True, slots=True, eq=False)
class _Round:
    """What the next programme is set up about, and what came of those before it.

    hulls, reach, share : as of ``planning.corridor.Around``
    relaxation : of the last one that had no solution; lacked : metres that it lacked, all together
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


def _fly(task: Task, free: tuple[HalfSpaceRows, ...]) -> Flown:
    """Return the position curve under half-spaces that keep pictures free."""
    breaks, base = task.clock.breaks, _base(task)
    places = ideal_of(task, breaks) if task.course is None else task.course.places
    chords = np.stack([places[:-1], places[1:]], axis=1)
    now = _Round(chords)
    while not now.ended and now.rounds < ROUNDS:
        problem = _walled(task, base, now.hulls, now.reach, now.share)
        problem = replace(problem, half_spaces=(*problem.half_spaces, *task.apart, *free))
        solution = minimise(problem)
        now = replace(now, rounds=now.rounds + 1, status=solution.status)
        if solution.coef is None:
            now = _relaxed(task, problem, now, HOPE_SHARE if free else inf)
            continue
        points = _points(breaks, solution.coef)
        if _lack(task, points) > PROVED_M:
            hulls = points if now.rounds % 2 else chords
            now = replace(now, hulls=hulls, reach=2.0 * now.reach, share=SHARES[0])
        elif _astray(task, solution):
            now = replace(now, status=Status.INFEASIBLE, ended=True)
        else:
            now = _improved(now, solution, points, done=not problem.half_spaces)
    if now.best is None:
        return Flown(None, now.status, float("nan"), now.rounds, now.relaxation)
    assert now.best.coef is not None
    return Flown(spline(breaks, now.best.coef), now.best.status, now.best.objective, now.rounds)


def _astray(task: Task, solution: SplineSolution) -> bool:
    """Tell whether a motion is nowhere near its ideal.

    Planes that all but contradict each other leave room only where they cross, kilometres away.
    """
    return solution.objective > ASTRAY_M**2 * (task.clock.end - task.clock.start)


def _relaxed(task: Task, problem: SplineProblem, now: _Round, hope: float) -> _Round:
    """Return what follows a programme without a solution.

    hope : how much of what lacked before may lack now for it to be worth going on
    Planes about a course that runs through something may contradict each other; about the curve that breaks
    them least there are better ones.
    """
    found = relax(problem, len(task.owners)) if now.status is Status.INFEASIBLE else None
    after = replace(now, relaxation=found)
    if now.best is not None or found is None or found.coef is None:
        return replace(after, ended=True)
    lacked = float(found.owner_lack.sum())
    hulls = _points(task.clock.breaks, found.coef)
    return replace(after, hulls=hulls, share=SHARES[0], lacked=lacked, ended=lacked > hope * now.lacked)


def _improved(now: _Round, solution: SplineSolution, points: Array, *, done: bool) -> _Round:
    """Return what follows a motion that holds; done : there is nothing that it could be put beside anew."""
    best = now.best
    if best is not None and solution.objective > (1 - GAIN_SHARE) * best.objective:
        return replace(now, ended=True)
    return replace(now, hulls=points, share=SHARES[1], best=solution, ended=done)


def _points(breaks: Array, coef: Array) -> Array:
    """Return the control points of every piece of a spline, shape (P, 6, 3)."""
    return control_rows(breaks).apply(coef).reshape(-1, 6, 3)


def _lack(task: Task, points: Array) -> float:
    """Return the most metres by which the hulls of a motion do not prove that it is clear."""
    lacking = np.maximum(shortfall(task.walls, points), shortfalls(task.motions, points))
    standing = (shortfalls(end.passing, end.place).max() for end in _stands(task, points))
    return float(max(lacking.max(), *standing))


def _base(task: Task) -> SplineProblem:
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
    rest = at_rest(breaks)
    still = Equalities(rest, np.zeros((len(rest.piece), 3)))
    held = still if task.free else _through(task, still)
    return SplineProblem(count(breaks), goals, held, (), limits_of(task.drone.limits, breaks))


def _through(task: Task, rest: Equalities) -> Equalities:
    """Return the rest at both ends, and the places that the author gave to keyframes at their times.

    Where the camera stands still in the world for a while, all coefficients of that stretch are its place;
    beside a target it is there when a hold begins and when it ends.
    """
    breaks, rows, values = task.clock.breaks, [rest.rows], [rest.value]
    for bound in task.bound:
        if bound.still:
            first, last = np.searchsorted(breaks, np.array([bound.start, bound.end]) - ROUNDING_S)
            found = _coefficients(int(first), int(last) + DEGREE, len(breaks) - 1)
        else:
            found = value_rows(breaks, np.array([bound.start]))
        rows.append(found)
        values.append(np.tile(np.array(bound.place), (len(found.piece), 1)))
    every = Rows(np.concatenate([r.piece for r in rows]), np.concatenate([r.weight for r in rows]))
    return Equalities(every, np.concatenate(values))


def _coefficients(first: int, last: int, pieces: int) -> Rows:
    """Return rows that are the coefficients of a spline from one index up to another, which is left out."""
    index = np.arange(first, last)
    piece = np.minimum(index, pieces - 1)
    return Rows(piece, np.eye(DEGREE + 1)[index - piece])


def _walled(task: Task, base: SplineProblem, hulls: Array, reach: float, share: float) -> SplineProblem:
    breaks = task.clock.breaks
    problem = with_corridor(base, Around(task.walls, breaks, hulls, reach, share))
    first = len(task.walls.owners)
    half_spaces = [motion_rows(breaks, sides(task.motions, hulls), first)]
    half_spaces += [
        _standing(breaks, sides(end.passing, end.place), first, end.row) for end in _stands(task, hulls)
    ]
    return replace(problem, half_spaces=(*problem.half_spaces, *(f for f in half_spaces if len(f.offset))))


def standing_by(
    motions: Sequence[Moving], breaks: Array, seconds: float
) -> tuple[tuple[LinearMotion, ...], tuple[LinearMotion, ...]]:
    """Return what passes while the drone stands so long where a motion begins, and where it ends.

    breaks : shape (P + 1,), mission times of the motion, seconds
    """
    begin, end = breaks[0], breaks[-1]
    windows = np.array([[begin - seconds, begin], [end, end + seconds]])
    before, after = (tuple(linearised(m, window) for m in motions) for window in windows)
    return before, after


def held_where_it_rests(task: Task, curve: Piecewise) -> bool:
    """Tell whether a motion rests so near to what passes there that this may move it."""
    return any(
        shortfalls(end.passing, end.place).max(initial=-inf) > -NEAR_M for end in _stands(task, curve.ctrl)
    )


class _Stand(NamedTuple):
    """An end of a motion: what passes while the drone stands there, where that is, and its control row.

    place : as a piece's hull, shape (1, 2, 3)
    """

    passing: tuple[LinearMotion, ...]
    place: Array
    row: int


def _stands(task: Task, hulls: Array) -> tuple[_Stand, ...]:
    """Return both ends of a motion."""
    ends = ((hulls[0, 0], 0), (hulls[-1, -1], -1))
    return tuple(
        _Stand(passing, np.tile(place, (1, 2, 1)), row)
        for passing, (place, row) in zip(task.passing, ends, strict=True)
    )


def _standing(breaks: Array, beside: HalfSpaces, first: int, row: int) -> HalfSpaceRows:
    """Return the half-spaces in which a control point stays all the while."""
    every, number = control_rows(breaks), len(beside.piece)
    rows = Rows(np.repeat(every.piece[[row]], number), np.repeat(every.weight[[row]], number, axis=0))
    return HalfSpaceRows(
        rows, beside.normal, beside.offset.max(axis=1, initial=-np.inf), first + beside.owner
    )


def _scaled(rows: Rows, factor: Array) -> Rows:
    return Rows(rows.piece, rows.weight * factor[:, None])
