"""Brakes a fleet on its planned paths with one scaling of time for all drones.

From t0 on each drone has its planned position at time s(t), where s' decreases from 1 to 0: p_i(s(t)). The
whole fleet therefore takes only formations of the plan. Clearances and separations are those of the plan,
whatever the paths are: straight lines, arcs, or paths pushed apart.

Speeds are those of the plan times s' <= 1. Accelerations, p'' s'^2 + p' s'', and jerks may be larger than in
the plan, and they determine how soon the fleet can rest. With u the share of the braking time D, s' = 1 - 3
u^2 + 2 u^3; braking uses D / 2 of the plan's time.

The result is the cubic B-spline of ``geom.fleet_spline`` over uniform pieces of h seconds with control points
q - h^2 q'' / 6. It differs from q = p(s(t)) by terms of order h^4, and has the same position, velocity and
acceleration at t0. Its control points are weighted sums of planned positions, with the same weights for all
drones. On straight lines it is therefore the same move with another share of the path. None of this is
assumed: the result is verified as a plan is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import rates
from shotc.geom.fleet_spline import DEGREE, knots
from shotc.ir.limits import Limits

PIECE_S = 0.25
"""Longest piece of a braking fleet, seconds."""
LEAST_PIECES = 4
DELAYS_S = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
"""Seconds of flight before braking; a delay helps if the fleet can then brake faster."""
BRAKING_S = (0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
"""Seconds of braking that are tried."""
BUSIEST_TIMES = 12
"""Sampled instants at which the most demanding drones are found."""


@dataclass(frozen=True, slots=True, eq=False)
class Rest:
    """The motion of a fleet until it rests.

    breaks : (P + 1,), seconds
    coef : (n, P + 3, 3), the last three control points equal
    """

    breaks: Array
    coef: Array


class FlightSpline:
    """A planned flight that can be evaluated at any time.

    breaks, coef : as in ``ir.fleet.FleetTrajectory``
    """

    def __init__(self, breaks: Array, coef: Array) -> None:
        self._breaks = breaks
        spline = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), DEGREE)
        self._of_order = [spline, spline.derivative(1), spline.derivative(2)]

    def at(self, times: Array, order: int, rows: Array | slice = slice(None)) -> Array:
        """Return positions or a derivative of some drones at times (T,), shape (n, T, 3)."""
        at = np.clip(times, self._breaks[0], self._breaks[-1])
        spline = self._of_order[order]
        some = BSpline.construct_fast(spline.t, spline.c[:, rows], spline.k)
        return np.asarray(np.moveaxis(some(at), 0, 1))

    def braked(self, time: float, sooner: float, limits: Limits) -> Rest | None:
        """Return the earliest rest of the fleet after a time; None if it is not before another time.

        time : from when on the fleet may brake, seconds
        sooner : mission time at which the fleet rests anyway, seconds
        """
        busy = self._busiest(time, sooner)
        for delay, braking in _programmes(sooner - time):
            if _within(self._spline(time, (delay, braking), busy), limits):
                rest = self._spline(time, (delay, braking), slice(None))
                if _within(rest, limits):
                    return rest
        return None

    def _spline(self, time: float, programme: tuple[float, float], rows: Array | slice) -> Rest:
        """Return the spline of some drones with a programme of delay and braking time, seconds."""
        total = sum(programme)
        count = max(LEAST_PIECES, int(np.ceil(total / PIECE_S)))
        h = total / count
        elapsed: Array = h * np.arange(count + 1, dtype=np.float64)
        scaled = _scaled(elapsed, *programme)
        at = time + scaled.s
        place, velocity, acceleration = (self.at(at, order, rows) for order in range(3))
        q2 = acceleration * scaled.rate[:, None] ** 2 + velocity * scaled.bend[:, None]
        ctrl = place - h**2 / 6.0 * q2
        # The first three control points give the exact position, velocity and acceleration at the start.
        turn, step = 0.5 * h**2 * q2[:, 0], h * velocity[:, 0]
        first = [ctrl[:, 0] + turn - step, ctrl[:, 0], ctrl[:, 0] + turn + step]
        last = [place[:, -1]] * DEGREE
        coef = np.concatenate([np.stack(first, 1), ctrl[:, 2:-2], np.stack(last, 1)], axis=1)
        return Rest(time + elapsed, coef)

    def _busiest(self, time: float, end: float) -> Array:
        """Return the rows of the drones with the largest speeds and accelerations in a time interval."""
        times = np.linspace(time, min(end, float(self._breaks[-1])), BUSIEST_TIMES)
        velocity, acceleration = self.at(times, 1), self.at(times, 2)
        up = velocity[..., 2]
        sizes = [np.hypot(velocity[..., 0], velocity[..., 1]), up, -up, np.linalg.norm(acceleration, axis=2)]
        return np.unique(np.concatenate([size.argmax(axis=0) for size in sizes]))


def _programmes(less: float) -> Iterator[tuple[float, float]]:
    """Yield delays and braking times with a sum below ``less`` seconds, the shortest sum first."""
    programmes = [both for both in product(DELAYS_S, BRAKING_S) if sum(both) < less]
    yield from sorted(programmes, key=lambda both: (sum(both), both[0]))


class _ScaledTime(NamedTuple):
    """The time s of the plan (see the module), seconds since t0, with its two derivatives, (T,) each."""

    s: Array
    rate: Array
    bend: Array


def _scaled(elapsed: Array, delay: float, braking: float) -> _ScaledTime:
    """Return the time of the plan at seconds since t0, (T,)."""
    u = np.clip((elapsed - delay) / braking, 0.0, 1.0)
    s = np.minimum(elapsed, delay) + braking * (u - u**3 + 0.5 * u**4)
    return _ScaledTime(s, 1.0 - 3.0 * u**2 + 2.0 * u**3, 6.0 * (u**2 - u) / braking)


def _within(rest: Rest, limits: Limits) -> bool:
    """Return whether the control points of derivatives keep every limit; the curves then keep them too."""
    velocity = rates(rest.breaks, rest.coef, 1)
    if float(np.hypot(velocity[..., 0], velocity[..., 1]).max()) > limits.speed:
        return False
    if float(velocity[..., 2].max()) > limits.climb or float(-velocity[..., 2].min()) > limits.descent:
        return False
    most = ((2, limits.usable_acceleration), (3, limits.jerk))
    return all(float(np.linalg.norm(rates(rest.breaks, rest.coef, k), axis=2).max()) <= m for k, m in most)
