"""Rising and sinking in layers: one after another, each layer a vertical separation from the next at least.

All of them climb by the same profile of bounded speed, acceleration and jerk, the later ones later. Control
points are places of that profile at even times: their differences are means of its derivatives, and so keep
every bound at every instant. Where two layers are in the air their difference is a spline, too, and in the
hull of the differences of its control points. A layer leaves its pads with the first piece from which on all
of these are as large as is wanted. Coming down is the same, backwards in time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.planning.timing.straight import LineLimits
from shotc.show.solvers.move import LIMIT_SHARE

PIECE_S = 0.5
"""Seconds of a piece. A layer leaves that long after it might, or more, which files of 4 Hz show."""
FIRST_POINT = 2
"""The control point that stands for the beginning of a move, three being a stop."""


@dataclass(frozen=True, slots=True, eq=False)
class LayeredMove:
    """A move in which everybody goes straight to his goal, the drones of a layer alike.

    shares : of the way, by layer and control point, shape (K, P + 3); layer : of each drone, shape (n,)
    """

    shares: Array
    layer: NDArray[np.intp]

    @property
    def duration(self) -> float:
        """Return seconds from the first that moves to the last that rests."""
        return PIECE_S * self.pieces

    @property
    def pieces(self) -> int:
        """Return the number of pieces."""
        return len(self.shares[0]) - 3

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        ways = goals - starts
        return [starts + share[self.layer, None] * ways for share in self.shares.T[3:-3]]


def rising(heights: Sequence[float], step: float, layer: NDArray[np.intp], limits: Limits) -> LayeredMove:
    """Return how layers rise, the first the highest; heights : falling, m; step : between two of them, m."""
    return LayeredMove(_shares(heights, step, _bounds(limits, limits.climb)), layer)


def sinking(heights: Sequence[float], step: float, layer: NDArray[np.intp], limits: Limits) -> LayeredMove:
    """Return how they sink, the last, lowest one first; as in ``rising``."""
    up = _shares(heights, step, _bounds(limits, limits.descent))
    return LayeredMove(1.0 - up[:, ::-1], layer)


def _bounds(limits: Limits, speed: float) -> LineLimits:
    return LineLimits(*(LIMIT_SHARE * most for most in (speed, limits.usable_acceleration, limits.jerk)))


def _shares(heights: Sequence[float], step: float, bounds: LineLimits) -> Array:
    """Return shares of the ways up, shape (K, P + 3)."""
    needed = [ceil(bounds.rest_to_rest(height) / PIECE_S) for height in heights]
    length = FIRST_POINT + sum(needed) + len(needed) + 1
    paths: list[Array] = []
    start = last = 0
    for height, pieces in zip(heights, needed, strict=True):
        own = _climb(height, pieces, bounds)
        while True:
            path = np.zeros(length)
            path[FIRST_POINT + start : FIRST_POINT + start + len(own)] = own
            path[FIRST_POINT + start + len(own) :] = height
            if not paths or (paths[-1] - path)[start:].min() >= step - 1e-9:
                break
            start += 1
        paths.append(path)
        last = max(last, start + pieces)
    return np.asarray(
        np.stack([path[: FIRST_POINT + last + 3] for path in paths]) / np.array(heights)[:, None]
    )


def _climb(height: float, pieces: int, bounds: LineLimits) -> Array:
    """Return the places of a climb from rest to rest at the ends of so many pieces, shape (pieces + 1,)."""
    profile = bounds.profile(0.0, height)
    times = np.minimum(PIECE_S * np.arange(pieces + 1), profile.duration)
    places = profile.curve()(times)[:, 0]
    places[-1] = height
    return np.asarray(places)
