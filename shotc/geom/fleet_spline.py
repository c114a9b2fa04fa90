"""The motion of a whole fleet: cubic B-splines over one set of breaks, one row of control points a drone.

The curve is that of *display* Eq. 4, with breaks that need not be uniform. Beyond the first and the last
break the knots continue in steps of the first and the last piece. So three equal control points at an end are
a start or an end at rest.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shotc.geom.bernstein import Array

DEGREE = 3

NEAR_S = 0.02
"""Seconds to the next break below which the rest of a spline starts at that break."""


def knots(breaks: Array) -> Array:
    """Return the knots of the splines over breaks of shape (P + 1,); shape (P + 7,), for P + 3 points."""
    first, last = breaks[1] - breaks[0], breaks[-1] - breaks[-2]
    steps = np.arange(1.0, DEGREE + 1.0)
    return np.concatenate([breaks[0] - first * steps[::-1], breaks, breaks[-1] + last * steps])


def centres(breaks: Array) -> Array:
    """Return the Greville abscissa of each control point, shape (P + 3,), seconds."""
    t = knots(breaks)
    return np.asarray((t[1:-3] + t[2:-2] + t[3:-1]) / 3.0)


def rest_of(breaks: Array, coef: Array, time: float) -> tuple[Array, Array]:
    """Return the breaks and the control points of the same splines from a time on, exactly.

    breaks : shape (P + 1,); coef : shape (n, P + 3, 3). After their end the result is one second of rest. If
        a
    break is less than ``NEAR_S`` later, the result starts there. Only the first control points are new: the
    blossom of the first piece at the new knots.
    """
    if time >= breaks[-1]:
        return np.array([time, time + 1.0]), np.repeat(places(breaks, coef, breaks[-1:]), DEGREE + 1, axis=1)
    k = int(np.clip(np.searchsorted(breaks, time + NEAR_S, side="right") - 1, 0, len(breaks) - 2))
    left = np.concatenate([[max(time, float(breaks[k]))], breaks[k + 1 :]])
    old, new = knots(breaks)[k:], knots(left)
    # If one piece is left, the knots of the fourth point change too.
    first = [_blossom(old, coef[:, k : k + 4], new[j + 1 : j + 4]) for j in range(4)]
    return left, np.concatenate([np.stack(first, axis=1), coef[:, k + 4 :]], axis=1)


def _blossom(t: Array, points: Array, at: Array) -> Array:
    """Return the blossom of a piece, shape (n, 3); t : its knots from the first, points : shape (n, 4, 3)."""
    for degree, u in zip((1, 2, 3), at, strict=True):
        low, high = t[degree:4], t[4 : 8 - degree]
        share = ((u - low) / (high - low))[None, :, None]
        points = (1.0 - share) * points[:, :-1] + share * points[:, 1:]
    return np.asarray(points[:, 0])


def differences(breaks: Array, order: int) -> Array:
    """Return the matrix from control points to those of a derivative, shape (P + 3 - order, P + 3).

    The derivative lies in the hull of its control points: a bound on them holds for all t.
    """
    t = knots(breaks)
    matrix = np.eye(len(breaks) + 2)
    for k in range(order):
        degree = DEGREE - k
        inner = t[k : len(t) - k]
        widths = inner[degree + 1 : len(inner) - 1] - inner[1 : len(inner) - degree - 1]
        matrix = np.diff(matrix, axis=0) * (degree / widths)[:, None]
    return matrix


def places(breaks: Array, coef: Array, times: Array, order: int = 0) -> Array:
    """Return positions, or their derivative, at times of shape (T,), which are clamped to the range.

    coef : shape (n, P + 3, 3); result : shape (n, T, 3)
    """
    return places_of(breaks, coef, order)(times)


def places_of(breaks: Array, coef: Array, order: int = 0) -> Callable[[Array], Array]:
    """Return ``places`` as a function of the times, set up once for many evaluations.

    coef : shape (n, P + 3, 3); result of the function : shape (n, T, 3) at times of shape (T,)
    """
    from scipy.interpolate import BSpline  # films do not need it

    spline = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), DEGREE)
    if order:
        spline = spline.derivative(order)
    return lambda times: np.asarray(np.moveaxis(spline(np.clip(times, breaks[0], breaks[-1])), 0, 1))


def pieces(breaks: Array, coef: Array) -> Array:
    """Return the Bernstein control points of every piece, shape (n, P, 4, 3)."""
    at = places(breaks, coef, breaks)
    rate = places(breaks, coef, breaks, 1)
    third = (np.diff(breaks) / 3.0)[None, :, None]
    first, last = at[:, :-1], at[:, 1:]
    return np.stack([first, first + third * rate[:, :-1], last - third * rate[:, 1:], last], axis=2)
