"""The minimum-jerk path as a convex programme over B-spline coefficients (cvxpy, Clarabel).

Arrays in, arrays out. The unknown is a curve in three dimensions on one set of knots; every
constraint is a set of ``Rows`` of its coefficients. The problem is a second-order cone programme:
quadratic objective, linear equalities and inequalities, norm bounds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import DEGREE, IntArray, Rows
from shotc.solvers.conic import Status, solve

EVERY = (0, 1, 2)
MISS = 1e-6  # metres that a solution may miss an equality by
POINT_PRICE = 1.01  # of a metre that a point gives way: where a floor gives as little, the point stays


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """A term of the objective: sum over rows of |rows - value|^2 over ``axes``; value of shape (R, 3)."""

    rows: Rows
    value: Array
    axes: tuple[int, ...] = EVERY


@dataclass(frozen=True, slots=True, eq=False)
class Equalities:
    """Rows that are to equal ``value``, shape (K, 3)."""

    rows: Rows
    value: Array


@dataclass(frozen=True, slots=True, eq=False)
class Floors:
    """Rows whose component along ``normal``, shape (R, 3), is at least ``offset``, shape (R,).

    owner : shape (R,), an index of whom the row belongs to; it only matters to ``relax``
    """

    rows: Rows
    normal: Array
    offset: Array
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Cones:
    """Norm bounds |rows[axes] - centre| <= bound, as a second-order cone each.

    axes   : the components that count
    centre : shape (R, len(axes)); bound : shape (R,)
    price  : shape (R,), cost of each unit above the bound; None where the bound is hard
    owner  : shape (R,), as in Floors
    """

    rows: Rows
    axes: tuple[int, ...]
    centre: Array
    bound: Array
    price: Array | None
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class SplineProblem:
    """All of it; ``size`` is the number of coefficients per component."""

    size: int
    goals: tuple[Goal, ...]
    equalities: Equalities
    floors: tuple[Floors, ...] = ()
    cones: tuple[Cones, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class SplineSolution:
    """What the solver made of it.

    coef : shape (size, 3), or None unless the status is SOLVED or INACCURATE
    objective : the goals' sum of squares, m^2, without the price of slack; excess : that price
    """

    status: Status
    coef: Array | None
    objective: float
    excess: float


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """The least changes that let an infeasible problem be solved.

    coef : shape (size, 3), the curve they allow
    floor_lack : per owner of hard floors and cones, by how much it must give way, metres
    point_shift : per equality, by how far its point must move, metres
    """

    status: Status
    coef: Array | None
    floor_lack: Array
    point_shift: Array


def minimise(problem: SplineProblem) -> SplineSolution:
    """Return the curve of least energy under all constraints.

    Where no bound bites, that is one linear solve, and no programme. A solution that misses an
    equality by more than MISS is none: its status is FAILED.
    """
    centre = problem.equalities.value.mean(axis=0)
    problem = _moved(problem, -centre)
    coef = _unbounded(problem)
    if coef is not None:
        return SplineSolution(Status.SOLVED, coef + centre, _energy(problem, coef), 0.0)
    found = _programme(problem)
    if found.coef is None and (unit := _dearest(problem)) > 1.0:
        # Costs of many orders above the constraints pass for a certificate that there is no solution.
        found = _programme(problem, unit)
    return found if found.coef is None else replace(found, coef=found.coef + centre)


def _unbounded(problem: SplineProblem) -> Array | None:
    """Return the curve of least energy through the equalities, or None where it breaks a bound.

    One that breaks none, soft ones included, is the optimum of the whole problem.
    """
    from scipy.sparse import bmat, vstack
    from scipy.sparse.linalg import splu

    through = scalar_map(problem.equalities.rows, problem.size)
    coef = np.zeros((problem.size, 3))
    left = list(EVERY)
    while left:
        mine = [goal for goal in problem.goals if left[0] in goal.axes]
        alike = [k for k in left if all((k in goal.axes) == (left[0] in goal.axes) for goal in problem.goals)]
        left = [k for k in left if k not in alike]
        if not mine:
            return None
        maps = vstack([scalar_map(goal.rows, problem.size) for goal in mine], format="csr")
        system = bmat([[maps.T @ maps, through.T], [through, None]], format="csc")
        wanted = maps.T @ np.concatenate([goal.value[:, alike] for goal in mine])
        try:
            solved = splu(system).solve(np.concatenate([wanted, problem.equalities.value[:, alike]]))
        except RuntimeError:  # singular: goals and equalities leave a direction free
            return None
        coef[:, alike] = solved[: problem.size]
    return coef if _keeps(problem, coef) else None


def _keeps(problem: SplineProblem, coef: Array) -> bool:
    """Tell whether coefficients keep every equality and bound; NaN keeps none."""

    def lengths(cone: Cones) -> Array:
        return np.asarray(np.linalg.norm(cone.rows.apply(coef)[:, list(cone.axes)] - cone.centre, axis=1))

    miss = np.abs(problem.equalities.rows.apply(coef) - problem.equalities.value)
    return (
        bool((miss <= MISS).all())
        and all(((f.rows.apply(coef) * f.normal).sum(axis=1) >= f.offset).all() for f in problem.floors)
        and all((lengths(cone) <= cone.bound).all() for cone in problem.cones)
    )


def _energy(problem: SplineProblem, coef: Array) -> float:
    off = ((goal.rows.apply(coef) - goal.value)[:, list(goal.axes)] for goal in problem.goals)
    return float(sum((part**2).sum() for part in off))


def _dearest(problem: SplineProblem) -> float:
    """Return the highest price of a unit above a bound, at least 1."""
    return max([1.0, *(float(cone.price.max()) for cone in problem.cones if cone.price is not None)])


def _programme(problem: SplineProblem, unit: float = 1.0) -> SplineSolution:
    """Solve with the objective measured in ``unit`` m^2, which changes only the arithmetic."""
    import cvxpy as cp

    x = cp.Variable(3 * problem.size)
    constraints = [_block(problem.equalities.rows, problem.size) @ x == problem.equalities.value.T.ravel()]
    constraints += [_floor_map(f, problem.size) @ x >= f.offset for f in problem.floors]
    price: Any = 0.0
    for cone in problem.cones:
        bound: Any = cone.bound
        if cone.price is not None:
            slack = cp.Variable(len(cone.bound), nonneg=True)
            bound = bound + slack
            price = price + (cone.price / unit) @ slack
        constraints.append(_cone(cone, problem.size, x, bound))
    energy = cp.sum_squares(_stack(problem, x) / unit**0.5)
    programme = cp.Problem(cp.Minimize(energy + price), constraints)
    status = solve(programme)
    if x.value is None or status not in {Status.SOLVED, Status.INACCURATE}:
        return SplineSolution(status, None, float("nan"), float("nan"))
    coef, objective = _coef(x, problem.size), float(energy.value) * unit
    if np.abs(problem.equalities.rows.apply(coef) - problem.equalities.value).max() > MISS:
        return SplineSolution(Status.FAILED, None, float("nan"), float("nan"))
    return SplineSolution(status, coef, objective, float(programme.value) * unit - objective)


def relax(problem: SplineProblem, owners: int) -> Relaxation:
    """Return the smallest give-way (sum of metres) of floors, hard cones and points that is feasible.

    Soft cones and the energy are left out: they never stop anything.
    """
    import cvxpy as cp

    centre = problem.equalities.value.mean(axis=0)
    problem = _moved(problem, -centre)
    x = cp.Variable(3 * problem.size)
    lack = cp.Variable(max(owners, 1), nonneg=True)
    points = len(problem.equalities.value)
    shift = cp.Variable(points, nonneg=True)
    miss = _block(problem.equalities.rows, problem.size) @ x - problem.equalities.value.T.ravel()
    constraints = [cp.SOC(shift, cp.reshape(miss, (points, 3), order="F"), axis=1)]
    constraints += [_floor_map(f, problem.size) @ x + lack[f.owner] >= f.offset for f in problem.floors]
    hard = [cone for cone in problem.cones if cone.price is None]
    constraints += [_cone(c, problem.size, x, c.bound + lack[c.owner]) for c in hard]
    programme = cp.Problem(cp.Minimize(cp.sum(lack) + POINT_PRICE * cp.sum(shift)), constraints)
    status = solve(programme)
    if x.value is None:
        return Relaxation(status, None, np.zeros(owners), np.zeros(points))
    return Relaxation(
        status, _coef(x, problem.size) + centre, np.asarray(lack.value), np.asarray(shift.value)
    )


def _moved(problem: SplineProblem, by: Array) -> SplineProblem:
    """Move a whole problem, so that numbers stay small wherever in the world it lies.

    Coefficients move as the curve does; rows of values weigh them by 1 in sum, derivatives by 0.
    """

    def shift(rows: Rows) -> Array:
        return np.asarray(rows.weight.sum(axis=1)[:, None] * by)

    return SplineProblem(
        problem.size,
        tuple(replace(g, value=g.value + shift(g.rows)) for g in problem.goals),
        Equalities(problem.equalities.rows, problem.equalities.value + shift(problem.equalities.rows)),
        tuple(replace(f, offset=f.offset + (shift(f.rows) * f.normal).sum(axis=1)) for f in problem.floors),
        tuple(replace(c, centre=c.centre + shift(c.rows)[:, list(c.axes)]) for c in problem.cones),
    )


def scalar_map(rows: Rows, size: int) -> Any:
    """Return the rows as a sparse matrix over one component's coefficients, shape (R, size)."""
    from scipy.sparse import csr_matrix

    count = len(rows.piece)
    columns = rows.piece[:, None] + np.arange(DEGREE + 1)
    pointer = np.arange(0, (DEGREE + 1) * count + 1, DEGREE + 1)
    return csr_matrix((rows.weight.ravel(), columns.ravel(), pointer), shape=(count, size))


