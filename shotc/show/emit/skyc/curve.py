"""Converts a fleet's splines to the key points of a show file: fewer points, at whole milliseconds, with a
bounded error.

A piece between two key points is the cubic with the spline's position and velocity at both. Its difference
from each piece of the spline is a cubic, whose control points bound the error at every time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory

TOLERANCE_M = 5e-4
"""Largest error by which key points are saved, metres."""

COORDINATE_DECIMALS = 4
"""Decimals of coordinates in metres: a tenth of a millimetre."""

LONGEST_PIECES = 32
"""Most pieces of a spline for one piece of the file, which bounds the search."""

MOVES_M = 1e-6
"""Largest distance from its place of a drone that counts as standing, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """A fleet's motion from the first motion to the last.

    millis : mission times, shape (K,)
    control : Bernstein control points, shape (n, K - 1, 4, 3), metres
    error : bound of the distance from the fleet's splines, metres, rounding included
    """

    millis: NDArray[np.int64]
    control: Array
    error: float


def curves(flight: FleetTrajectory) -> Curves:
    """Return the key points of a fleet's flight, at common times of all its drones.

    The fleet moves on one clock, so nearly all drones need key points at the same times.
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
    """Return the last break before the first motion, and the first break after the last motion."""
    distances = np.linalg.norm(at - at[:, :1], axis=-1).max(axis=0) > MOVES_M
    back = np.linalg.norm(at - at[:, -1:], axis=-1).max(axis=0) > MOVES_M
    if not distances.any():
        return 0, len(distances) - 1
    return max(int(np.argmax(distances)) - 1, 0), int(np.flatnonzero(back)[-1]) + 1


def _thinned(times: Array, at: Array, rate: Array, span: tuple[int, int]) -> tuple[list[int], float]:
    """Return the indices of the kept breaks, as few as the tolerance allows, and the largest
    error, metres.
    """
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
    """Return a bound of the distance of one cubic between two breaks from the spline, metres."""
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
