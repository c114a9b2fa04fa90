"""The moves of a fleet whose drones set out one after another, each on one profile of its own time.

Drone i goes straight from x_i to g_i as x_i + s((t - tau_i) / L) (g_i - x_i), with a profile s of
``solvers.move``, its length L, seconds, and tau_i when it sets out, a share of the time W of the wave. The
control points of all are samples of that over Q even pieces of h seconds. Differences of samples are means
of derivatives, so that the largest derivative of s over L bounds what everybody does at every instant,
whenever it sets out. The spline begins a piece before the first sets out and ends a piece after the last
has arrived: the whole takes T = L + W + 2 h with h = T / Q.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.show.solvers.move import LEAST_PIECE_S, TICK_S, Ceilings, Ramps, profile, ramps_of

PIECES_PER_MOVE = 24
"""Pieces that the move of one drone has."""
LEAST_PIECES = 12
MOST_PIECES = 500
"""Pieces of the whole, whatever the wave lasts."""


@dataclass(frozen=True, slots=True, eq=False)
class WaveMove:
    """A common move with departures of its own.

    ramps : the profile of every drone; departs : when each sets out after the first, shape (n,), seconds
    duration : from when the fleet rests to when it does again, seconds; pieces : even ones, all of that
    limit : name in ``ir.limits.Limits`` of what binds; drone : whom it binds, a row
    """

    ramps: Ramps
    departs: Array
    duration: float
    pieces: int
    limit: str
    drone: int

    @property
    def piece(self) -> float:
        """Return seconds that each piece takes."""
        return self.duration / self.pieces

    @property
    def own(self) -> float:
        """Return seconds that the way of one drone takes."""
        return self.duration - 2.0 * self.piece - float(self.departs.max())

    def lasting(self, duration: float) -> WaveMove:
        """Return the same wave in more seconds: each drone is slower, and sets out at the same time."""
        return replace(self, duration=duration)

    @property
    def s(self) -> Array:
        """Return the control points of the shares of the ways, shape (n, pieces + 3)."""
        since = (np.arange(self.pieces + 3) - 2.0) * self.piece
        return profile(np.clip((since - self.departs[:, None]) / self.own, 0.0, 1.0), self.ramps)

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        ways = goals - starts
        return [starts + share[:, None] * ways for share in self.s.T[3:-3]]


def fastest_wave(ways: Array, departs: Array, limits: Limits, pace: float, easing: Easing) -> WaveMove:
    """Return the shortest move of an easing, every limit times ``pace`` kept by all drones.

    ways : g - x, shape (n, 3), metres; departs : when each sets out after the first, shape (n,), seconds
    """
    ceilings = Ceilings.of(ways, limits, pace)
    every = ramps_of(easing)
    peaks = np.array([ramps.peaks for ramps in every])
    least = np.maximum(ceilings.least(peaks), LEAST_PIECE_S)
    # Of those that are as fast, the smoothest.
    k = int(np.where(least <= 1.001 * least.min(), peaks[:, 2], np.inf).argmin())
    own = float(least[k])
    whole = own + float(departs.max())
    pieces = ceil(min(PIECES_PER_MOVE * whole / own, whole / LEAST_PIECE_S, MOST_PIECES))
    pieces = max(pieces, LEAST_PIECES)
    seconds = max(whole / (1.0 - 2.0 / pieces), pieces * LEAST_PIECE_S)
    return WaveMove(
        every[k], departs, ceil(seconds / TICK_S) * TICK_S, pieces, *ceilings.binding(peaks[k], own)
    )
