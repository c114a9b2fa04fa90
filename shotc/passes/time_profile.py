"""Motion along the path over time: s(t) as quintics through s, sdot and sddot at its knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.solvers.retiming_socp import cell_times

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Motion from rest to rest.

    t, s, sd, sdd : shape (N + 1,); t starts at 0, sd and sdd are zero at both ends
    """

    t: Array
    s: Array
    sd: Array
    sdd: Array

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return float(self.t[-1])

    def stretched(self, factor: float) -> Profile:
        """Return the same motion, slower by ``factor``."""
        return Profile(self.t * factor, self.s, self.sd / factor, self.sdd / factor**2)

    def curve(self) -> Piecewise:
        """Return s(t), one channel."""
        return quintic_hermite(self.t, self.s[:, None], self.sd[:, None], self.sdd[:, None])

    def time_at(self, s: Array) -> Array:
        """Return t where the path parameter is ``s``; s(t) increases, so bisection finds it."""
        s = np.clip(s, self.s[0], self.s[-1])
        cell = np.clip(np.searchsorted(self.s, s, side="right") - 1, 0, len(self.s) - 2)
        curve = self.curve()
        low, high = self.t[cell], self.t[cell + 1]
        for _ in range(50):
            middle = 0.5 * (low + high)
            below = curve(middle)[..., 0] < s
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        # Exact at the knots, where marks and the ends of spans lie.
        at_knot = np.minimum(np.abs(s - self.s[cell]), np.abs(s - self.s[cell + 1])) == 0
        knot = np.where(s == self.s[cell], self.t[cell], self.t[cell + 1])
        return np.asarray(np.where(at_knot, knot, 0.5 * (low + high)))


def profile_of(s: Array, b: Array, a: Array) -> Profile:
    """Return the profile with b = sdot^2 and a = sddot at s, both zero at the ends.

    Each cell takes as long as it does at a constant jerk; where the numbers fit one, the quintic of
    s(t) is that cubic.
    """
    times = cell_times(np.diff(s), b, a)
    return Profile(np.concatenate([[0.0], np.cumsum(times)]), s, np.sqrt(b), a)


def fly(path: Piecewise, profile: Profile) -> Piecewise:
    """Return path(s(t)) as quintics over the profile's knots: values and derivatives by the chain rule."""
    d1, d2 = path.derivative(1)(profile.s), path.derivative(2)(profile.s)
    rate = d1 * profile.sd[:, None]
    acceleration = d2 * profile.sd[:, None] ** 2 + d1 * profile.sdd[:, None]
    return quintic_hermite(profile.t, path(profile.s), rate, acceleration)
