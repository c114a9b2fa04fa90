"""The quadratic programme of *display*, Sec. IV, for a whole fleet: the nearest splines within the limits.

For each drone the integral of the squared distance to the wanted spline is minimal (Eq. 7, 8) among splines
with the same first and last three control points, whose velocity, acceleration and jerk have all control
points within the limits. So the limits hold for all t. The paper bounds the velocity at k samples of a piece
(Eq. 11), which does not bound it between them, and the acceleration per axis (Eq. 9).

The method is ADMM (Boyd et al. 2011, over-relaxed as in Sec. 3.4.3). Each drone has a step length from a
fixed set, so that few matrices are inverted. The quadratic part is one dense matrix for all drones and axes,
and the rest are projections onto balls, discs and intervals. Drones within the limits are left alone. Drones
for which the iteration is too slow are solved by Clarabel.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE, differences, knots
from shotc.ir.limits import Limits
from shotc.solvers.cone_rows import ConeRows, Term
from shotc.solvers.conic import Status

Index = NDArray[np.intp]

FIXED_POINTS = 3
"""Fixed control points at each end."""

INNER = slice(FIXED_POINTS, -FIXED_POINTS)
"""All others, which are free by default."""

LIMIT_SHARE = 0.9998
"""Share of the limits that the iteration aims at: its remaining violation, ``EXACT_SHARE``, then exceeds
none.
"""

EXACT_SHARE = 1.5e-4
STATIONARY_SHARE = 5e-4
"""Largest remaining share of the objective's gradient."""

RELAXATION_RATIO = 1.7
STEP_RATIOS = 4.0 ** np.arange(-5, 6)
"""Step lengths relative to the mean curvature of the objective over that of the rows."""

ROUND_ITERATIONS = 20
"""Iterations between two evaluations of the residuals."""

MOST_ROUNDS = 60
BLOCK_DRONES = 128
"""Drones solved together: their rows fit the processor's cache."""


