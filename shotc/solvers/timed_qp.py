"""A time law s(t) with deadlines: a quadratic programme with the path's limits as cones.

s is a cubic on every cell (constant jerk, C2), so a deadline s(t_k) = s_k is linear. s rests at both ends, is
monotonic, and has the least integral of squared jerk. The path is taken at the last iterate's s(t), and
powers of sdot are replaced by their tangents there. Then the limits of the path are linear in sdot, sddot and
the jerk of s. If they cannot be kept, one overdraft of all limits is minimised at a price, and returned.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.cone_rows import ConeRows, Term
from shotc.solvers.conic import Status

Array = NDArray[np.float64]

# Price of an overdraft by 100 % of every limit; the integral of squared jerk is about 1.
OVERDRAFT_PRICE = 1e4


class PathRates(NamedTuple):
    """Derivatives of some channels by s over their limit, orders 1 to 3, shape (N + 1, dim) each."""

    d1: Array
    d2: Array
    d3: Array


@dataclass(frozen=True, slots=True, eq=False)
class PathLimits:
    """The limits at the N + 1 knots, with the path at the last iterate.

    speed : shape (N + 1,), largest sdot
    accelerations, jerks : one for each limit of the kind
    """

    speed: Array
    accelerations: tuple[PathRates, ...]
    jerks: tuple[PathRates, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """s, sdot and sddot at the knots t, each (N + 1,), and the jerk of s on the N cells.

    overdraft : share by which the law exceeds its limits, 0 if it keeps all
    """

    status: Status
    t: Array
    s: Array
    v: Array
    a: Array
    j: Array
    overdraft: float = 0.0


def time_law(
    t: Array, places: tuple[tuple[int, float], ...], limits: PathLimits | None, last: TimeLaw | None
) -> TimeLaw:
    """Return the smoothest law through the places.

    t : shape (N + 1,), knots, seconds; places : (knot, s), with the first and the last knot
    limits, last : the limits and the iterate at which they are taken; None for a law without limits
    """
    model = _Model(t, places)
    if limits is not None and last is not None:
        model.limits(limits, last)
    squares, cost = np.zeros(model.rows.unknowns), np.zeros(model.rows.unknowns)
    squares[3 * model.nodes : -1] = model.h / 720.0  # 720: that of the smoothest rest-to-rest law
    cost[-1] = OVERDRAFT_PRICE
    status, x = model.rows.solve(cost, 1e-8, squares)
    s, v, a = (x[k * model.nodes : (k + 1) * model.nodes] for k in range(3))
    size, time = model.size, model.time
    return TimeLaw(
        status,
        t,
        model.start + size * s,
        size / time * v,
        size / time**2 * a,
        size / time**3 * x[3 * model.nodes : -1],
        float(x[-1]),
    )


class _Model:
    """Unknowns s, v, a at knots, j on cells, and the overdraft, in units of the total length and time."""

    def __init__(self, t: Array, places: tuple[tuple[int, float], ...]) -> None:
        self.nodes = len(t)
        self.start = places[0][1]
        self.size = places[-1][1] - self.start
        self.time = float(t[-1] - t[0])
        self.h = np.diff(t) / self.time
        self.rows = ConeRows(4 * self.nodes)
        self._motion()
        ends = np.array([0, self.nodes - 1])
        for k in (1, 2):
            self.rows.zero([(k * self.nodes + ends, np.ones(2))])
        knots = np.array([knot for knot, _ in places])
        targets = (np.array([s for _, s in places]) - self.start) / self.size
        self.rows.zero([(knots, np.ones(len(knots)))], -targets)
        self.rows.positive(np.zeros(1), [self.overdraft(np.ones(1))])

    def overdraft(self, coefficient: Array) -> Term:
        return np.full(len(coefficient), 4 * self.nodes - 1), coefficient

    def _motion(self) -> None:
        """Require constant jerk on every cell, and sdot >= 0 by its Bernstein coefficients."""
        i, h, n = np.arange(self.nodes - 1), self.h, self.nodes
        one = np.ones_like(h)
        s, v, a, j = i, n + i, 2 * n + i, 3 * n + i
        self.rows.zero([(a + 1, one), (a, -one), (j, -h)])
        self.rows.zero([(v + 1, one), (v, -one), (a, -h), (j, -(h**2) / 2)])
        self.rows.zero([(s + 1, one), (s, -one), (v, -h), (a, -(h**2) / 2), (j, -(h**3) / 6)])
        self.rows.positive(np.zeros(n - 2), [(v[1:], one[1:])])
        self.rows.positive(0.0 * h, [(v, one), (a, h / 2)])

    def limits(self, limits: PathLimits, last: TimeLaw) -> None:
        """Require the limits with a common overdraft, by tangents at the last iterate, in its units."""
        n = self.nodes
        speed, acceleration = self.size / self.time, self.size / self.time**2
        knots = np.arange(n)
        bound = limits.speed / speed
        self.rows.positive(np.ones(n), [(n + knots, -1.0 / bound), self.overdraft(np.ones(n))])
        v = last.v
        for d1, d2, _ in limits.accelerations:
            # q' a + q'' v^2 with the tangent of v^2.
            parts = [
                ([(2 * n + knots, p1 * acceleration), (n + knots, 2 * p2 * v * speed)], -p2 * v**2)
                for p1, p2 in zip(d1.T, d2.T, strict=True)
            ]
            self.norm(parts)
        for d1, d2, d3 in limits.jerks:
            for side in (slice(None, -1), slice(1, None)):
                self._jerk(side, d1[side], d2[side], d3[side], last)

    def _jerk(self, side: slice, d1: Array, d2: Array, d3: Array, last: TimeLaw) -> None:
        """Limit q' j + 3 q'' v a + q''' v^3 at one end of each cell, with tangents of the products."""
        n = self.nodes
        knots, cells = np.arange(n)[side], np.arange(n - 1)
        speed, acceleration, jerk = (self.size / self.time**k for k in (1, 2, 3))
        v, a = last.v[side], last.a[side]
        parts = [
            (
                [
                    (3 * n + cells, p1 * jerk),
                    (2 * n + knots, 3 * p2 * v * acceleration),
                    (n + knots, (3 * p2 * a + 3 * p3 * v**2) * speed),
                ],
                -3 * p2 * v * a - 2 * p3 * v**3,
            )
            for p1, p2, p3 in zip(d1.T, d2.T, d3.T, strict=True)
        ]
        self.norm(parts)

    def norm(self, parts: list[tuple[list[Term], Array]]) -> None:
        """Require the norm of the parts (terms, constant) <= 1 + overdraft."""
        one = np.ones(len(parts[0][1]))
        constants = [constant for _, constant in parts]
        entries = [[self.overdraft(one)], *(terms for terms, _ in parts)]
        self.rows.second_order(one, entries, rest=constants)
