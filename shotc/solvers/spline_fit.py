"""The fit of a smooth scalar spline to samples, exact at anchors and within bounds. Angles use it.

Without active bounds the optimum is one sparse linear solve. Only with an active bound Clarabel solves a
quadratic programme.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import SplineFunctionals, control_rows, count, energy_rows, value_rows
from shotc.solvers.cone_rows import ConeRows
from shotc.solvers.conic import Status
from shotc.solvers.equality_qp import minimise_under_equalities
from shotc.solvers.spline_problem import scalar_map, terms

SOLVER_TOLERANCE = 1e-8
ROUNDING_RAD = 1e-9
LEAST_UNIT_RAD = 1e-4  # unit of a change in the solver
TOUCH_TOLERANCE = 3e-7  # a third of verification's tolerance of a limit


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A fitting problem for a scalar spline psi on ``breaks``, shape (P + 1,).

    at, value, weight : shape (M,), samples and their weights in the sum of squares
    anchor_at, anchor : shape (K,), distinct parameters and the exact values there
    stiffness : (rate, third) weights of the integrals of psi'^2 and psi'''^2, numbers or shape (P,)
    low, high : bounds on every Bernstein point, shape (P, 6) each, or None
    slope_at, slope : shape (L,), parameters and the exact derivatives there, or None
    """

    breaks: Array
    at: Array
    value: Array
    weight: Array
    anchor_at: Array
    anchor: Array
    stiffness: tuple[float | Array, float | Array]
    low: Array | None = None
    high: Array | None = None
    slope_at: Array | None = None
    slope: Array | None = None


def fit(task: Fit) -> tuple[Status, Array]:
    """Return the status and the coefficients, shape (P + 5,); zeros unless SOLVED or INACCURATE."""
    coef = _unbounded(task)
    if coef is None:
        return Status.FAILED, np.zeros(count(task.breaks))
    if task.low is None or task.high is None:
        return Status.SOLVED, coef
    points = control_rows(task.breaks).apply(coef[:, None])[:, 0]
    beyond = np.maximum(task.low.ravel() - points, points - task.high.ravel()).max()
    if beyond <= ROUNDING_RAD:
        return Status.SOLVED, coef
    return _bounded(task, coef, max(float(beyond), LEAST_UNIT_RAD))


def within(points: Array, low: Array | float, high: Array | float) -> Array:
    """Return Bernstein points clipped to their bounds if they violate them by more than rounding.

    points, low, high : of the same shape, or shapes that broadcast
    A moved point makes the curve less smooth at the breaks around it, so smaller violations stay;
    verification tolerates them.
    """
    inside = np.clip(points, low, high)
    return np.asarray(np.where(np.abs(inside - points) > TOUCH_TOLERANCE, inside, points))


def _costs(task: Fit) -> SplineFunctionals:
    """Return the rows whose squares add up to the cost, if the values are zero: samples, rate, third."""
    parts = (
        _scaled(value_rows(task.breaks, task.at), np.sqrt(task.weight)),
        _stiff(task, 1, task.stiffness[0]),
        _stiff(task, 3, task.stiffness[1]),
    )
    return SplineFunctionals(
        np.concatenate([p.piece for p in parts]), np.concatenate([p.weight for p in parts])
    )


def _unbounded(task: Fit) -> Array | None:
    """Return the coefficients of the best curve without bounds; None if they are not unique."""
    size = count(task.breaks)
    matrix = scalar_map(_costs(task), size)
    rhs = np.zeros(matrix.shape[0])
    rhs[: len(task.at)] = np.sqrt(task.weight) * task.value
    binding, bound = _anchors(task)
    fixed = scalar_map(binding, size) if len(bound) else _mean(task, size)
    bound = bound if len(bound) else np.array([np.average(task.value, weights=task.weight)])
    slope = (matrix.T @ rhs)[:, None]
    solved = minimise_under_equalities(matrix.T @ matrix, slope, fixed, bound[:, None])
    return None if solved is None else solved[:, 0]


def _mean(task: Fit, size: int) -> Any:
    """Return the sparse row of the samples' weighted mean, (1, P + 5).

    A constant has no energy, so the mean of the optimum is that of the values. Without anchors, this equation
    keeps the system regular where the weights are tiny beside the stiffness.
    """
    from scipy.sparse import csr_matrix

    samples = scalar_map(value_rows(task.breaks, task.at), size)
    return csr_matrix((samples.T @ (task.weight / task.weight.sum()))[None])


def _anchors(task: Fit) -> tuple[SplineFunctionals, Array]:
    """Return the rows of anchors and slopes, and their exact values."""
    rows = value_rows(task.breaks, task.anchor_at)
    if task.slope_at is None or task.slope is None:
        return rows, task.anchor
    slopes = value_rows(task.breaks, task.slope_at, 1)
    both = SplineFunctionals(
        np.concatenate([rows.piece, slopes.piece]), np.concatenate([rows.weight, slopes.weight])
    )
    return both, np.concatenate([task.anchor, task.slope])


def _bounded(task: Fit, free: Array, unit: float) -> tuple[Status, Array]:
    """Solve for the change from the optimum without bounds, which keeps the numbers small.

    unit : of the change in the solver, such as how far that optimum is beyond its bounds

    The residuals are unknowns of their own. Without them the Hessian would square the coefficients, which
    grow with the third power of the number of pieces, and Clarabel would end far from the optimum.
    """
    costs, size, points = _costs(task), count(task.breaks), control_rows(task.breaks)
    assert task.low is not None
    assert task.high is not None
    at = points.apply(free[:, None])[:, 0]
    programme = ConeRows(size + len(costs.piece))
    for sign, bound in ((1.0, task.low.ravel()), (-1.0, task.high.ravel())):
        bounds = np.isfinite(bound)
        rows = SplineFunctionals(points.piece[bounds], points.weight[bounds])
        programme.positive(sign * (at - bound)[bounds], terms(rows, sign))
    binding, _ = _anchors(task)
    if len(binding.piece):
        programme.zero(terms(binding))
    residuals = size + np.arange(len(costs.piece))
    programme.zero([*terms(costs), (residuals, np.full(len(residuals), -1.0))])
    hessian = np.where(np.arange(programme.unknowns) < size, 0.0, 2.0 / unit**2)
    status, change = programme.solve(np.zeros(programme.unknowns), SOLVER_TOLERANCE, hessian)
    if status not in {Status.SOLVED, Status.INACCURATE}:
        return status, np.zeros(size)
    return status, np.asarray(free + change[:size])


def _stiff(task: Fit, order: int, weight: float | Array) -> SplineFunctionals:
    rows = energy_rows(task.breaks, order)
    return _scaled(rows, np.sqrt(np.broadcast_to(weight, len(task.breaks) - 1))[rows.piece])


def _scaled(rows: SplineFunctionals, factor: Array | float) -> SplineFunctionals:
    scale = np.broadcast_to(np.asarray(factor, dtype=np.float64), rows.piece.shape)
    return SplineFunctionals(rows.piece, rows.weight * scale[:, None])
