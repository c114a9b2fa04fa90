"""The position curve of one stretch: least jerk through its anchors, inside a convex corridor.

The half-spaces of the corridor first separate the routed polyline from obstacles, then the last solution,
until the objective stops improving. The Bernstein hulls of every returned curve prove its clearances. If the
polyline is one straight line, which routing has found to be free, it is the curve.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import (
    DEGREE,
    SplineFunctionals,
    control_rows,
    count,
    energy_rows,
    greville,
    hull_rows,
    restrict,
    spline,
    subdivide,
    value_rows,
)
from shotc.ir.limits import Limits
from shotc.ir.owners import Owner
from shotc.planning.corridor import LinearisedCorridor, with_corridor
from shotc.planning.free_space import FreeSpace, shortfall
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import Cones, Equalities, Goal, SplineProblem
from shotc.solvers.spline_qp import SplineSolution, least_of, minimise
from shotc.solvers.spline_relax import Relaxation, relax

PIECES_PER_CHORD = 3  # pieces per segment of the polyline
PULL_WEIGHT = 100.0  # weight of a generated keyframe that does not bind, over the energy in m^2
SIGHT_WEIGHT = 1e4  # weight of a place that leads a way to see its target
EXCESS_PRICE = 10.0  # price of speed and acceleration above nominal, over the energy in m^2
MOST_ROUNDS = 4
FIRST_SHARE = 0.5  # share of its slack that a chord keeps
LATER_SHARE = 0.95  # the same for a solved curve; less would use up the margins
PIECE_FACTORS = (1, 2, 4)
STRAIGHT_M = 1e-9  # metres
GAIN_SHARE = 0.01  # a round that improves the objective by less ends the iteration
GROWTH_RATIO = 2.0
PLANNED_SHARE = 0.9  # share of a half-width that is used; refiners need the rest


@dataclass(frozen=True, slots=True, eq=False)
class PolylineTask:
    """A polyline to be smoothed.

    corners : shape (M, 3)
    s : path parameter at the corners, shape (M,)
    bound : indices of corners that the curve passes, ends included
    pulled, pulled_at : points near which it should pass, and their parameters, shapes (G, 3) and (G,)
    pace : share of the limits at which it should be smooth
    pull : weight of a pulled point, over the energy in m^2
    widths : how far the curve may be from each segment, shape (M - 1,), metres; None where all are free
    """

    corners: Array
    s: Array
    bound: tuple[int, ...]
    pulled: Array
    pulled_at: Array
    pace: float
    pull: float = PULL_WEIGHT
    widths: Array | None = None

    @property
    def straight(self) -> bool:
        """Whether the corners lie on one line in order, so that the line itself costs nothing."""
        if len(self.pulled_at):
            return False
        chord = self.corners[-1] - self.corners[0]
        share = (self.s - self.s[0]) / (self.s[-1] - self.s[0])
        return bool(np.abs(self.corners - self.corners[0] - share[:, None] * chord).max() < STRAIGHT_M)


@dataclass(frozen=True, slots=True, eq=False)
class Solved:
    """A curve, or why there is none.

    curve : position over s, or None
    status : of the solver
    objective : m^2
    rounds : number of programmes solved
    relaxation, owners : least relaxation per owner of a constraint, where no curve was found
    """

    curve: Piecewise | None
    status: Status
    objective: float
    rounds: int
    relaxation: Relaxation | None = None
    owners: tuple[Owner, ...] = ()


def solve_stretch(
    space: FreeSpace, stretch: PolylineTask, limits: Limits, wide: FreeSpace | None = None
) -> Solved:
    """Return the curve of one stretch, proved clear in a free space.

    wide : the same free space with larger clearances, which the curve keeps as far as the polyline does
    Where no curve is within the widths of the stretch, it may leave them.
    """
    if stretch.straight:
        return Solved(_line(stretch), Status.SOLVED, 0.0, 0)
    solved = _solve(space, stretch, limits, wide)
    if solved.curve is not None or stretch.widths is None:
        return solved
    return _solve(space, replace(stretch, widths=None), limits, wide)


def _solve(space: FreeSpace, stretch: PolylineTask, limits: Limits, wide: FreeSpace | None) -> Solved:
    rounds = 0
    status, problem = Status.FAILED, None
    for finer in PIECE_FACTORS:
        breaks = _breaks(stretch, finer)
        problem, best, used = _iterate((space, wide or space), stretch, limits, breaks)
        rounds += used
        if isinstance(best, SplineSolution):
            assert best.coef is not None
            curve = _pinned(spline(breaks, best.coef), stretch)
            return Solved(curve, best.status, best.objective, rounds)
        status = best
        if status in {Status.FAILED, Status.UNBOUNDED}:
            break
    owners = space.owners
    relaxation = relax(problem, len(owners)) if problem and status is Status.INFEASIBLE else None
    return Solved(None, status, float("nan"), rounds, relaxation, owners)


def _breaks(stretch: PolylineTask, finer: int) -> Array:
    if stretch.widths is None:
        return subdivide(stretch.s, PIECES_PER_CHORD * finer)
    return breaks_of(stretch.s, stretch.widths, PIECES_PER_CHORD, finer)


def _line(stretch: PolylineTask) -> Piecewise:
    x = np.linspace(0.0, 1.0, 6)[:, None]
    ctrl = (1 - x) * stretch.corners[0] + x * stretch.corners[-1]
    line = Piecewise(stretch.s[[0, -1]], ctrl[None])
    return restrict(line, stretch.s)


class _Iterated(NamedTuple):
    """The last programme, its best solution or the status, and the number of programmes solved."""

    problem: SplineProblem
    best: SplineSolution | Status
    rounds: int


def _iterate(
    spaces: tuple[FreeSpace, FreeSpace], stretch: PolylineTask, limits: Limits, breaks: Array
) -> _Iterated:
    """Return the result of sequential convex programming on given breaks.

    spaces : the free space for the proof, and the one for the constraints
    """
    space, wide = spaces
    polyline = np.column_stack([np.interp(breaks, stretch.s, stretch.corners[:, k]) for k in range(3)])
    chords = np.stack([polyline[:-1], polyline[1:]], axis=1)
    base = _base_problem(stretch, limits, breaks)
    least = least_of(base)
    reach = max(2.0, 0.25 * float(np.diff(stretch.s).max()))
    hulls, share = chords, FIRST_SHARE
    best: SplineSolution | None = None
    problem = base
    for used in range(1, MOST_ROUNDS + 1):
        problem = with_corridor(base, LinearisedCorridor(wide, breaks, hulls, reach, share))
        solution = minimise(problem, least=least, near=None if best is None else best.coef)
        if solution.coef is None:
            return _Iterated(problem, best or solution.status, used)
        points = control_rows(breaks).apply(solution.coef).reshape(-1, 6, 3)
        if shortfall(space, points).max() > 1e-6:
            # The curve meets an obstacle that was out of the corridor's reach, so the reach grows.
            reach *= 4.0
            hulls, share = chords, FIRST_SHARE
            continue
        total = solution.objective + solution.excess
        settled = best is not None and total > (1 - GAIN_SHARE) * (best.objective + best.excess)
        best = solution if best is None or not settled else best
        if settled or not problem.half_spaces:
            break
        hulls, share = points, LATER_SHARE
    return _Iterated(problem, best or Status.INFEASIBLE, used)


def _base_problem(stretch: PolylineTask, limits: Limits, breaks: Array) -> SplineProblem:
    corners, s = stretch.corners, stretch.s
    scale = float(s[-1] - s[0]) / max(len(stretch.bound) + len(stretch.pulled_at) - 1, 1)
    jerk = _scaled(energy_rows(breaks, 3), scale**2.5)
    goals = [Goal(jerk, np.zeros((len(jerk.piece), 3)))]
    direction, speed = _nominal(stretch, limits, breaks)
    if len(stretch.bound) + len(stretch.pulled_at) < 3:
        bend = min(float(speed.min()) ** 2 / limits.usable_acceleration, 0.25 * float(s[-1] - s[0]))
        slope = _scaled(energy_rows(breaks, 1), scale**0.5 * (scale / bend) ** 2)
        unit = slope.apply(greville(breaks)[:, None])
        goals.append(Goal(slope, unit * direction[slope.piece]))
    if len(stretch.pulled_at):
        rows = _scaled(value_rows(breaks, stretch.pulled_at), stretch.pull**0.5)
        goals.append(Goal(rows, stretch.pull**0.5 * stretch.pulled))
    bound = list(stretch.bound)
    equalities = Equalities(value_rows(breaks, s[bound]), corners[bound])
    cones = _soft_limits(breaks, speed, limits, scale)
    if stretch.widths is not None:
        cones = (*cones, near_legs(breaks, s, corners, stretch.widths))
    return SplineProblem(count(breaks), tuple(goals), equalities, (), cones)


def _nominal(stretch: PolylineTask, limits: Limits, breaks: Array) -> tuple[Array, Array]:
    """Return each piece's direction q'(s) on the polyline and its nominal path velocity, m/s."""
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    leg = np.clip(np.searchsorted(stretch.s, middle) - 1, 0, len(stretch.s) - 2)
    direction = (np.diff(stretch.corners, axis=0) / np.diff(stretch.s)[:, None])[leg]
    flat = np.linalg.norm(direction[:, :2], axis=1)
    vertical = np.where(direction[:, 2] > 0, limits.climb, limits.descent)
    level = np.array([limits.speed_along(east, north) for east, north, _ in direction.tolist()])
    reach = np.minimum(level / np.maximum(flat, 1e-9), vertical / np.maximum(np.abs(direction[:, 2]), 1e-9))
    return direction, stretch.pace * reach


def _soft_limits(breaks: Array, speed: Array, limits: Limits, scale: float) -> tuple[Cones, ...]:
    """Return speed and acceleration at nominal path velocity, as norm bounds with a price.

    v = q' sd and a = q'' sd^2 at constant sd. These bounds only shape the path; the time pass enforces the
    real limits.
    """
    share = np.diff(breaks) / scale
    first, second = control_rows(breaks, 1), control_rows(breaks, 2)
    v1, v2 = speed[first.piece], speed[second.piece]
    unit = EXCESS_PRICE * scale**2

    def cone(
        rows: SplineFunctionals, axes: tuple[int, ...], centre: Array, bound: Array, price: float
    ) -> Cones:
        owner = np.zeros(len(bound), dtype=np.intp)
        return Cones(rows, axes, centre, bound, price * share[rows.piece], owner)

    still, push = np.zeros((len(v1), 1)), limits.usable_acceleration
    return (
        cone(first, (0, 1), np.array(limits.wind) / v1[:, None], limits.speed / v1, unit),
        cone(first, (2,), still, min(limits.climb, limits.descent) / v1, unit),
        cone(second, (0, 1, 2), np.zeros((len(v2), 3)), push / v2**2, unit * scale),
    )


def _pinned(curve: Piecewise, stretch: PolylineTask) -> Piecewise:
    """Set the ends to their exact values, so that joints are equal; the solver is accurate to 1e-8 m."""
    ctrl = curve.ctrl.copy()
    ctrl[0, 0], ctrl[-1, -1] = stretch.corners[0], stretch.corners[-1]
    return Piecewise(curve.breaks, ctrl)


def _scaled(rows: SplineFunctionals, factor: float) -> SplineFunctionals:
    return SplineFunctionals(rows.piece, rows.weight * factor)


def breaks_of(s: Array, widths: Array, parts: int, finer: int) -> Array:
    """Return breaks for legs between path parameters ``s``, (M,), metres; they are dense at corners.

    A curve that turns within a half-width needs pieces of about that length, so the pieces grow from there by
    a factor of two with the distance from a corner.

    widths : half-width of each leg, (M - 1,), metres; inf where it is free
    parts : equal pieces of a leg; finer : factor on the number of all pieces
    """
    inner: list[Array] = []
    for low, high, width in zip(s[:-1], s[1:], widths, strict=True):
        reach = (high - low) / (2.0 * parts)
        steps = width * GROWTH_RATIO ** np.arange(64.0)
        near = steps[steps < reach]
        even = np.linspace(low, high, parts + 1)[:-1]
        inner.append(np.sort(np.concatenate([even, low + near, high - near])))
    return subdivide(np.append(np.concatenate(inner), s[-1]), finer)


def near_legs(breaks: Array, s: Array, corners: Array, widths: Array) -> Cones:
    """Return the bounds that hold every piece within the half-width of its leg.

    They hold the control points of a piece in balls about points of its leg. The distance from a leg is
    convex, so the piece is then within the half-width throughout.

    breaks : shape (P + 1,); s, corners : of the polyline, (M,), (M, 3); widths : as in ``breaks_of``
    """
    rows = hull_rows(breaks, 0)
    own = np.arange(len(breaks) - 1).repeat(DEGREE + 1)
    share = np.tile(np.arange(DEGREE + 1) / DEGREE, len(breaks) - 1)
    first = np.concatenate([[True], np.arange(1, len(own)) % (DEGREE + 1) > 0])
    own, share = own[first], share[first]
    at = breaks[own] + share * np.diff(breaks)[own]
    leg = np.clip(np.searchsorted(s, 0.5 * (breaks[:-1] + breaks[1:])) - 1, 0, len(widths) - 1)[own]
    centre = np.column_stack([np.interp(at, s, corners[:, axis]) for axis in range(3)])
    held = np.isfinite(widths[leg])
    ends = np.append(leg[1:] != leg[:-1], False)  # a corner has the smaller half-width; it is passed anyway
    bound = np.where(ends, np.minimum(widths[leg], widths[np.minimum(leg + 1, len(widths) - 1)]), widths[leg])
    owner = np.zeros(int(held.sum()), dtype=np.intp)
    rows = type(rows)(rows.piece[held], rows.weight[held])
    return Cones(rows, (0, 1, 2), centre[held], PLANNED_SHARE * bound[held], None, owner)
