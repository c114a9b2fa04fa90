"""Motion along the path over time: s(t) as quintics through s, sdot and sddot at its knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.solvers.retiming_socp import cell_times

Array = NDArray[np.float64]

# Path parameters, metres, that count as one place.
SAME_PLACE_M = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Motion along a path from rest to rest, possibly with holds.

    t, s, sd, sdd : shape (N + 1,); t starts at 0 and increases, s does not decrease (a hold where it is
        constant), sd and sdd are zero at both ends
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
        """Return the motion slowed by ``factor``."""
        return Profile(self.t * factor, self.s, self.sd / factor, self.sdd / factor**2)

    def split(self, which: NDArray[np.bool_]) -> Profile:
        """Return the same motion with knots in the middle of the selected intervals, shape (N,)."""
        middle = 0.5 * (self.t[1:] + self.t[:-1])[which]
        curve = self.curve()
        s = np.clip(curve(middle)[:, 0], self.s[:-1][which], self.s[1:][which])
        sd = np.maximum(curve.derivative(1)(middle)[:, 0], 0.0)
        sdd = curve.derivative(2)(middle)[:, 0]
        order = np.argsort(np.concatenate([self.t, middle]), kind="stable")
        pairs = ((self.t, middle), (self.s, s), (self.sd, sd), (self.sdd, sdd))
        return Profile(*(np.concatenate(pair)[order] for pair in pairs))

    def curve(self) -> Piecewise:
        """Return s(t), one channel."""
        return quintic_hermite(self.t, self.s[:, None], self.sd[:, None], self.sdd[:, None])

    def arrival(self, s: float) -> float:
        """Return when path parameter ``s`` is first reached."""
        k = int(np.searchsorted(self.s, s - SAME_PLACE_M))
        return (
            self._between(k - 1, s) if k == len(self.s) or self.s[k] - s > SAME_PLACE_M else float(self.t[k])
        )

    def departure(self, s: float) -> float:
        """Return when path parameter ``s`` is left; later than its arrival only where there is a hold."""
        k = int(np.searchsorted(self.s, s + SAME_PLACE_M)) - 1
        return self._between(k, s) if k < 0 or s - self.s[k] > SAME_PLACE_M else float(self.t[k])

    def _between(self, knot: int, s: float) -> float:
        """Return t at s after a knot, by bisection, since s(t) increases."""
        if not 0 <= knot < len(self.s) - 1:
            return float(self.t[0 if knot < 0 else -1])
        ends = slice(knot, knot + 2)
        s0, sd, sdd = (part[ends, None] for part in (self.s, self.sd, self.sdd))
        curve = quintic_hermite(self.t[ends], s0, sd, sdd)
        low, high = float(self.t[knot]), float(self.t[knot + 1])
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if curve(middle)[0] < s else (low, middle)
        return 0.5 * (low + high)


def profile_of(s: Array, b: Array, a: Array) -> Profile:
    """Return the profile with b = sdot^2 and a = sddot at s, both zero at the ends.

    The duration of each cell is that of constant jerk; where the numbers fit one, the quintic of s(t) is that
    cubic.

    s, b, a : shape (N + 1,)
    """
    times = cell_times(np.diff(s), b, a)
    return Profile(np.concatenate([[0.0], np.cumsum(times)]), s, np.sqrt(b), a)


def fly(path: Piecewise, profile: Profile) -> Piecewise:
    """Return path(s(t)) as quintics over the profile's knots: values and derivatives by the chain rule."""
    d1, d2 = path.derivative(1)(profile.s), path.derivative(2)(profile.s)
    rate = d1 * profile.sd[:, None]
    acceleration = d2 * profile.sd[:, None] ** 2 + d1 * profile.sdd[:, None]
    return quintic_hermite(profile.t, path(profile.s), rate, acceleration)
