"""One step of the jerk-bounded retiming: a second-order cone program in b = sdot^2 and a = sddot.

The motion has a constant jerk in s on every cell, so rest at both ends needs no special case (b1 = 1.5 h a1
on the first cell). The shape of the speed inside a cell is that of the last iterate (``_SpeedShape``). Then
every limit is linear in b and a of the cell's two nodes,

    |q'' b + q' a| <= 1                                 at nodes and middles,
    |q' (a1 - a0) / h + r (3 q'' a + q''' b)| <= 1 / v  at both ends and the middle,

with derivatives divided by their limits, v the mean speed of the cell and r the speed over v.
1 / v is convex in v^2, so its tangent at the last iterate is a safe lower bound. The time of a cell is
proportional to 1 / (d0 + d1), d <= sqrt(b), which is convex too. Unknowns are scaled by the last iterate, so
they are near 1 although b spans many decades towards the ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.cone_rows import ConeRows, Term, WarmStart
from shotc.solvers.conic import Status

Array = NDArray[np.float64]

# Rows of a norm below this share of its limit are negligible and omitted.
NEGLIGIBLE_SHARE = 1e-9
NEAR_LIMIT_SHARE = 0.6  # share of its limit above which a norm of the last iterate may be active in the next
SOLVER_TOLERANCE = 1e-6
NEWTON_STEPS = 6  # to the middle of a cell; five leave an error of 1e-10, six none


@dataclass(frozen=True, slots=True, eq=False)
class NormLimit:
    """A norm with the upper limit 1, at the start, middle and end of each cell.

    d1, d2, d3 : shape (N, 3, dim), derivatives with respect to s, divided by the limit
    """

    d1: Array
    d2: Array
    d3: Array


@dataclass(frozen=True, slots=True, eq=False)
class RetimingProblem:
    """A path on a grid of N >= 4 cells, from rest to rest.

    widths : shape (N,), cell widths
    cap : shape (N + 1,), upper bounds of b at the nodes; cap_middle : shape (N,), in mid-cell
    accelerations, jerks : norms of q'' b + q' a and of its derivative
    """

    widths: Array
    cap: Array
    cap_middle: Array
    accelerations: tuple[NormLimit, ...]
    jerks: tuple[NormLimit, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Iterate:
    """A profile: sdot^2 and sddot at the N + 1 nodes, zero at both ends, b positive inside."""

    b: Array
    a: Array

    def blend(self, other: Iterate, keep: float) -> Iterate:
        """Return the other iterate, blended with a share ``keep`` of this one."""
        return Iterate(
            (1 - keep) * other.b + keep * self.b,
            (1 - keep) * other.a + keep * self.a,
        )


def cell_times(widths: Array, b: Array, a: Array) -> Array:
    """Return the duration of each cell at a constant jerk in s, seconds, shape (N,).

    h = T (v0 + v1) / 2 - T^2 (a1 - a0) / 12, solved for T.
    """
    speed = np.sqrt(b)
    mean = 0.5 * (speed[:-1] + speed[1:])
    root = np.sqrt(np.maximum(mean**2 - np.diff(a) * widths / 3.0, 0.0))
    return np.asarray(2.0 * widths / (mean + root))


def start_from(widths: Array, b: Array) -> Iterate:
    """Return an iterate with the given b, positive inside, and consistent accelerations.

    widths : shape (N,); b : shape (N + 1,)
    """
    slope = np.diff(b) / (2.0 * widths)
    a = np.zeros_like(b)
    a[1:-1] = (slope[:-1] * widths[1:] + slope[1:] * widths[:-1]) / (widths[:-1] + widths[1:])
    return Iterate(b, a)


def retime(problem: RetimingProblem, around: Iterate) -> tuple[Status, Iterate]:
    """Return the best profile near ``around``; meaningless unless the status is SOLVED or INACCURATE."""
    model = _Model(problem.widths, around)
    model.motion()
    model.caps(problem.cap, problem.cap_middle)
    for limit in problem.accelerations:
        model.acceleration(limit)
    for limit in problem.jerks:
        model.jerk(limit)
    model.times()
    near = WarmStart(model.start(), NEAR_LIMIT_SHARE)
    status, x = model.rows.solve(model.total_time(), SOLVER_TOLERANCE, scaled=True, near=near)
    inside = slice(1, -1)
    b, a = np.zeros_like(around.b), np.zeros_like(around.b)
    if status in {Status.SOLVED, Status.INACCURATE}:
        b[inside] = (x[: model.nodes] * model.b_unit)[inside]
        a[inside] = (x[model.nodes : 2 * model.nodes] * model.a_unit)[inside]
        if not (np.isfinite(a).all() and (b[inside] > 0).all()):
            status = Status.FAILED
    return status, Iterate(b, a)


class _SpeedShape:
    """The shape of the speed inside each cell, from the last iterate: quadratic in time.

    Over x = t / T in [0, 1] the speed over its mean is u = r0 (1 - x) + r1 x + k x (1 - x). Every part has
    four weights (of b0, b1, a0, a1) for b, two weights (of a0, a1) for a, and u itself.
    """

    def __init__(self, widths: Array, around: Iterate) -> None:
        speed = np.sqrt(around.b)
        self.time = cell_times(widths, around.b, around.a)
        self.mean = widths / self.time
        self.r0, self.r1 = speed[:-1] / self.mean, speed[1:] / self.mean
        self.k = 6.0 - 3.0 * (self.r0 + self.r1)
        self.middle = self._middle()
        one = np.ones_like(widths)
        self.start_share, self.end_share = self._shares(one)
        low, high = (widths * share for share in self._shares(self.middle))
        zero = np.zeros_like(widths)
        u = self.r0 + (self.r1 - self.r0 + self.k * (1 - self.middle)) * self.middle
        self.parts = (
            (one, zero, zero, zero, one, zero, self.r0),
            (one, zero, 2.0 * low, 2.0 * high, 1.0 - self.middle, self.middle, u),
            (zero, one, zero, zero, zero, one, self.r1),
        )

    def _shares(self, x: Array) -> tuple[Array, Array]:
        """Return the integrals of (1 - x) u and x u from 0 to x: weights of a0 and a1 in that of a ds."""
        slope = self.r1 - self.r0 + self.k
        whole = self.r0 * x + slope * x**2 / 2 - self.k * x**3 / 3
        late = self.r0 * x**2 / 2 + slope * x**3 / 3 - self.k * x**4 / 4
        return whole - late, late

    def _middle(self) -> Array:
        """Return x at half the length of the cell, by Newton's method; the length is monotonic in x."""
        slope = self.r1 - self.r0 + self.k
        x = np.full_like(self.r0, 0.5)
        for _ in range(NEWTON_STEPS):
            covered = self.r0 * x + slope * x**2 / 2 - self.k * x**3 / 3
            speed = self.r0 + slope * x - self.k * x**2
            x = np.clip(x - (covered - 0.5) / np.maximum(speed, 1e-3), 0.0, 1.0)
        return x


