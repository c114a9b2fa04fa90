"""Take-off and landing in layers, one after another, each at least a vertical separation from the next.

All layers climb with the same profile of bounded speed, acceleration and jerk, later layers later. Control
points are samples of that profile at uniform times: their differences are means of its derivatives, and so
keep every bound at all times. The difference of two layers in the air is a spline as well, in the convex hull
of the differences of its control points. A layer leaves its pads with the first piece from which on all of
these are at least the wanted distance. The landing is the same, backwards in time.
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
"""Duration of a piece. A layer starts up to that long later than it could, so that files of 4 Hz
can hold it.
"""
FIRST_POINT = 2
"""The control point for the start of a move, because a stop is three of them."""


@dataclass(frozen=True, slots=True, eq=False)
class LayeredMove:
    """A move in which every drone flies straight to its goal, the drones of a layer in common.

    shares : of the path, by layer and control point, shape (K, P + 3)
    layer : of each drone, shape (n,)
    """

    shares: Array
    layer: NDArray[np.intp]

    @property
    def duration(self) -> float:
        """Return the time from the first movement until all rest, s."""
        return PIECE_S * self.pieces

    @property
    def pieces(self) -> int:
        """Return the number of pieces."""
        return len(self.shares[0]) - 3

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        displacements = goals - starts
        return [starts + share[self.layer, None] * displacements for share in self.shares.T[3:-3]]


def rising(heights: Sequence[float], step: float, layer: NDArray[np.intp], limits: Limits) -> LayeredMove:
    """Return the take-off of layers, the first the highest.

    heights : of the layers, decreasing, m
    step : between two layers, m
    layer : of each drone, shape (n,)
    """
    return LayeredMove(_shares(heights, step, _bounds(limits, limits.climb)), layer)


def sinking(heights: Sequence[float], step: float, layer: NDArray[np.intp], limits: Limits) -> LayeredMove:
    """Return the landing of layers, the last and lowest one first; arguments as for ``rising``."""
    up = _shares(heights, step, _bounds(limits, limits.descent))
    return LayeredMove(1.0 - up[:, ::-1], layer)


def _bounds(limits: Limits, speed: float) -> LineLimits:
    return LineLimits(*(LIMIT_SHARE * most for most in (speed, limits.usable_acceleration, limits.jerk)))


def _shares(heights: Sequence[float], step: float, bounds: LineLimits) -> Array:
    """Return shares of the paths upwards, shape (K, P + 3)."""
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
    """Return the heights of a climb from rest to rest at the ends of its pieces, shape (pieces + 1,)."""
    profile = bounds.profile(0.0, height)
    times = np.minimum(PIECE_S * np.arange(pieces + 1), profile.duration)
    places = profile.curve()(times)[:, 0]
    places[-1] = height
    return np.asarray(places)
