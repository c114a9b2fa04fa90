"""The cubic of least energy through given angles that keeps limits of rate and acceleration.

It is a quadratic programme in the free slopes. The acceleration of a cubic is linear on a piece, so its ends
bound it exactly. The rate is a parabola, bounded by the Bernstein points of parts of each piece.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.solvers.cone_rows import ConeRows
from shotc.solvers.conic import Status
from shotc.solvers.headings.energy import Energy, cubic
from shotc.solvers.headings.task import HeadingTask

PIECE_PARTS = 4  # parts of a piece, for its rate; the hull exceeds the parabola by 1/16 of its curvature term
INSIDE_SHARE = 1e-7  # share of the limits that is reserved for the solver's tolerance
SOLVER_TOLERANCE = 1e-9


def bounded_cubic(task: HeadingTask, energy: Energy, angles: Array) -> Piecewise | None:
    """Return the best curve through ``angles``, shape (K,), or None if none keeps the limits."""
    slope = energy.slopes(angles)
    if within_limits(task, angles, slope):
        return cubic(task.at, angles, slope)
    if len(angles) < 3 or task.excess > 0:
        return None
    rows, limits = _rows(task)
    count = len(angles)
    free = energy.free
    # v = slope + T y with T' H T = I makes the cost |y|^2.
    root = np.linalg.inv(np.linalg.cholesky(energy.hessian[np.ix_(free, free)])).T
    base = rows @ np.concatenate([angles, slope])
    spread = rows[:, free] @ root
    steps = _least(base, spread, limits * (1 - INSIDE_SHARE))
    if steps is None:
        return None
    slope = slope.copy()
    slope[1 : count - 1] += root @ steps
    return cubic(task.at, angles, slope) if within_limits(task, angles, slope) else None


def within_limits(task: HeadingTask, angles: Array, slope: Array) -> bool:
    """Return whether the cubic of these values and slopes, (N + 1,) each, keeps both limits everywhere."""
    h = np.diff(task.at)
    chord = np.diff(angles) / h
    first, last = slope[:-1], slope[1:]
    # psi' = first + x (2 b) + 3 x^2 c on x in [0, 1].
    b, c = 3 * chord - 2 * first - last, first + last - 2 * chord
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.where(c != 0.0, -b / (3 * c), 0.0)
    x = np.clip(x, 0.0, 1.0)
    rate = max(np.abs(slope).max(), np.abs(first + 2 * b * x + 3 * c * x * x).max())
    acceleration = max(np.abs(2 * b / h).max(), np.abs((2 * b + 6 * c) / h).max())
    return bool(rate <= task.rate * (1 + 1e-12) and acceleration <= task.acceleration * (1 + 1e-12))


def _rows(task: HeadingTask) -> tuple[Array, Array]:
    """Return rows over (values, slopes), and the limits of their magnitudes."""
    count = len(task.at)
    rows: list[Array] = []
    limits: list[float] = []
    for i, h in enumerate(np.diff(task.at)):
        quadratic = np.zeros((3, 2 * count))
        quadratic[0, count + i] = quadratic[2, count + i + 1] = 1.0
        quadratic[1, [i, i + 1, count + i, count + i + 1]] = [-3 / h, 3 / h, -1.0, -1.0]
        if np.isfinite(task.rate):
            for k in range(PIECE_PARTS):
                rows += _blossom(quadratic, k / PIECE_PARTS, (k + 1) / PIECE_PARTS)
                limits += [task.rate] * 3
        if np.isfinite(task.acceleration):
            rows += list(np.diff(quadratic, axis=0) * 2 / h)
            limits += [task.acceleration] * 2
    return np.array(rows), np.array(limits)


def _blossom(points: Array, a: float, b: float) -> list[Array]:
    """Return the Bernstein points of a quadratic's part from a to b of [0, 1]."""
    at = {t: (1 - t) * points[:-1] + t * points[1:] for t in (a, b)}
    return [(1 - s) * at[t][0] + s * at[t][1] for t, s in ((a, a), (a, b), (b, b))]


def _least(base: Array, spread: Array, limits: Array) -> Array | None:
    """Return the shortest y with |base + spread y| <= limits, or None if there is none."""
    size = spread.shape[1]
    problem = ConeRows(size)
    for sign in (1.0, -1.0):
        terms = [(np.full(len(base), j), -sign * spread[:, j] / limits) for j in range(size)]
        problem.positive(1.0 - sign * base / limits, terms)
    status, y = problem.solve(np.zeros(size), SOLVER_TOLERANCE, np.ones(size))
    return y if status in {Status.SOLVED, Status.INACCURATE} else None
