"""The fastest motion along a straight line from rest to rest: up to seven phases of constant jerk.

The least time from rest to a speed v, with acceleration a and jerk j bounded, is v / a + a / j where the
acceleration reaches its bound, and 2 sqrt(v / j) where it does not: the acceleration is a trapezoid or a
triangle (Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, Sec. 3.4).
The mean speed while speeding up, and while slowing down, is half the peak.
"""

from __future__ import annotations

from math import inf, isfinite, sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.planning.timing.limits import LimitedNorm
from shotc.planning.timing.profile import Profile

STEADY_SHARE = 1e-9  # largest change of the rate of a straight path, over its largest rate
NO_TIME_SHARE = 1e-9  # share of the time to the peak, below which a phase is left out


class LineLimits(NamedTuple):
    """Limits of a motion along a line: speed, acceleration and jerk, in its unit of length and seconds."""

    speed: float
    acceleration: float
    jerk: float

    def least_time(self, speed: float) -> float:
        """Return the least time from rest to a constant speed, seconds."""
        if speed >= self.acceleration**2 / self.jerk:
            return speed / self.acceleration + self.acceleration / self.jerk
        return 2.0 * sqrt(speed / self.jerk)

    def peak(self, distance: float) -> float:
        """Return the peak speed over a distance > 0 from rest to rest."""
        ease = self.acceleration / self.jerk
        peak = 0.5 * self.acceleration * (sqrt(ease**2 + 4.0 * distance / self.acceleration) - ease)
        if peak < self.acceleration * ease:
            peak = (0.5 * distance * sqrt(self.jerk)) ** (2 / 3)
        return min(peak, self.speed)

    def rest_to_rest(self, distance: float) -> float:
        """Return the least time over a distance from rest to rest, seconds."""
        if distance <= 0.0:
            return 0.0
        peak = self.peak(distance)
        turn = self.least_time(peak)
        return 2.0 * turn + max(0.0, distance - peak * turn) / peak

    def profile(self, start: float, end: float) -> Profile:
        """Return the fastest motion from one place on the line to a later one."""
        peak = self.peak(end - start)
        turn = self.least_time(peak)
        ease = min(self.acceleration / self.jerk, 0.5 * turn)
        steady, cruise = turn - 2.0 * ease, max(0.0, end - start - peak * turn) / peak
        lengths = (ease, steady, ease, cruise, ease, steady, ease)
        jerks = (self.jerk, 0.0, -self.jerk, 0.0, -self.jerk, 0.0, self.jerk)
        knots = [(0.0, start, 0.0, 0.0)]
        for h, j in zip(lengths, jerks, strict=True):
            if h <= NO_TIME_SHARE * turn:
                continue
            t, s, v, a = knots[-1]
            knots.append(
                (t + h, s + h * (v + h * (a / 2.0 + h * j / 6.0)), v + h * (a + h * j / 2.0), a + h * j)
            )
        knots[-1] = (knots[-1][0], end, 0.0, 0.0)
        return Profile(*np.array(knots).T)


def rate_of_line(path: Piecewise, span: tuple[float, float]) -> Array | None:
    """Return dq/ds, shape (7,), where a path is one line at constant rate over an interval of s; else
    None.
    """
    rates = path.derivative()
    inside = (path.breaks[1:] > span[0]) & (path.breaks[:-1] < span[1])
    ctrl = rates.ctrl[inside].reshape(-1, rates.ctrl.shape[-1])
    size = float(np.abs(ctrl).max(initial=0.0))
    return np.asarray(ctrl[0]) if size > 0.0 and np.abs(ctrl - ctrl[0]).max() <= STEADY_SHARE * size else None


def bounds_along(rate: Array, limits: tuple[LimitedNorm, ...]) -> LineLimits | None:
    """Return the limits of s along a line; None where nothing limits its acceleration or its jerk.

    rate : dq/ds, shape (7,)
    """
    speed = acceleration = jerk = inf
    for axis in limits:
        along = axis.pick @ rate
        used, size = float(axis.rate_used(along)), float(np.linalg.norm(along))
        if axis.rate is not None and used > 0.0:
            speed = min(speed, axis.rate[1] / used)
        if axis.acceleration is not None and size > 0.0:
            acceleration = min(acceleration, axis.acceleration[1] / size)
        if axis.jerk is not None and size > 0.0:
            jerk = min(jerk, axis.jerk[1] / size)
    return LineLimits(speed, acceleration, jerk) if isfinite(acceleration) and isfinite(jerk) else None
