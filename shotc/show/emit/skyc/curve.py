"""A fleet's splines as the key points of a show file: fewer, at whole milliseconds, and next to exact.

A piece between two key points is the cubic that has the spline's place and velocity at both. Over pieces
of the spline it differs from them by a cubic whose control points bound how far it is off at any time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory

TOLERANCE_M = 5e-4
"""How far key points may be off for there to be fewer of them, metres."""

COORDINATE_DECIMALS = 4
"""Of coordinates, metres: a tenth of a millimetre."""

LONGEST_PIECES = 32
"""Pieces of a spline that one of a file may stand for, which bounds the work of trying."""

MOVES_M = 1e-6
"""How far a drone that stands is from where it stood, at most, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """A fleet's motion from the first instant it moves to the last.

    millis : shape (K,), of mission time; control : shape (n, K - 1, 4, 3), Bernstein control points in metres
    error : how far it is from the fleet's splines, at most, metres, rounding included
    """

    millis: NDArray[np.int64]
    control: Array
    error: float


def curves(flight: FleetTrajectory) -> Curves:
    """Return the key points of a fleet's flight, at times that all of its drones share.

    The fleet moves by one clock: where one drone's curve needs a point, so do nearly all others'.
    """
    millis = np.unique(np.round(flight.breaks * 1e3).astype(np.int64))
    times = millis / 1e3
    at = places(flight.breaks, flight.coef, times)
    rate = places(flight.breaks, flight.coef, times, 1)
    first, last = _moving(at)
    keys, error = _thinned(times, at, rate, (first, last))
    third = (np.diff(times[keys]) / 3.0)[None, :, None]
    start, end = at[:, keys[:-1]], at[:, keys[1:]]
    control = np.stack(
        [start, start + third * rate[:, keys[:-1]], end - third * rate[:, keys[1:]], end], axis=2
    )
    rounded = np.round(control, COORDINATE_DECIMALS) + 0.0  # no negative zeros
    return Curves(millis[keys], rounded, error + float(np.linalg.norm(rounded - control, axis=-1).max()))


def _moving(at: Array) -> tuple[int, int]:
    """Return the last break before anything has moved and the first one after which nothing does."""
    away = np.linalg.norm(at - at[:, :1], axis=-1).max(axis=0) > MOVES_M
    back = np.linalg.norm(at - at[:, -1:], axis=-1).max(axis=0) > MOVES_M
    if not away.any():
        return 0, len(away) - 1
    return max(int(np.argmax(away)) - 1, 0), int(np.flatnonzero(back)[-1]) + 1


def _thinned(times: Array, at: Array, rate: Array, span: tuple[int, int]) -> tuple[list[int], float]:
    """Return the breaks that are kept, each as far from the one before as the tolerance lets it be."""
    keys, last, worst, reached = [span[0]], span[1], 0.0, 0.0
    for k in range(span[0] + 1, last + 1):
        if k - keys[-1] > 1:
            error = _error(times, at, rate, (keys[-1], k))
            if error > TOLERANCE_M or k - keys[-1] > LONGEST_PIECES:
                keys.append(k - 1)
                worst, error = max(worst, reached), 0.0
            reached = error
    keys.append(last)
    return keys, max(worst, reached)


def _error(times: Array, at: Array, rate: Array, ends: tuple[int, int]) -> float:
    """Return how far one cubic from break to break is from the spline between them, at most, metres."""
    a, b = ends
    t, h = times[a : b + 1], float(times[b] - times[a])
    s = ((t - t[0]) / h)[None, :, None]
    basis = (2 * s**3 - 3 * s**2 + 1, (s**3 - 2 * s**2 + s) * h, 3 * s**2 - 2 * s**3, (s**3 - s**2) * h)
    slope = ((6 * s**2 - 6 * s) / h, 3 * s**2 - 4 * s + 1, (6 * s - 6 * s**2) / h, 3 * s**2 - 2 * s)
    ends_at = (at[:, a, None], rate[:, a, None], at[:, b, None], rate[:, b, None])
    off = sum(x * y for x, y in zip(basis, ends_at, strict=True)) - at[:, a : b + 1]
    faster = sum(x * y for x, y in zip(slope, ends_at, strict=True)) - rate[:, a : b + 1]
    third = (np.diff(t) / 3.0)[None, :, None]
    hull = (off, off[:, :-1] + third * faster[:, :-1], off[:, 1:] - third * faster[:, 1:])
    return max(float(np.linalg.norm(points, axis=-1).max()) for points in hull)
