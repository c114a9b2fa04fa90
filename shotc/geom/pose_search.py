"""The camera pose of least squared residuals within bounds, by Levenberg-Marquardt, in plain Python.

Residuals are differentiated by finite differences: five components are few. A component whose descent
direction leads over its bound stays on the bound, and the step is taken in the others.
"""

from collections.abc import Callable, Sequence
from operator import mul
from typing import NamedTuple

Pose = tuple[float, float, float, float, float]
"""East, North and Up in metres of W; yaw and pitch, rad."""
Residuals = list[float]

DIFFERENCE_SHARE = 1e-6  # step of a finite difference, as a share of the scale of its component
MOST_ROUNDS = 100
MOST_DAMPINGS = 12  # values of the damping in one round
SETTLED_SHARE = 1e-6  # least relative fall of the cost in a round


class PoseCost(NamedTuple):
    """The cost, the bounds on a pose, and the scale of steps in its components.

    cost : the residuals at a pose and the sum of their squares; None and infinity where there are none
    """

    cost: Callable[[Pose], tuple[Residuals | None, float]]
    low: Sequence[float]
    high: Sequence[float]
    scale: Sequence[float]


class _Iterate(NamedTuple):
    """A pose with its residuals and its cost; damping : of the next step."""

    pose: Pose
    residuals: Residuals | None
    cost: float
    damping: float


def least_cost_pose(search: PoseCost, start: Pose) -> tuple[Pose, float]:
    """Return the pose of least cost near an initial guess, and its cost."""
    pose = _within(start, search.low, search.high)
    best = _Iterate(pose, *search.cost(pose), damping=1e-3)
    for _ in range(MOST_ROUNDS):
        columns = _jacobian(search, best)
        if columns is None:
            break
        before, best = best.cost, _lowered(search, best, columns)
        if before - best.cost <= SETTLED_SHARE * max(before, 1e-12):
            break
    return best.pose, best.cost


def _jacobian(search: PoseCost, at: _Iterate) -> list[Residuals] | None:
    """Return the Jacobian of the residuals by finite differences; None where the cost is not defined."""
    if at.residuals is None:
        return None
    columns = []
    for i in range(5):
        # Step away from an active upper bound, so that values beyond it are not evaluated.
        nudge = DIFFERENCE_SHARE if at.pose[i] < search.high[i] else -DIFFERENCE_SHARE
        there, _ = search.cost(_moved(at.pose, i, nudge * search.scale[i]))
        if there is None:
            return None
        columns.append([(b - a) / nudge for a, b in zip(at.residuals, there, strict=True)])
    return columns


def _lowered(search: PoseCost, at: _Iterate, columns: list[Residuals]) -> _Iterate:
    """Return a pose of lower cost, with rising damping; the same pose if no step lowers the cost."""
    assert at.residuals is not None
    gradient = [dot(c, at.residuals) for c in columns]
    # A component whose descent direction leads over its bound stays on the bound.
    stopped = [
        (p <= a and g > 0) or (p >= b and g < 0)
        for p, a, b, g in zip(at.pose, search.low, search.high, gradient, strict=True)
    ]
    free = [i for i in range(5) if not stopped[i]]
    normal = [[dot(columns[i], columns[k]) for k in free] for i in free]
    damping = at.damping
    for _ in range(MOST_DAMPINGS):
        step = dict(zip(free, damped_step(normal, [gradient[i] for i in free], damping), strict=True))
        moved = tuple(p - search.scale[i] * step.get(i, 0.0) for i, p in enumerate(at.pose))
        later = _within(moved, search.low, search.high)
        residuals, value = search.cost(later)
        if value < at.cost:
            return _Iterate(later, residuals, value, max(damping * 0.1, 1e-12))
        damping *= 10.0
    return at._replace(damping=damping)


def _within(pose: Sequence[float], low: Sequence[float], high: Sequence[float]) -> Pose:
    x, y, z, yaw, pitch = (min(max(p, a), b) for p, a, b in zip(pose, low, high, strict=True))
    return (x, y, z, yaw, pitch)


def _moved(pose: Pose, i: int, step: float) -> Pose:
    values = list(pose)
    values[i] += step
    return tuple(values)  # type: ignore[return-value]


def dot(a: Residuals, b: Residuals) -> float:
    """Return the scalar product of two lists of residuals."""
    return float(sum(map(mul, a, b)))


def damped_step(normal: list[list[float]], gradient: list[float], damping: float) -> list[float]:
    """Solve damped normal equations (Marquardt) by Gaussian elimination with pivoting; return the n unknowns.

    normal : J^T J, n rows of n; gradient : right-hand side, n values; damping : share added to the diagonal
    """
    n = len(gradient)
    rows = [[*normal[i], gradient[i]] for i in range(n)]
    for i in range(n):
        rows[i][i] += damping * max(normal[i][i], 1e-9)
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        pivot = rows[i][i] or 1e-300
        for k in range(i + 1, n):
            share = rows[k][i] / pivot
            rows[k] = [a - share * b for a, b in zip(rows[k], rows[i], strict=True)]
    step = [0.0] * n
    for i in reversed(range(n)):
        rest = rows[i][n] - sum(rows[i][k] * step[k] for k in range(i + 1, n))
        step[i] = rest / (rows[i][i] or 1e-300)
    return step
