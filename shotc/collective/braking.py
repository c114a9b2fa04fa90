"""Braking along the way that is flown: a fleet that comes to rest by one scaling of time that all share.

From t0 on everybody is where the plan has it at time s(t), with s' from 1 down to 0: p_i(s(t)). So the whole
fleet takes only positions that it takes in the plan, all of them together: what stands is as far away as in
the plan and any two drones are as far apart, whatever way they are on: straight, on arcs, or pushed apart.
Speeds are those of the plan times s' <= 1. Accelerations, p'' s'^2 + p' s'', and jerks are not, and decide
how soon the fleet can rest. With u the share of the braking time D, s' = 1 - 3 u^2 + 2 u^3: it takes half
its time of the plan.

The result is the cubic B-spline of ``geom.fleet_spline`` over even pieces of h seconds with control points
q - h^2 q'' / 6, which is off q = p(s(t)) by terms of h^4 and meets place, velocity and acceleration at t0.
Its control points are sums, with weights that all drones share, of places in the plan: on straight lines it
is the same move with another share of the way. Nothing is taken for granted of it: it is proved as a plan is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import rates
from shotc.geom.fleet_spline import DEGREE, knots
from shotc.ir.limits import Limits

PIECE_S = 0.25
"""Pieces of a braking fleet, at most, seconds."""
LEAST_PIECES = 4
DELAYS_S = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
"""Seconds that the fleet goes on before it brakes, where that is sooner done than braking at once."""
BRAKING_S = (0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
"""Seconds of braking that are tried."""
BUSIEST_TIMES = 12
"""Instants at which the drones are found that are tried for all."""


@dataclass(frozen=True, slots=True, eq=False)
class Rest:
    """A fleet that comes to rest; breaks : (P + 1,), coef : (n, P + 3, 3), the last three equal."""

    breaks: Array
    coef: Array


class FlightSpline:
    """A planned flight that can be read at any time; breaks, coef : as of ``ir.fleet.FleetTrajectory``."""

    def __init__(self, breaks: Array, coef: Array) -> None:
        self._breaks = breaks
        spline = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), DEGREE)
        self._of_order = [spline, spline.derivative(1), spline.derivative(2)]

    def at(self, times: Array, order: int, rows: Array | slice = slice(None)) -> Array:
        """Return places, or a derivative, of some drones at times of shape (T,), shape (n, T, 3)."""
        at = np.clip(times, self._breaks[0], self._breaks[-1])
        spline = self._of_order[order]
        some = BSpline.construct_fast(spline.t, spline.c[:, rows], spline.k)
        return np.asarray(np.moveaxis(some(at), 0, 1))

    def braked(self, time: float, sooner: float, limits: Limits) -> Rest | None:
        """Return how the fleet comes to rest first, from a time on; None where not before another time.

        sooner : seconds of mission time by which the fleet rests in any case
        """
        busy = self._busiest(time, sooner)
        for delay, braking in _programmes(sooner - time):
            if _within(self._spline(time, (delay, braking), busy), limits):
                rest = self._spline(time, (delay, braking), slice(None))
                if _within(rest, limits):
                    return rest
        return None

    def _spline(self, time: float, programme: tuple[float, float], rows: Array | slice) -> Rest:
        """Return the spline of some drones that go on for so many seconds, and then brake for so many."""
        total = sum(programme)
        count = max(LEAST_PIECES, int(np.ceil(total / PIECE_S)))
        h = total / count
        since: Array = h * np.arange(count + 1, dtype=np.float64)
        s, rate, bend = _scaled(since, *programme)
        at = time + s
        place, velocity, acceleration = (self.at(at, order, rows) for order in range(3))
        q2 = acceleration * rate[:, None] ** 2 + velocity * bend[:, None]
        ctrl = place - h**2 / 6.0 * q2
        # What the first three say at the start: place, velocity and acceleration there, exactly.
        turn, step = 0.5 * h**2 * q2[:, 0], h * velocity[:, 0]
        first = [ctrl[:, 0] + turn - step, ctrl[:, 0], ctrl[:, 0] + turn + step]
        last = [place[:, -1]] * DEGREE
        coef = np.concatenate([np.stack(first, 1), ctrl[:, 2:-2], np.stack(last, 1)], axis=1)
        return Rest(time + since, coef)

    def _busiest(self, time: float, end: float) -> Array:
        """Return the rows of the drones that do most of something in a stretch of time."""
        times = np.linspace(time, min(end, float(self._breaks[-1])), BUSIEST_TIMES)
        velocity, acceleration = self.at(times, 1), self.at(times, 2)
        up = velocity[..., 2]
        sizes = [np.hypot(velocity[..., 0], velocity[..., 1]), up, -up, np.linalg.norm(acceleration, axis=2)]
        return np.unique(np.concatenate([size.argmax(axis=0) for size in sizes]))


def _programmes(less: float) -> Iterator[tuple[float, float]]:
    """Yield delays and braking times that together take less than some seconds, the shortest first."""
    found = [both for both in product(DELAYS_S, BRAKING_S) if sum(both) < less]
    yield from sorted(found, key=lambda both: (sum(both), both[0]))


def _scaled(since: Array, delay: float, braking: float) -> tuple[Array, Array, Array]:
    """Return s, s' and s'' (see the module) at seconds since t0, each of their shape; s counts from t0."""
    u = np.clip((since - delay) / braking, 0.0, 1.0)
    s = np.minimum(since, delay) + braking * (u - u**3 + 0.5 * u**4)
    return s, 1.0 - 3.0 * u**2 + 2.0 * u**3, 6.0 * (u**2 - u) / braking


def _within(rest: Rest, limits: Limits) -> bool:
    """Tell whether control points of derivatives keep every limit; what lies in their hull does, too."""
    velocity = rates(rest.breaks, rest.coef, 1)
    if float(np.hypot(velocity[..., 0], velocity[..., 1]).max()) > limits.speed:
        return False
    if float(velocity[..., 2].max()) > limits.climb or float(-velocity[..., 2].min()) > limits.descent:
        return False
    most = ((2, limits.usable_acceleration), (3, limits.jerk))
    return all(float(np.linalg.norm(rates(rest.breaks, rest.coef, k), axis=2).max()) <= m for k, m in most)
