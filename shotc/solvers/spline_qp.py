"""The curve of least energy as a second-order cone programme over B-spline coefficients (Clarabel).

The unknowns are the coefficients, component by component, then the excess over each priced bound. A mission
needs many curves of different structure, so their rows go to Clarabel directly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import SplineFunctionals
from shotc.solvers.cone_rows import ConeRows, Term, WarmStart
from shotc.solvers.conic import Status
from shotc.solvers.equality_qp import minimise_under_equalities
from shotc.solvers.spline_problem import (
    EVERY,
    Cones,
    Goal,
    SplineProblem,
    bounded,
    centred,
    scalar_map,
    terms,
)

MISS_M = 1e-6  # metres, tolerance of equalities
SOLVER_TOLERANCE = 1e-8
NEARLY_SHARE = 0.9  # share of a bound from which on a warm start counts as at the bound


@dataclass(frozen=True, slots=True, eq=False)
class SplineSolution:
    """The result of the solver.

    coef : shape (size, 3), or None unless the status is SOLVED or INACCURATE
    objective : the goals' sum of squares, m^2, without the cost of excess over priced bounds; excess : that
        cost
    """

    status: Status
    coef: Array | None
    objective: float
    excess: float


class Least(NamedTuple):
    """The part of a problem that does not depend on its bounds.

    centre : the origin of the solution, (3,); squares : the objective
    free : coefficients of the curve of least energy under the equalities alone, relative to that origin,
        (size, 3), or None if it is not unique
    """

    centre: Array
    squares: list[Square]
    free: Array | None


def least_of(problem: SplineProblem) -> Least:
    """Return the solution without bounds; problems that differ only in their bounds share it."""
    centre = problem.equalities.value.mean(axis=0)
    problem = centred(problem, centre)
    squares = squares_of(problem)
    return Least(centre, squares, _unbounded(problem, squares))


def minimise(
    problem: SplineProblem, unit: float = 1.0, *, least: Least | None = None, near: Array | None = None
) -> SplineSolution:
    """Return the curve of least energy under all constraints.

    unit : of the objective, m^2; the solver's tolerance is 1e-8 of it, or of the objective if that is larger
    least : the result of ``least_of``, if it is known
    near : coefficients (size, 3) of a curve whose active bounds are probably those of the solution
    Without active bounds the solution is one linear solve. A solution that violates an equality by more than
    MISS_M has the status FAILED.
    """
    centre, squares, free = least_of(problem) if least is None else least
    problem = centred(problem, centre)
    if free is not None and _keeps(problem, free):
        return SplineSolution(Status.SOLVED, free + centre, _energy(problem, free), 0.0)
    left = problem if free is None else _leaving(problem, free)
    origin = centre if free is None else free + centre
    solution = programme(left, squares, unit, None if near is None else near - origin)
    if solution.coef is None and (dear := _dearest(problem)) > unit:
        # The solver can take costs of many orders above the constraints for a certificate of infeasibility.
        solution = programme(left, squares, dear)
    if solution.coef is None:
        return solution
    coef = solution.coef + origin
    return replace(solution, coef=coef, objective=_energy(problem, coef - centre))


def _leaving(problem: SplineProblem, free: Array) -> SplineProblem:
    """Return the problem for the difference of the best curve from the one without bounds, which is small.

    The additional cost is the sum of squares of the difference alone, because the cost has no slope at
    ``free`` along the equalities.
    """

    def of(rows: SplineFunctionals, axes: tuple[int, ...] = EVERY) -> Array:
        return rows.apply(free)[:, list(axes)]

    return SplineProblem(
        problem.size,
        tuple(replace(g, value=np.zeros_like(g.value)) for g in problem.goals),
        replace(problem.equalities, value=problem.equalities.value - of(problem.equalities.rows)),
        tuple(replace(f, offset=f.offset - (of(f.rows) * f.normal).sum(axis=1)) for f in problem.half_spaces),
        tuple(replace(c, centre=c.centre - of(c.rows, c.axes)) for c in problem.cones),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Square:
    """The objective of the components with the same goals: |maps c - value|^2 for each.

    axes : these components; goals : their goals; maps : shape (R, size), sparse; gram : maps.T @ maps
    """

    axes: list[int]
    goals: list[Goal]
    maps: Any
    gram: Any

    def slope(self, goals: Sequence[Goal]) -> Array:
        """Return maps.T @ value for each component, shape (size, len(axes)); goals : with the values."""
        values = [goal.value[:, self.axes] for goal in goals if self.axes[0] in goal.axes]
        return np.asarray(self.maps.T @ np.concatenate([np.zeros((0, len(self.axes))), *values]))


def squares_of(problem: SplineProblem) -> list[Square]:
    """Return the objective, grouped by components with the same goals."""
    from scipy.sparse import csr_matrix, vstack

    squares, left = [], list(EVERY)
    while left:
        alike = [k for k in left if all((k in goal.axes) == (left[0] in goal.axes) for goal in problem.goals)]
        left = [k for k in left if k not in alike]
        mine = [goal for goal in problem.goals if alike[0] in goal.axes]
        each = (scalar_map(goal.rows, problem.size) for goal in mine)
        maps = vstack([csr_matrix((0, problem.size)), *each], format="csr")
        squares.append(Square(alike, mine, maps, maps.T @ maps))
    return squares


def _unbounded(problem: SplineProblem, squares: list[Square]) -> Array | None:
    """Return the curve of least energy under the equalities alone, or None if it is not unique.

    If it keeps all bounds, soft ones included, it is the optimum of the whole problem.
    """
    through = scalar_map(problem.equalities.rows, problem.size)
    coef = np.zeros((problem.size, 3))
    for square in squares:
        if not square.goals:
            return None
        equal = problem.equalities.value[:, square.axes]
        solved = minimise_under_equalities(square.gram, square.slope(problem.goals), through, equal)
        if solved is None:
            return None
        coef[:, square.axes] = solved
    return coef


def _keeps(problem: SplineProblem, coef: Array) -> bool:
    """Return whether coefficients keep every equality and bound; NaN keeps none."""
    return (
        _miss(problem, coef) <= MISS_M
        and all(((f.rows.apply(coef) * f.normal).sum(axis=1) >= f.offset).all() for f in problem.half_spaces)
        and all((_lengths(cone, coef) <= cone.bound).all() for cone in problem.cones)
    )


def _miss(problem: SplineProblem, coef: Array) -> float:
    """Return the largest violation of an equality, metres."""
    return float(np.abs(problem.equalities.rows.apply(coef) - problem.equalities.value).max(initial=0.0))


def _lengths(cone: Cones, coef: Array) -> Array:
    return np.asarray(np.linalg.norm(cone.rows.apply(coef)[:, list(cone.axes)] - cone.centre, axis=1))


def _energy(problem: SplineProblem, coef: Array) -> float:
    off = ((goal.rows.apply(coef) - goal.value)[:, list(goal.axes)] for goal in problem.goals)
    return float(sum((part**2).sum() for part in off))


def _dearest(problem: SplineProblem) -> float:
    """Return the highest price of a unit above a bound, 0 without priced bounds."""
    return max([0.0, *(float(cone.price.max()) for cone in problem.cones if cone.price is not None)])


def programme(
    problem: SplineProblem, squares: list[Square], unit: float = 1.0, near: Array | None = None
) -> SplineSolution:
    """Solve the cone programme with the objective in units of ``unit`` m^2.

    squares : the objective
    near : coefficients (size, 3), as in ``minimise``
    """
    priced = [cone for cone in problem.cones if cone.price is not None]
    slacks = sum(len(cone.bound) for cone in priced)
    rows = ConeRows(3 * problem.size + slacks)
    at, price = 3 * problem.size, [np.zeros(3 * problem.size)]
    for axis in EVERY:
        equal = problem.equalities
        rows.zero(terms(equal.rows, first=axis * problem.size), -equal.value[:, axis])
    for floor in problem.half_spaces:
        along = (terms(floor.rows, floor.normal[:, axis], axis * problem.size) for axis in EVERY)
        rows.positive(-floor.offset, list(chain.from_iterable(along)))
    for cone in problem.cones:
        more: list[Term] = []
        if cone.price is not None:
            one = np.ones(len(cone.bound))
            more = [(np.arange(at, at + len(one)), one)]
            rows.positive(0.0 * one, more)
            price.append(cone.price)
            at += len(one)
        bounded(rows, problem.size, cone, more)
    hessian, slope = _quadratic(problem, squares, slacks)
    start = WarmStart(np.zeros(rows.unknowns), 1.0)
    if near is not None:
        start = WarmStart(np.concatenate([near.T.ravel(), np.zeros(slacks)]), NEARLY_SHARE)
    status, x = rows.solve(
        (slope + np.concatenate(price)) / unit, SOLVER_TOLERANCE, hessian / unit, near=start
    )
    if status not in {Status.SOLVED, Status.INACCURATE}:
        return SplineSolution(status, None, float("nan"), float("nan"))
    coef = np.ascontiguousarray(x[: 3 * problem.size].reshape(3, problem.size).T)
    if _miss(problem, coef) > MISS_M:
        return SplineSolution(Status.FAILED, None, float("nan"), float("nan"))
    excess = float(np.concatenate(price)[3 * problem.size :] @ x[3 * problem.size :])
    return SplineSolution(status, coef, _energy(problem, coef), excess)


def _quadratic(problem: SplineProblem, squares: list[Square], slacks: int) -> tuple[Any, Array]:
    """Return Hessian and slope of the goals' sum of squares over all unknowns; those of slacks are 0."""
    from scipy.sparse import block_diag, csc_matrix

    grams, slope = [None] * len(EVERY), np.zeros((problem.size, len(EVERY)))
    for square in squares:
        slope[:, square.axes] = -2.0 * square.slope(problem.goals)
        for axis in square.axes:
            grams[axis] = 2.0 * square.gram
    hessian = block_diag([*grams, csc_matrix((slacks, slacks))], format="csc")
    return hessian, np.concatenate([slope.T.ravel(), np.zeros(slacks)])
