"""The energy of C1 piecewise cubics, and the cubic of least energy.

The yaw paper's benchmark uses third-order pieces joined up to the first derivative (kappa = 2, Eq. 11d),
which the values and slopes at the keyframes determine. For a piece of length h the integrals of the squared
second and first derivative are quadratic forms of (p0, v0, p1, v1), known from beams as bending and geometric
stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import IntArray


class Reduced(NamedTuple):
    """The least energy through values p: p' M p + 2 b' p + c."""

    matrix: Array
    linear: Array
    constant: float


@dataclass(frozen=True, slots=True, eq=False)
class Energy:
    """The integral of psi''^2 + weight psi'^2 as z' hessian z with z = (values, slopes), shape (2K, 2K).

    pinned : slopes at the first and the last keyframe; the others are free
    """

    at: Array
    hessian: Array
    pinned: tuple[float, float]

    @property
    def free(self) -> IntArray:
        """Indices in z of the free slopes, shape (K - 2,)."""
        count = len(self.at)
        return np.arange(count + 1, 2 * count - 1)

    def slopes(self, value: Array) -> Array:
        """Return the slopes of least energy through the values, shape (K,)."""
        z = self._state(value)
        free = self.free
        if len(free):
            gradient = self.hessian[free] @ z
            z[free] -= np.linalg.solve(self.hessian[np.ix_(free, free)], gradient)
        return z[len(self.at) :]

    def of(self, value: Array, slope: Array) -> float:
        """Return the energy of the cubic with these values and slopes, shape (K,) each."""
        z = np.concatenate([value, slope])
        return float(z @ self.hessian @ z)

    def reduced(self) -> Reduced:
        """Return (M, b, c): the least energy through values p is p' M p + 2 b' p + c.

        M is the Schur complement onto the values, shape (K, K).
        """
        count = len(self.at)
        values, free, ends = np.arange(count), self.free, np.array([count, 2 * count - 1])
        rest = np.concatenate([values, ends])
        schur = self.hessian[np.ix_(rest, rest)]
        if len(free):
            across = self.hessian[np.ix_(free, rest)]
            schur = schur - across.T @ np.linalg.solve(self.hessian[np.ix_(free, free)], across)
        pinned = np.array(self.pinned)
        mixed = schur[:count, count:] @ pinned
        return Reduced(schur[:count, :count], mixed, float(pinned @ schur[count:, count:] @ pinned))

    def _state(self, value: Array) -> Array:
        z = np.zeros(2 * len(self.at))
        z[: len(self.at)] = value
        z[len(self.at)], z[-1] = self.pinned
        return z


def energy(at: Array, weight: float, pinned: tuple[float, float]) -> Energy:
    """Return the energy of cubics on breaks ``at``, shape (K,), K >= 2; arguments as in ``Energy``."""
    count = len(at)
    total = np.zeros((2 * count, 2 * count))
    for i, h in enumerate(np.diff(at)):
        index = np.array([i, count + i, i + 1, count + i + 1])
        total[np.ix_(index, index)] += _bending(float(h)) + weight * _geometric(float(h))
    return Energy(at, total, pinned)


def cubic(at: Array, value: Array, slope: Array) -> Piecewise:
    """Return the C1 cubic with values and slopes at its breaks, all of shape (N + 1,), one channel."""
    third = np.diff(at) / 3.0
    left, right = value[:-1], value[1:]
    ctrl = np.stack([left, left + third * slope[:-1], right - third * slope[1:], right], axis=1)
    return Piecewise(at, ctrl[:, :, None])


def _bending(h: float) -> Array:
    rows = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    rows += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    return np.array(rows) / h**3


def _geometric(h: float) -> Array:
    rows = [[36, 3 * h, -36, 3 * h], [3 * h, 4 * h * h, -3 * h, -h * h]]
    rows += [[-36, -3 * h, 36, -3 * h], [3 * h, -h * h, -3 * h, 4 * h * h]]
    return np.array(rows) / (30 * h)
