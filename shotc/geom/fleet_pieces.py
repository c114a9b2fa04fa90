"""The pieces of a fleet's splines in Bernstein form, for proofs, and their derivatives' control points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE, knots
from shotc.geom.pieces import Pieces


@dataclass(frozen=True, slots=True, eq=False)
class FleetPieces:
    """Polynomials of n drones over common intervals.

    low, high : ends of the intervals, shape (Q,)
    ctrl : Bernstein control points, shape (n, Q, k, D)
    """

    low: Array
    high: Array
    ctrl: Array

    def bag(self) -> Pieces:
        """Return all pieces of all drones, drone by drone."""
        n = len(self.ctrl)
        flat = self.ctrl.reshape(-1, *self.ctrl.shape[2:])
        return Pieces(np.tile(self.low, n), np.tile(self.high, n), flat)

    def of(self, drone: int) -> Pieces:
        """Return the pieces of one drone."""
        return Pieces(self.low, self.high, self.ctrl[drone])

    def between(self, spans: list[tuple[float, float]]) -> FleetPieces:
        """Return the parts within some time intervals; pieces at their ends are cut."""
        parts = [self._cut(low, high) for low, high in spans if high > low]
        empty = FleetPieces(self.low[:0], self.high[:0], self.ctrl[:, :0])
        parts = [empty, *parts]
        return FleetPieces(
            np.concatenate([p.low for p in parts]),
            np.concatenate([p.high for p in parts]),
            np.concatenate([p.ctrl for p in parts], axis=1),
        )

    def _cut(self, start: float, end: float) -> FleetPieces:
        inside = (self.high > start) & (self.low < end)
        low, high, ctrl = self.low[inside], self.high[inside], self.ctrl[:, inside].copy()
        for k in {0, len(low) - 1} if len(low) else ():
            width = high[k] - low[k]
            first, last = max(start, float(low[k])), min(end, float(high[k]))
            if first > low[k]:
                ctrl[:, k] = _split(ctrl[:, k], (first - low[k]) / width)[1]
            if last < high[k]:
                ctrl[:, k] = _split(ctrl[:, k], (last - first) / (high[k] - first))[0]
            low[k], high[k] = first, last
        return FleetPieces(low, high, ctrl)


def rates(breaks: Array, coef: Array, order: int) -> Array:
    """Return the B-spline control points of a derivative, shape (n, P + 3 - order, 3).

    coef : shape (n, P + 3, 3). Differences of neighbours are exact where these are equal. The second
        derivative
    is linear between its values at the breaks, and these are its control points. The third is constant on
    every piece.
    """
    t = knots(breaks)
    slopes = coef
    for k in range(order):
        degree = DEGREE - k
        inner = t[k : len(t) - k]
        widths = inner[degree + 1 : -1] - inner[1 : -degree - 1]
        slopes = np.diff(slopes, axis=1) * (degree / widths)[:, None]
    return slopes


def velocity(breaks: Array, coef: Array) -> FleetPieces:
    """Return the velocity of a fleet in Bernstein form, three control points a piece.

    Arguments as in ``rates``.
    """
    control, width = rates(breaks, coef, 1), np.diff(knots(breaks)[DEGREE - 1 : 1 - DEGREE])
    # At a break the velocity divides its two control points as the break divides their knots.
    share = (width[:-1] / (width[:-1] + width[1:]))[:, None]
    ends = control[:, :-1] + share * (control[:, 1:] - control[:, :-1])
    ctrl = np.stack([ends[:, :-1], control[:, 1:-1], ends[:, 1:]], axis=2)
    return FleetPieces(breaks[:-1], breaks[1:], ctrl)


def _split(ctrl: Array, x: float) -> tuple[Array, Array]:
    """Split polynomials of shape (n, k, D) at a share of their interval (de Casteljau)."""
    left, right = [ctrl[:, 0]], [ctrl[:, -1]]
    while ctrl.shape[1] > 1:
        ctrl = (1.0 - x) * ctrl[:, :-1] + x * ctrl[:, 1:]
        left.append(ctrl[:, 0])
        right.append(ctrl[:, -1])
    return np.stack(left, axis=1), np.stack(right[::-1], axis=1)
