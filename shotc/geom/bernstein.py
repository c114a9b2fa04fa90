"""Piecewise polynomials in Bernstein form: evaluation, derivatives, hulls, subdivision.

A polynomial of degree n on one piece lies in the convex hull of its n + 1 control points. So a limit can be
proved for every instant instead of sampled.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Piecewise:
    """A vector-valued piecewise polynomial.

    breaks : shape (P + 1,), increasing
    ctrl   : Bernstein control points, shape (P, n + 1, D)
    """

    breaks: Array
    ctrl: Array

    def __post_init__(self) -> None:
        """Freeze the arrays and check their shapes; raise ValueError if they do not fit."""
        breaks = np.ascontiguousarray(self.breaks, dtype=np.float64)
        ctrl = np.ascontiguousarray(self.ctrl, dtype=np.float64)
        if breaks.ndim != 1 or ctrl.ndim != 3 or len(breaks) != len(ctrl) + 1 or len(ctrl) == 0:
            raise ValueError(f"breaks {breaks.shape} and ctrl {ctrl.shape} do not fit")
        if not (np.isfinite(breaks).all() and np.isfinite(ctrl).all()):
            raise ValueError("breaks and control points must be finite")
        if not (np.diff(breaks) > 0).all():
            raise ValueError("breaks must increase")
        breaks.setflags(write=False)
        ctrl.setflags(write=False)
        object.__setattr__(self, "breaks", breaks)
        object.__setattr__(self, "ctrl", ctrl)

    @property
    def degree(self) -> int:
        """Degree n of every piece."""
        return int(self.ctrl.shape[1]) - 1

    @property
    def start(self) -> float:
        """First break."""
        return float(self.breaks[0])

    @property
    def end(self) -> float:
        """Last break."""
        return float(self.breaks[-1])

    def derivative(self, order: int = 1) -> Piecewise:
        """Return the derivative with respect to the parameter, exact, one degree lower per order."""
        ctrl = self.ctrl
        widths = np.diff(self.breaks)[:, None, None]
        for _ in range(order):
            if ctrl.shape[1] == 1:
                ctrl = np.zeros_like(ctrl)
            else:
                ctrl = np.diff(ctrl, axis=1) * (ctrl.shape[1] - 1) / widths
        return Piecewise(self.breaks, ctrl)

    def channels(self, *indices: int) -> Piecewise:
        """Return the curve of some of the D components."""
        return Piecewise(self.breaks, self.ctrl[:, :, list(indices)])

    def __call__(self, at: Array | float) -> Array:
        """Evaluate at parameters of shape (...,), clamped to the range; result shape (..., D)."""
        t = np.clip(np.asarray(at, dtype=np.float64), self.start, self.end)
        piece = np.clip(np.searchsorted(self.breaks, t, side="right") - 1, 0, len(self.ctrl) - 1)
        lo, hi = self.breaks[piece], self.breaks[piece + 1]
        x = ((t - lo) / (hi - lo))[..., None]
        basis = bernstein_basis(self.degree, x[..., 0])
        return np.asarray(np.einsum("...k,...kd->...d", basis, self.ctrl[piece]))


def bernstein_basis(degree: int, x: Array) -> Array:
    """Return the Bernstein polynomials of ``degree`` at x in [0, 1]; shape (..., degree + 1)."""
    k = np.arange(degree + 1)
    binomials = np.array([comb(degree, i) for i in k], dtype=np.float64)
    x = np.asarray(x, dtype=np.float64)[..., None]
    return np.asarray(binomials * x**k * (1.0 - x) ** (degree - k))


def split_half(ctrl: Array) -> tuple[Array, Array]:
    """Halve pieces by de Casteljau.

    ctrl : shape (..., n + 1, D); returns the control points of the left and the right halves.
    """
    left, right = [ctrl[..., 0, :]], [ctrl[..., -1, :]]
    while ctrl.shape[-2] > 1:
        ctrl = 0.5 * (ctrl[..., :-1, :] + ctrl[..., 1:, :])
        left.append(ctrl[..., 0, :])
        right.append(ctrl[..., -1, :])
    return np.stack(left, axis=-2), np.stack(right[::-1], axis=-2)


def state_at(curve: Piecewise, t: float) -> Array:
    """Return value, rate and acceleration of a curve at a time, shape (3, D)."""
    return np.array([curve.derivative(order)(t) for order in range(3)])


def quintic_hermite(breaks: Array, value: Array, rate: Array, acceleration: Array) -> Piecewise:
    """Return the C2 piecewise quintic through values, first and second derivatives at the breaks.

    breaks : shape (P + 1,); value, rate, acceleration : shape (P + 1, D)
    """
    h = np.diff(breaks)[:, None]
    p0, p1 = value[:-1], value[1:]
    v0, v1 = rate[:-1] * h / 5.0, rate[1:] * h / 5.0
    a0, a1 = acceleration[:-1] * h**2 / 20.0, acceleration[1:] * h**2 / 20.0
    ctrl = np.stack(
        [p0, p0 + v0, p0 + 2 * v0 + a0, p1 - 2 * v1 + a1, p1 - v1, p1],
        axis=1,
    )
    return Piecewise(breaks, ctrl)


def lift_off(curve: Piecewise) -> float:
    """Return the parameter up to which a curve rests at its first point; its start if it moves at once."""
    still = (curve.ctrl == curve.ctrl[0, 0]).all(axis=(1, 2))
    return float(curve.breaks[int(np.argmin(still))] if not still.all() else curve.end)


def concatenate(curves: list[Piecewise]) -> Piecewise:
    """Join curves of the same degree with consecutive ranges."""
    breaks = [curves[0].breaks, *(c.breaks[1:] for c in curves[1:])]
    return Piecewise(np.concatenate(breaks), np.concatenate([c.ctrl for c in curves]))
