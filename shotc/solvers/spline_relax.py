"""What has to give way for a spline to be found at all: an elastic programme (cvxpy, Clarabel).

It is solved where a mission is told what stands in its way, so it may take the time that modelling does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import Rows
from shotc.solvers.conic import Status, solve
from shotc.solvers.spline_problem import Cones, HalfSpaceRows, SplineProblem, centred, scalar_map

POINT_PRICE = 1.01  # of a metre that a point gives way: where a floor gives as little, the point stays


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """The least changes that let an infeasible problem be solved.

    coef : shape (size, 3), the curve they allow
    owner_lack : per owner of half-spaces and hard cones, by how much it must give way, metres
    point_shift : per equality, by how far its point must move, metres
    """

    status: Status
    coef: Array | None
    owner_lack: Array
    point_shift: Array


def relax(problem: SplineProblem, owners: int) -> Relaxation:
    """Return the smallest give-way (sum of metres) of half-spaces, hard cones and points that is feasible.

    Soft cones and the energy are left out: they never stop anything.
    """
    import cvxpy as cp

    centre = problem.equalities.value.mean(axis=0)
    problem = centred(problem, centre)
    x = cp.Variable(3 * problem.size)
    lack = cp.Variable(max(owners, 1), nonneg=True)
    points = len(problem.equalities.value)
    shift = cp.Variable(points, nonneg=True)
    miss = _block(problem.equalities.rows, problem.size) @ x - problem.equalities.value.T.ravel()
    constraints = [cp.SOC(shift, cp.reshape(miss, (points, 3), order="F"), axis=1)]
    constraints += [
        _half_space_map(f, problem.size) @ x + lack[f.owner] >= f.offset for f in problem.half_spaces
    ]
    hard = [cone for cone in problem.cones if cone.price is None]
    constraints += [_cone(c, problem.size, x, c.bound + lack[c.owner]) for c in hard]
    programme = cp.Problem(cp.Minimize(cp.sum(lack) + POINT_PRICE * cp.sum(shift)), constraints)
    status = solve(programme)
    if x.value is None:
        return Relaxation(status, None, np.zeros(owners), np.zeros(points))
    return Relaxation(
        status, _coef(x, problem.size) + centre, np.asarray(lack.value), np.asarray(shift.value)
    )


def _block(rows: Rows, size: int) -> Any:
    from scipy.sparse import block_diag

    one = scalar_map(rows, size)
    return block_diag([one, one, one], format="csr")


def _half_space_map(half_spaces: HalfSpaceRows, size: int) -> Any:
    from scipy.sparse import diags, hstack

    one = scalar_map(half_spaces.rows, size)
    return hstack([diags(half_spaces.normal[:, axis]) @ one for axis in range(3)], format="csr")


def _cone(cone: Cones, size: int, x: Any, bound: Any) -> Any:
    import cvxpy as cp
    from scipy.sparse import csr_matrix, hstack, vstack

    one = scalar_map(cone.rows, size)
    empty = csr_matrix(one.shape)
    picked = vstack([hstack([one if axis == i else empty for i in range(3)]) for axis in cone.axes])
    away = picked.tocsr() @ x - cone.centre.T.ravel()
    return cp.SOC(bound, cp.reshape(away, (len(cone.bound), len(cone.axes)), order="F"), axis=1)


def _coef(x: Any, size: int) -> Array:
    return np.ascontiguousarray(np.asarray(x.value).reshape(3, size).T)
