"""The least relaxation of an infeasible spline problem: an elastic second-order cone programme (Clarabel).

The unknowns are the coefficients, component by component, then the slack of each owner and the shift of each
point.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

import numpy as np

from shotc.geom.bernstein import Array
from shotc.solvers.cone_rows import USABLE, ConeRows
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import EVERY, SplineProblem, bounded, centred, terms

POINT_PRICE = 1.01  # cost of a point's shift per metre; if a half-space's slack suffices, the point stays
SOLVER_TOLERANCE = 1e-8


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """The least changes that make an infeasible problem feasible.

    coef : shape (size, 3), the curve with these changes
    owner_lack : slack of each owner of half-spaces and hard cones, metres
    point_shift : displacement of the point of each equality, metres
    """

    status: Status
    coef: Array | None
    owner_lack: Array
    point_shift: Array


def relax(problem: SplineProblem, owners: int) -> Relaxation:
    """Return the feasible relaxation of half-spaces, hard cones and points with the least sum of metres.

    Soft cones and the energy are omitted, because they cannot make a problem infeasible.
    """
    equal = problem.equalities
    centre, points = equal.value.mean(axis=0), len(equal.value)
    near = centred(problem, centre)
    curve = 3 * problem.size
    rows = ConeRows(curve + owners + points)
    given, moved = curve + np.arange(owners), curve + owners + np.arange(points)
    if owners:
        rows.positive(np.zeros(owners), [(given, np.ones(owners))])
    along = [terms(equal.rows, first=axis * problem.size) for axis in EVERY]
    rows.second_order(
        np.zeros(points), [[(moved, np.ones(points))], *along], rest=list(-near.equalities.value.T)
    )
    for floor in near.half_spaces:
        parts = (terms(floor.rows, floor.normal[:, axis], axis * problem.size) for axis in EVERY)
        lack = (given[floor.owner], np.ones(len(floor.offset)))
        rows.positive(-floor.offset, [*chain.from_iterable(parts), lack])
    for cone in near.cones:
        if cone.price is None:
            bounded(rows, problem.size, cone, [(given[cone.owner], np.ones(len(cone.bound)))])
    cost = np.concatenate([np.zeros(curve), np.ones(owners), np.full(points, POINT_PRICE)])
    status, x = rows.solve(cost, SOLVER_TOLERANCE)
    if status not in USABLE:
        return Relaxation(status, None, np.zeros(owners), np.zeros(points))
    coef = np.ascontiguousarray(x[:curve].reshape(3, problem.size).T)
    return Relaxation(status, coef + centre, x[given], x[moved])