def _block(rows: Rows, size: int) -> Any:
    from scipy.sparse import block_diag

    one = scalar_map(rows, size)
    return block_diag([one, one, one], format="csr")


def _floor_map(floors: Floors, size: int) -> Any:
    from scipy.sparse import diags, hstack

    one = scalar_map(floors.rows, size)
    return hstack([diags(floors.normal[:, axis]) @ one for axis in range(3)], format="csr")


def _cone(cone: Cones, size: int, x: Any, bound: Any) -> Any:
    import cvxpy as cp
    from scipy.sparse import csr_matrix, hstack, vstack

    one = scalar_map(cone.rows, size)
    empty = csr_matrix(one.shape)
    picked = vstack([hstack([one if axis == i else empty for i in range(3)]) for axis in cone.axes])
    away = picked.tocsr() @ x - cone.centre.T.ravel()
    return cp.SOC(bound, cp.reshape(away, (len(cone.bound), len(cone.axes)), order="F"), axis=1)


def _stack(problem: SplineProblem, x: Any) -> Any:
    from scipy.sparse import vstack

    maps = vstack([_parts(goal, problem.size) for goal in problem.goals], format="csr")
    return maps @ x - np.concatenate([goal.value.T[list(goal.axes)].ravel() for goal in problem.goals])


def _parts(goal: Goal, size: int) -> Any:
    """Return the goal's rows as a sparse matrix over all coefficients, for its axes alone."""
    from scipy.sparse import bmat, csr_matrix

    one = scalar_map(goal.rows, size)
    empty = csr_matrix(one.shape)
    return bmat([[one if axis == i else empty for i in EVERY] for axis in goal.axes], format="csr")


def _coef(x: Any, size: int) -> Array:
    return np.ascontiguousarray(np.asarray(x.value).reshape(3, size).T)
