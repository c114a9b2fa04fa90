"""Time-optimal path parameterization: the problem and the result of a solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.conic import Status

Array = NDArray[np.float64]

SLOWEST_M_S = 1e-12  # sum of two path velocities below which a profile stands still


@dataclass(frozen=True, slots=True, eq=False)
class LinearLimits:
    """Limits of a path on a grid, as functions of a = sddot and b = sdot^2.

    grid : shape (N + 1,), increasing path parameters
    on_a, on_b : shape (N + 1, m); every row requires on_a a + on_b b <= 1
    cap : shape (N + 1,), 0 <= b <= cap
    """

    grid: Array
    on_a: Array
    on_b: Array
    cap: Array

    @property
    def widths(self) -> Array:
        """Return the cell widths, shape (N,)."""
        return np.diff(self.grid)

    @property
    def ceiling(self) -> Array:
        """Return the largest admissible b at constant speed, shape (N + 1,)."""
        return np.asarray(np.minimum(self.cap, 1.0 / np.maximum(self.on_b.max(axis=1), 1e-12)))


@dataclass(frozen=True, slots=True, eq=False)
class FastestProfile:
    """The result of a solver.

    b : shape (N + 1,), squared path velocity, zero at both ends; meaningless unless SOLVED
    time : seconds from rest to rest; infinite unless SOLVED
    """

    status: Status
    b: Array
    time: float


def profile_of(limits: LinearLimits, b: Array) -> FastestProfile:
    """Return the profile of squared velocities b, shape (N + 1,), with constant acceleration on each cell."""
    sd = np.sqrt(b)
    time = float(np.sum(2.0 * limits.widths / np.maximum(sd[:-1] + sd[1:], SLOWEST_M_S)))
    return FastestProfile(Status.SOLVED, b, time)


def no_profile(limits: LinearLimits) -> FastestProfile:
    """Return the result of a solver that found no profile."""
    return FastestProfile(Status.FAILED, np.zeros_like(limits.grid), float("inf"))