@dataclass(frozen=True, slots=True)
class DerivativeBounds:
    """The bounds of the derivatives' control points; per_axis : bound the acceleration of each
    axis (Eq. 9).
    """

    limits: Limits
    per_axis: bool = False

    def scaled(self, factor: float) -> DerivativeBounds:
        """Return all bounds times a factor."""
        motion = self.limits
        return replace(
            self,
            limits=motion._replace(
                speed=motion.speed * factor,
                climb=motion.climb * factor,
                descent=motion.descent * factor,
                acceleration=motion.usable_acceleration * factor,
                jerk=motion.jerk * factor,
            ),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Bounded:
    """The result for a fleet.

    coef : control points, shape (n, K, 3)
    failed : rows without a spline within the limits
    changed : number of drones that were changed
    iterations : of the slowest drone
    exact : number of drones that Clarabel solved
    """

    coef: Array
    failed: Index
    changed: int
    iterations: int
    exact: int


def overdraft(breaks: Array, coef: Array, bounds: DerivativeBounds) -> Array:
    """Return the largest share by which each drone's control points exceed its limits, shape (n,); 0 if none
    do.
    """
    worst = np.zeros(len(coef))
    for order in (1, 2, 3):
        values = np.matmul(differences(breaks, order), coef)
        worst = np.maximum(worst, _excess(values, order, bounds).max(axis=1, initial=0.0))
    return worst


def bounded(breaks: Array, reference: Array, bounds: DerivativeBounds, free: slice = INNER) -> Bounded:
    """Return for every drone the nearest spline within its bounds.

    Drones within the bounds are returned unchanged, bit for bit.

    breaks : shape (P + 1,)
    reference : control points, shape (n, P + 3, 3)
    free : the control points that may change
    """
    bad = np.flatnonzero(overdraft(breaks, reference, bounds) > 0.0)
    coef, failed, exact, most = reference.copy(), [], 0, 0
    if not len(bad):
        return Bounded(coef, bad, 0, 0, 0)
    programme = FleetProgramme(breaks, bounds.scaled(LIMIT_SHARE), free)
    for at in range(0, len(bad), BLOCK_DRONES):
        rows = bad[at : at + BLOCK_DRONES]
        coef[rows], done, iterations = programme.solve(reference[rows])
        most = max(most, iterations)
        for row in rows[~done | (overdraft(breaks, coef[rows], bounds) > 0.0)]:
            exact += 1
            solved = programme.solve_exactly(reference[row])
            if solved is None or overdraft(breaks, solved[None], bounds)[0] > 0.0:
                failed.append(int(row))
                solved = reference[row]
            coef[row] = solved
    return Bounded(coef, np.array(failed, dtype=np.intp), len(bad), most, exact)


def short(breaks: Array, coef: Array, bounds: DerivativeBounds, digits: int) -> Array:
    """Return control points (n, K, 3), rounded for those drones that stay within the bounds."""
    rounded = np.round(coef, digits)
    within = overdraft(breaks, rounded, bounds) <= 0.0
    return np.where(within[:, None, None], rounded, coef)


def deviation(breaks: Array) -> Array:
    """Return the matrix of Eq. 8: x.W.x is the integral of the squared spline, shape (P + 3, P + 3)."""
    t = knots(breaks)
    nodes, weights = np.polynomial.legendre.leggauss(DEGREE + 1)  # exact for degree 6
    half = np.diff(breaks)[:, None] / 2.0
    at = (breaks[:-1, None] + half * (1.0 + nodes)).ravel()
    from scipy.interpolate import BSpline

    basis = BSpline.design_matrix(at, t, DEGREE).toarray()
    return np.asarray((basis * (half * weights).ravel()[:, None]).T @ basis)


def _excess(values: Array, order: int, bounds: DerivativeBounds) -> Array:
    """Return the excess of derivatives of shape (n, R, 3) over their limits, as a share of these, (n, R)."""
    limits = bounds.limits
    if order == 1:
        across = np.hypot(values[..., 0], values[..., 1]) / limits.speed
        up, down = values[..., 2] / limits.climb, -values[..., 2] / limits.descent
        return np.asarray(np.maximum(across, np.maximum(up, down)) - 1.0)
    if order == 2 and bounds.per_axis:
        return np.asarray(np.abs(values).max(axis=-1) / limits.usable_acceleration - 1.0)
    limit = limits.usable_acceleration if order == 2 else limits.jerk
    return np.asarray(np.sqrt(np.einsum("nrd,nrd->nr", values, values)) / limit - 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class _DerivativeRows:
    """Rows of one derivative; scale : factor that normalises each, shape (R,)."""

    order: int
    span: slice
    scale: Array


class Optimum(NamedTuple):
    """Control points, which drones reached an optimum, (n,), and the iterations of the slowest."""

    points: Array
    done: NDArray[np.bool_]
    iterations: int


class FleetProgramme:
    """The data common to all drones with the same breaks; within : the control points that are free."""

    def __init__(self, breaks: Array, bounds: DerivativeBounds, within: slice = INNER) -> None:
        self.bounds, self.within = bounds, within
        weight = deviation(breaks)
        self.curvature = float(np.trace(weight) / len(weight))
        self.weight = weight / self.curvature
        blocks, self.rows, at = [], [], 0
        for order in (1, 2, 3):
            matrix = differences(breaks, order)
            touched = np.flatnonzero(matrix[:, within].any(axis=1))
            scale = 1.0 / np.linalg.norm(matrix[touched, within], axis=1)
            blocks.append(matrix[touched] * scale[:, None])
            self.rows.append(_DerivativeRows(order, slice(at, at + len(touched)), scale))
            at += len(touched)
        whole = np.concatenate(blocks)
        self.dense = whole
        self.free = csr_array(whole[:, within])
        self.back = csr_array(whole[:, within].T)
        self.ends = csr_array(np.delete(whole, within, axis=1))
        self.inner = self.weight[within, within]
        gram = np.asarray(whole[:, within].T @ whole[:, within])
        self.steps = STEP_RATIOS * float(np.trace(self.inner) / np.trace(gram))
        self.inverses = [np.linalg.inv(self.inner + step * gram) for step in self.steps]

    def solve(self, reference: Array) -> Optimum:
        """Return control points near the optimum, (n, K, 3), which drones reached it, and the slowest's
        iterations.
        """
        state = _Iterates.of(self, reference)
        solved = np.zeros(len(reference), dtype=bool)
        result, active, rounds = reference.copy(), np.arange(len(reference)), 0
        levels = np.full(len(reference), len(STEP_RATIOS) // 2)
        while len(active) and rounds < MOST_ROUNDS:
            rounds += 1
            for level in np.unique(levels[active]):
                some = active[levels[active] == level]
                primal, dual = state.iterate(some, int(level))
                finished = (primal < 1.0) & (dual < 1.0)
                solved[some[finished]] = True
                ratio = np.sqrt(primal.clip(1e-3) / dual.clip(1e-3))
                change = np.rint(np.log(ratio) / np.log(STEP_RATIOS[1] / STEP_RATIOS[0])).astype(int)
                levels[some] = np.clip(level + change, 0, len(STEP_RATIOS) - 1)
            active = np.flatnonzero(~solved)
        result[:, self.within] = state.points()
        return Optimum(result, solved, rounds * ROUND_ITERATIONS)

    def solve_exactly(self, reference: Array) -> Array | None:
        """Return one drone's optimum, shape (K, 3), by an interior-point method; None if there is none."""
        root = np.linalg.cholesky(self.inner + 1e-12 * np.eye(len(self.inner)))
        count = len(root)
        # Unknowns: the shifts of all free points, axis by axis, and their products with the matrix root.
        rows = ConeRows(6 * count)
        for axis in range(3):
            terms: list[Term] = [
                (np.full(count, 3 * count + axis * count) + np.arange(count), np.full(count, -1.0))
            ]
            terms += [(np.full(count, axis * count + k), root[k]) for k in range(count)]
            rows.zero(terms)
        base = self.dense @ reference
        for part in self.rows:
            self._cones(rows, part, base[part.span])
        cost = np.zeros(6 * count)
        squares = np.concatenate([np.zeros(3 * count), np.ones(3 * count)])
        status, x = rows.solve(cost, 1e-9, squares)
        if status is not Status.SOLVED:
            return None
        result = reference.copy()
        result[self.within] += x[: 3 * count].reshape(3, count).T
        return result

    def _cones(self, rows: ConeRows, part: _DerivativeRows, base: Array) -> None:
        limits, matrix = self.bounds.limits, self.dense[part.span, self.within]
        count = matrix.shape[1]

        def entry(axis: int, sign: float = 1.0) -> list[Term]:
            size = len(matrix)
            return [(np.full(size, axis * count + k), sign * matrix[:, k]) for k in range(count)]

        if part.order == 1:
            rows.second_order(limits.speed * part.scale, [[], entry(0), entry(1)], [base[:, 0], base[:, 1]])
            rows.positive(limits.climb * part.scale - base[:, 2], entry(2, -1.0))
            rows.positive(limits.descent * part.scale + base[:, 2], entry(2))
        elif part.order == 2 and self.bounds.per_axis:
            for axis in range(3):
                rows.positive(limits.usable_acceleration * part.scale - base[:, axis], entry(axis, -1.0))
                rows.positive(limits.usable_acceleration * part.scale + base[:, axis], entry(axis))
        else:
            limit = limits.usable_acceleration if part.order == 2 else limits.jerk
            rest = [base[:, axis] for axis in range(3)]
            rows.second_order(limit * part.scale, [[], *(entry(axis) for axis in range(3))], rest)

    def project(self, values: Array) -> Array:
        """Return the nearest rows within the bounds; values : shape (R, n, 3), changed in place."""
        for part in self.rows:
            _project(values[part.span], part, self.bounds)
        return values


def _project(values: Array, part: _DerivativeRows, bounds: DerivativeBounds) -> None:
    limits, scale = bounds.limits, part.scale[:, None]
    if part.order == 1:
        across = np.hypot(values[..., 0], values[..., 1])
        values[..., :2] *= np.minimum(1.0, limits.speed * scale / np.maximum(across, 1e-300))[..., None]
        np.clip(values[..., 2], -limits.descent * scale, limits.climb * scale, out=values[..., 2])
    elif part.order == 2 and bounds.per_axis:
        ceiling = (limits.usable_acceleration * scale)[..., None]
        np.clip(values, -ceiling, ceiling, out=values)
    else:
        limit = (limits.usable_acceleration if part.order == 2 else limits.jerk) * scale
        far = np.sqrt(np.einsum("rnd,rnd->rn", values, values))
        values *= np.minimum(1.0, limit / np.maximum(far, 1e-300))[..., None]


@dataclass(slots=True, eq=False)
class _Iterates:
    """The iterates of a block of drones: x (free points), z and u (rows), with the drones on the
    middle axis.
    """

    programme: FleetProgramme
    base: Array
    pull: Array
    reference: Array
    x: Array
    z: Array
    u: Array

    @staticmethod
    def of(programme: FleetProgramme, reference: Array) -> _Iterates:
        """Start at the wanted splines; wanted : shape (n, K, 3)."""
        flat = np.ascontiguousarray(np.moveaxis(reference, 1, 0))
        count = len(reference)
        ends = np.delete(flat, programme.within, axis=0)
        base = (programme.ends @ ends.reshape(len(ends), -1)).reshape(-1, count, 3)
        inner = flat[programme.within]
        pull = (programme.inner @ inner.reshape(len(inner), -1)).reshape(inner.shape)
        rows = (programme.free @ inner.reshape(len(inner), -1)).reshape(base.shape) + base
        return _Iterates(
            programme, base, pull, inner, inner.copy(), programme.project(rows), np.zeros_like(base)
        )

    def points(self) -> Array:
        """Return the free control points, shape (n, F, 3)."""
        return np.asarray(np.moveaxis(self.x, 0, 1))

    def iterate(self, some: Index, level: int) -> tuple[Array, Array]:
        """Iterate for some drones; return their residuals, feasible and stationary below 1, shape (m,) each.

        The multipliers u are stored without the step length, so that a drone's step length may change.
        """
        p, step, inverse = self.programme, self.programme.steps[level], self.programme.inverses[level]
        base, pull, z = self.base[:, some], self.pull[:, some], self.z[:, some]
        u = self.u[:, some] / step
        shape, flat = pull.shape, (len(pull), -1)
        for _ in range(ROUND_ITERATIONS):
            right = (p.back @ (z - u - base).reshape(len(z), -1)).reshape(shape)
            x = (inverse @ (pull + step * right).reshape(flat)).reshape(shape)
            rows = (p.free @ x.reshape(flat)).reshape(base.shape) + base
            relaxed = RELAXATION_RATIO * rows + (1.0 - RELAXATION_RATIO) * z
            z = p.project(relaxed + u)
            u += relaxed - z
        self.x[:, some], self.z[:, some], self.u[:, some] = x, z, u * step
        return self._violation(rows, z), self._slope(x, u * step, some)

    def _violation(self, rows: Array, z: Array) -> Array:
        """Return the distance of the rows from the bounded ones, as a share of the bounds."""
        limits, worst = self.programme.bounds.limits, np.zeros(rows.shape[1])
        least = min(limits.speed, limits.climb, limits.descent), limits.usable_acceleration, limits.jerk
        for part in self.programme.rows:
            gap = np.abs(rows[part.span] - z[part.span]) / part.scale[:, None, None]
            worst = np.maximum(worst, gap.max(axis=(0, 2), initial=0.0) / least[part.order - 1])
        return worst / EXACT_SHARE

    def _slope(self, x: Array, forces: Array, some: Index) -> Array:
        flat = (len(x), -1)
        slope = (self.programme.inner @ (x - self.reference[:, some]).reshape(flat)).reshape(x.shape)
        left = slope + (self.programme.back @ forces.reshape(len(forces), -1)).reshape(x.shape)
        size = np.sqrt(np.einsum("knd,knd->n", slope, slope))
        rest = np.sqrt(np.einsum("knd,knd->n", left, left))
        return np.asarray(rest / (STATIONARY_SHARE * np.maximum(size, 1e-9)))
