"""Quintic B-splines on clamped knots, written as linear maps onto Bernstein control points.

A spline with P pieces has P + 5 coefficients and is C4 at its interior breaks. All its functionals in a
convex programme (values, derivatives, hulls, energies) are sums over six neighbouring coefficients. So
constraints are rows of six weights: ``SplineFunctionals``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, Piecewise, bernstein_basis

DEGREE = 5
IntArray = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class SplineFunctionals:
    """Linear functionals of a spline's coefficients.

    piece  : shape (R,), index of the first of the six coefficients of each row
    weight : shape (R, 6)
    """

    piece: IntArray
    weight: Array

    def apply(self, coef: Array) -> Array:
        """Return the rows' values for coefficients of shape (P + 5, D); shape (R, D)."""
        local = coef[self.piece[:, None] + np.arange(DEGREE + 1)]
        return np.asarray(np.einsum("rk,rkd->rd", self.weight, local))


def count(breaks: Array) -> int:
    """Return the number of coefficients of a spline on breaks of shape (P + 1,)."""
    return len(breaks) - 1 + DEGREE


def extraction(breaks: Array) -> Array:
    """Return the maps from six coefficients to six Bernstein points; shape (P, 6, 6).

    Row k of piece p is the blossom of the piece at (a, ..., a, b, ..., b) with k times b (Ramshaw's
    polar form), computed by de Boor's recursion. The result is read-only and cached, because all rows of a
    programme use it.
    """
    return _extraction(np.asarray(breaks, dtype=np.float64).tobytes())


@lru_cache(maxsize=4)
def _extraction(of: bytes) -> Array:
    breaks = np.frombuffer(of)
    pieces = len(breaks) - 1
    knots = np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])
    first = np.arange(pieces)[:, None] + np.arange(1, 2 * DEGREE + 1)
    local = knots[first]  # the ten knots of each piece
    rows = []
    for k in range(DEGREE + 1):
        points = np.broadcast_to(np.eye(DEGREE + 1), (pieces, DEGREE + 1, DEGREE + 1))
        for level in range(DEGREE):
            at = (breaks[:-1] if level < DEGREE - k else breaks[1:])[:, None]
            lo, hi = local[:, level:DEGREE], local[:, DEGREE : 2 * DEGREE - level]
            x = ((at - lo) / (hi - lo))[..., None]
            points = (1.0 - x) * points[:, :-1] + x * points[:, 1:]
        rows.append(points[:, 0])
    maps = np.stack(rows, axis=1)
    maps.flags.writeable = False
    return maps


def greville(breaks: Array) -> Array:
    """Return the Greville abscissae, (P + 5,): a spline with coefficients f(greville) is f, for linear f."""
    knots = np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])
    windows = np.lib.stride_tricks.sliding_window_view(knots[1:-1], DEGREE)
    return np.asarray(windows.mean(axis=1))


def spline(breaks: Array, coef: Array) -> Piecewise:
    """Return the spline with coefficients of shape (P + 5, D), in Bernstein form."""
    index = np.arange(len(breaks) - 1)[:, None] + np.arange(DEGREE + 1)
    return Piecewise(breaks, np.einsum("pij,pjd->pid", extraction(breaks), coef[index]))


def value_rows(breaks: Array, at: Array, order: int = 0) -> SplineFunctionals:
    """Return rows that evaluate the spline, or its derivative of that order, at parameters of shape (R,)."""
    piece = np.clip(np.searchsorted(breaks, at, side="right") - 1, 0, len(breaks) - 2)
    x = (at - breaks[piece]) / (breaks[piece + 1] - breaks[piece])
    basis = bernstein_basis(DEGREE - order, x)
    return SplineFunctionals(piece, np.einsum("rk,rkj->rj", basis, _points(breaks, order)[piece]))


