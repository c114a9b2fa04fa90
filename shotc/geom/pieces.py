"""Polynomial pieces as arrays: cut out of a curve, differentiated, halved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, Piecewise, split_half

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Polynomials over intervals that need not be adjacent.

    low, high : ends of the intervals, shape (M,)
    ctrl : Bernstein control points, shape (M, n + 1, D)
    """

    low: Array
    high: Array
    ctrl: Array

    def __len__(self) -> int:
        return len(self.low)

    def pick(self, which: Mask) -> Pieces:
        """Return the pieces where the mask of shape (M,) is true."""
        return Pieces(self.low[which], self.high[which], self.ctrl[which])

    def channels(self, *indices: int) -> Pieces:
        """Return some of the D components."""
        return Pieces(self.low, self.high, self.ctrl[:, :, list(indices)])

    def halves(self) -> Pieces:
        """Return every piece cut in two, the left halves first."""
        left, right = split_half(self.ctrl)
        middle = 0.5 * (self.low + self.high)
        return Pieces(
            np.concatenate([self.low, middle]),
            np.concatenate([middle, self.high]),
            np.concatenate([left, right]),
        )

    def derivative(self) -> Pieces:
        """Return the exact derivative of every piece, one degree lower."""
        degree = self.ctrl.shape[1] - 1
        if degree == 0:
            return Pieces(self.low, self.high, np.zeros_like(self.ctrl))
        widths = (self.high - self.low)[:, None, None]
        return Pieces(self.low, self.high, np.diff(self.ctrl, axis=1) * degree / widths)


def pieces(curve: Piecewise) -> Pieces:
    """Return all pieces of a curve."""
    return Pieces(curve.breaks[:-1], curve.breaks[1:], curve.ctrl)


def cut(curve: Piecewise, start: float, end: float) -> Pieces:
    """Return the pieces of ``curve`` between two parameters; the first and the last one are cut there.

    If the interval is empty or outside the curve, there are no pieces.
    """
    first = int(np.searchsorted(curve.breaks, start, side="right")) - 1
    last = int(np.searchsorted(curve.breaks, end, side="left"))
    first, last = max(first, 0), min(last, len(curve.ctrl))
    low = np.maximum(curve.breaks[first:last], start)
    high = np.minimum(curve.breaks[first + 1 : last + 1], end)
    keep = high > low
    ctrl = curve.ctrl[first:last].copy()
    if len(ctrl):
        ctrl[-1] = _part(ctrl[-1], curve.breaks[last - 1 : last + 1], float(low[-1]), float(high[-1]))
    if len(ctrl) > 1:
        ctrl[0] = _part(ctrl[0], curve.breaks[first : first + 2], float(low[0]), float(high[0]))
    return Pieces(low[keep], high[keep], ctrl[keep])


def join(bags: Sequence[Pieces]) -> Pieces:
    """Return the union of pieces of the same degree and dimension."""
    return Pieces(
        np.concatenate([bag.low for bag in bags]),
        np.concatenate([bag.high for bag in bags]),
        np.concatenate([bag.ctrl for bag in bags]),
    )


def _part(ctrl: Array, ends: Array, low: float, high: float) -> Array:
    # De Casteljau at both cuts: the right part from `low` on, then its left part up to `high`.
    width = float(ends[1] - ends[0])
    begin, stop = (low - float(ends[0])) / width, (high - float(ends[0])) / width
    if begin > 0.0:
        ctrl = _split(ctrl, begin)[1]
    if stop < 1.0:
        ctrl = _split(ctrl, (stop - begin) / (1.0 - begin))[0]
    return ctrl


def _split(ctrl: Array, x: float) -> tuple[Array, Array]:
    left, right = [ctrl[0]], [ctrl[-1]]
    while len(ctrl) > 1:
        ctrl = (1.0 - x) * ctrl[:-1] + x * ctrl[1:]
        left.append(ctrl[0])
        right.append(ctrl[-1])
    return np.stack(left), np.stack(right[::-1])
