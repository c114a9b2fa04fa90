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
    slack = np.minimum(points - task.low.ravel(), task.high.ravel() - points)
    if slack.min() >= -1e-9:
        return Status.SOLVED, coef
    return _bounded(task, coef)


def within(points: Array, low: Array | float, high: Array | float) -> Array:
    """Return Bernstein points clipped to their bounds if they violate them by more than rounding.

    points, low, high : of the same shape, or shapes that broadcast
    A moved point makes the curve less smooth at the breaks around it, so smaller violations stay;
    verification tolerates them.
    """
    inside = np.clip(points, low, high)
    return np.asarray(np.where(np.abs(inside - points) > TOUCH_TOLERANCE, inside, points))


def _least_squares(task: Fit) -> tuple[Any, Array]:
    from scipy.sparse import vstack

    size = count(task.breaks)
    root = np.sqrt(task.weight)
    samples = value_rows(task.breaks, task.at)
    parts = [
        scalar_map(_scaled(samples, root), size),
        scalar_map(_stiff(task, 1, task.stiffness[0]), size),
        scalar_map(_stiff(task, 3, task.stiffness[1]), size),
    ]
    rhs = np.concatenate([root * task.value, np.zeros(parts[1].shape[0] + parts[2].shape[0])])
    return vstack(parts, format="csr"), rhs


def _unbounded(task: Fit) -> Array | None:
    """Return the coefficients of the best curve without bounds; None if they are not unique."""
    matrix, rhs = _least_squares(task)
    size = matrix.shape[1]
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


def _bounded(task: Fit, free: Array) -> tuple[Status, Array]:
    """Solve for the change from the optimum without bounds, which keeps the numbers small."""
    matrix, _ = _least_squares(task)
    matrix = matrix / max(float(abs(matrix).max()), 1e-12)
    size = matrix.shape[1]
    assert task.low is not None
    assert task.high is not None
    points = control_rows(task.breaks)
    at = points.apply(free[:, None])[:, 0]
    programme = ConeRows(size)
    for sign, bound in ((1.0, task.low.ravel()), (-1.0, task.high.ravel())):
        bounds = np.isfinite(bound)
        rows = SplineFunctionals(points.piece[bounds], points.weight[bounds])
        programme.positive(sign * (at - bound)[bounds], terms(rows, sign))
    binding, _ = _anchors(task)
    if len(binding.piece):
        programme.zero(terms(binding))
    status, change = programme.solve(np.zeros(size), SOLVER_TOLERANCE, 2.0 * (matrix.T @ matrix))
    if status not in {Status.SOLVED, Status.INACCURATE}:
        return status, np.zeros(size)
    return status, np.asarray(free + change)


def _stiff(task: Fit, order: int, weight: float | Array) -> SplineFunctionals:
    rows = energy_rows(task.breaks, order)
    return _scaled(rows, np.sqrt(np.broadcast_to(weight, len(task.breaks) - 1))[rows.piece])


def _scaled(rows: SplineFunctionals, factor: Array | float) -> SplineFunctionals:
    scale = np.broadcast_to(np.asarray(factor, dtype=np.float64), rows.piece.shape)
    return SplineFunctionals(rows.piece, rows.weight * scale[:, None])