class _Model:
    """The cone program: b, a and d = sqrt(b) at N + 1 nodes, and e = 1 / (d0 + d1) on N cells, scaled."""

    def __init__(self, widths: Array, around: Iterate) -> None:
        self.widths = widths
        self.shape = _SpeedShape(widths, around)
        self.nodes = len(around.b)
        self.b_unit = around.b.copy()
        self.b_unit[[0, -1]] = around.b[[1, -2]]
        self.d_unit = np.sqrt(self.b_unit)
        self.a_unit = float(np.abs(around.a).max())
        self.around = around
        self.cell = np.arange(self.nodes - 1)
        self.inside = np.arange(1, self.nodes - 1)
        self.rows = ConeRows(4 * self.nodes - 1)

    def b(self, nodes: NDArray[Any], coefficient: Array) -> Term:
        return nodes, coefficient * self.b_unit[nodes]

    def a(self, nodes: NDArray[Any], coefficient: Array) -> Term:
        return self.nodes + nodes, coefficient * self.a_unit

    def d(self, nodes: NDArray[Any], coefficient: Array) -> Term:
        return 2 * self.nodes + nodes, coefficient * self.d_unit[nodes]

    def e(self, cells: NDArray[Any], coefficient: Array) -> Term:
        return 3 * self.nodes + cells, coefficient

    def motion(self) -> None:
        """Require rest at both ends, and b1 - b0 = 2 h (share0 a0 + share1 a1) on every cell."""
        ends = np.array([0, self.nodes - 1])
        for first in (0, self.nodes, 2 * self.nodes):
            self.rows.zero([(first + ends, np.ones(2))])
        left, right, h = self.cell, self.cell + 1, self.widths
        unit = 1.0 / np.maximum(self.b_unit[:-1], self.b_unit[1:])
        self.rows.zero(
            [
                self.b(right, unit),
                self.b(left, -unit),
                self.a(left, -2.0 * h * self.shape.start_share * unit),
                self.a(right, -2.0 * h * self.shape.end_share * unit),
            ]
        )

    def caps(self, nodes: Array, middles: Array) -> None:
        """Require b below its caps, in shares of them; the cones of d keep it above zero."""
        i = self.inside
        self.rows.positive(np.ones(len(i)), [self.b(i, -1.0 / nodes[i])])
        left, right = self.cell, self.cell + 1
        b0, b1, a0, a1, _, _, _ = self.shape.parts[1]
        terms = [self.b(left, -b0 / middles), self.b(right, -b1 / middles)]
        terms += [self.a(left, -a0 / middles), self.a(right, -a1 / middles)]
        self.rows.positive(np.ones(len(left)), terms)

    def acceleration(self, limit: NormLimit) -> None:
        """Require |q'' b + q' a| <= 1 at nodes and middles."""
        frame = triangular(np.stack([limit.d1, limit.d2], axis=-1))
        i = self.inside
        d1, d2 = frame[1:, 0, :, 0], frame[1:, 0, :, 1]
        nodes = [[self.a(i, d1[:, j]), self.b(i, d2[:, j])] for j in range(frame.shape[2])]
        self.norm(np.ones(len(i)), [], nodes)
        left, right = self.cell, self.cell + 1
        b0, b1, a0, a1, s0, s1, _ = self.shape.parts[1]
        d1, d2 = frame[:, 1, :, 0], frame[:, 1, :, 1]
        middles = [
            [
                self.b(left, d2[:, j] * b0),
                self.b(right, d2[:, j] * b1),
                self.a(left, d2[:, j] * a0 + d1[:, j] * s0),
                self.a(right, d2[:, j] * a1 + d1[:, j] * s1),
            ]
            for j in range(frame.shape[2])
        ]
        self.norm(np.ones(len(left)), [], middles)

    def jerk(self, limit: NormLimit) -> None:
        """Require v_k |q' (a1 - a0) / h + r (3 q'' a + q''' b)| <= 1.5 - 0.5 v^2 / v_k^2 at three points."""
        frame = triangular(np.stack([limit.d1, limit.d2, limit.d3], axis=-1))
        left, right, h = self.cell, self.cell + 1, self.widths
        share = -0.5 / (self.around.b[:-1] + self.around.b[1:])
        bound = [self.b(left, share), self.b(right, share)]
        for part in range(3):
            b0, b1, a0, a1, s0, s1, u = self.shape.parts[part]
            components = []
            for j in range(frame.shape[2]):
                d1, d2, d3 = (self.shape.mean * frame[:, part, j, k] for k in range(3))
                d2, d3 = 3.0 * u * d2, u * d3
                components.append(
                    [
                        self.b(left, d3 * b0),
                        self.b(right, d3 * b1),
                        self.a(left, d3 * a0 + d2 * s0 - d1 / h),
                        self.a(right, d3 * a1 + d2 * s1 + d1 / h),
                    ]
                )
            self.norm(np.full(len(h), 1.5), bound, components)

    def norm(self, constant: Array, bound: list[Term], components: list[list[Term]]) -> None:
        """Require the norm of the components <= constant + bound."""
        if len(components) == 1:
            for sign in (1.0, -1.0):
                self.rows.positive(constant, bound + [(c, sign * v) for c, v in components[0]])
        elif components:
            self.rows.second_order(constant, [bound, *components])

    def times(self) -> None:
        """Require d^2 <= b at inner nodes and e (d0 + d1) >= 1 on cells, as cones, all scaled to 1."""
        i = self.inside
        one, zero = np.ones(len(i)), np.zeros(len(i))
        b = self.b(i, 1.0 / self.b_unit[i])
        self.rows.second_order(one, [[b], [b], [self.d(i, 2.0 / self.d_unit[i])]], rest=[-one, zero])
        speed = np.sqrt(self.around.b)
        share = 1.0 / (speed[:-1] + speed[1:])
        e, one = self.e(self.cell, np.ones(len(self.cell))), np.ones(len(self.cell))
        more, less = (
            [self.d(self.cell, sign * share), self.d(self.cell + 1, sign * share)] for sign in (1.0, -1.0)
        )
        self.rows.second_order(0.0 * one, [[e, *more], [e, *less], []], rest=[0.0 * one, 2.0 * one])

    def start(self) -> Array:
        """Return the unknowns of the last iterate."""
        b, a = self.around.b, self.around.a
        parts = (b / self.b_unit, a / self.a_unit, np.sqrt(b) / self.d_unit, np.ones(len(self.cell)))
        return np.concatenate(parts)

    def total_time(self) -> Array:
        """Return the cost: the total time over that of the last iterate."""
        cost = np.zeros(self.rows.unknowns)
        cost[3 * self.nodes :] = self.shape.time / self.shape.time.sum()
        return cost


def triangular(columns: Array) -> Array:
    """Return the columns in their own orthonormal basis at each point, without negligible rows.

    columns : shape (N, 3, dim, k); result (N, 3, rows, k). A rotation preserves norms, so a straight path
        needs
    one row and a planar path two.
    """
    frame: Array = columns if columns.shape[2] == 1 else np.asarray(np.linalg.qr(columns, mode="r"))
    size = np.abs(frame).max(axis=(0, 1, 3))
    return np.asarray(frame[:, :, size > NEGLIGIBLE_SHARE * max(1.0, size.max())])