def control_rows(breaks: Array, order: int = 0) -> SplineFunctionals:
    """Return rows for the Bernstein points of the derivative of that order, piece by piece.

    breaks : shape (P + 1,); there are 6 - order rows a piece
    """
    maps = _points(breaks, order)
    pieces, points, _ = maps.shape
    return SplineFunctionals(np.repeat(np.arange(pieces), points), maps.reshape(pieces * points, DEGREE + 1))


def _points(breaks: Array, order: int) -> Array:
    """Return the maps from coefficients to a derivative's Bernstein points, (P, 6 - order, 6)."""
    maps = extraction(breaks)
    widths = np.diff(breaks)[:, None, None]
    for _ in range(order):
        maps = np.diff(maps, axis=1) * (maps.shape[1] - 1) / widths
    return maps


def hull_rows(breaks: Array, order: int) -> SplineFunctionals:
    """Return the rows of ``control_rows`` without those that a piece shares with the one before it.

    breaks : shape (P + 1,)
    order : at most 4, because the derivatives of adjacent pieces are equal at a break up to this order
    """
    rows = control_rows(breaks, order)
    points = DEGREE + 1 - order
    own = np.arange(len(rows.piece)) % points > 0
    own[0] = True
    return SplineFunctionals(rows.piece[own], rows.weight[own])


def energy_rows(breaks: Array, order: int) -> SplineFunctionals:
    """Return rows whose sum of squares is the integral of the squared derivative of that order.

    breaks : shape (P + 1,)
    The Gram matrix of Bernstein polynomials of degree m is C(m,i) C(m,j) / (C(2m,i+j) (2m+1)) on
    [0, 1]; its Cholesky factor turns the integral into a sum of squares, exactly.
    """
    m = DEGREE - order
    gram = np.array(
        [
            [comb(m, i) * comb(m, j) / comb(2 * m, i + j) / (2 * m + 1) for j in range(m + 1)]
            for i in range(m + 1)
        ]
    )
    root = np.linalg.cholesky(gram).T
    rows = control_rows(breaks, order)
    points = rows.weight.reshape(len(breaks) - 1, m + 1, DEGREE + 1)
    scaled = np.einsum("ij,pjk->pik", root, points) * np.sqrt(np.diff(breaks))[:, None, None]
    return SplineFunctionals(rows.piece, scaled.reshape(-1, DEGREE + 1))


def restrict(curve: Piecewise, breaks: Array) -> Piecewise:
    """Return the same curve on finer breaks, shape (P + 1,), exactly.

    Every break of the curve inside the range of ``breaks`` must be among them (to 1e-9 of the
    range); ``breaks`` may cover a part of the curve only.
    """
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    piece = np.clip(np.searchsorted(curve.breaks, middle, side="right") - 1, 0, len(curve.ctrl) - 1)
    lo, width = curve.breaks[piece], np.diff(curve.breaks)[piece]
    a = ((breaks[:-1] - lo) / width)[:, None, None]
    b = ((breaks[1:] - lo) / width)[:, None, None]
    degree = curve.degree
    out = []
    for k in range(degree + 1):
        points = curve.ctrl[piece]
        for level in range(degree):
            x = a if level < degree - k else b
            points = (1.0 - x) * points[:, :-1] + x * points[:, 1:]
        out.append(points[:, 0])
    return Piecewise(breaks, np.stack(out, axis=1))


def held_until(curve: Piecewise, end: float) -> Piecewise:
    """Return a curve extended by rest from its end to a later time."""
    if curve.end >= end:
        return curve
    still = np.repeat(curve.ctrl[-1:, -1:], curve.degree + 1, axis=1)
    return Piecewise(np.append(curve.breaks, end), np.concatenate([curve.ctrl, still]))


def subdivide(breaks: Array, parts: int) -> Array:
    """Return breaks with every piece cut into ``parts`` equal ones; the old breaks are kept exactly.

    breaks : shape (P + 1,); result (P parts + 1,)
    """
    fractions = np.arange(parts) / parts
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * fractions
    return np.append(inner.ravel(), breaks[-1])
