"""The moves of a fleet whose drones start one after another, each with the same profile from its own start
on.

Drone i flies straight from x_i to g_i as x_i + s((t - tau_i) / L) (g_i - x_i), with a profile s of
``solvers.move``, its duration L, s, and the start tau_i, between 0 and the duration W of the wave. The
control points of all drones are samples of that over Q uniform pieces of h seconds. Differences of samples
are means of derivatives, so the largest derivative of s over L bounds every drone at all times, whatever its
start. The spline starts one piece before the first drone and ends one piece after the last has arrived: the
whole takes T = L + W + 2 h with h = T / Q.
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
"""Pieces of the move of one drone."""
LEAST_PIECES = 12
MOST_PIECES = 500
"""Most pieces of the whole move, for any duration of the wave."""


@dataclass(frozen=True, slots=True, eq=False)
class WaveMove:
    """A common move with individual starts.

    ramps : the profile of every drone
    departs : start of each after the first, shape (n,), s
    duration : from rest to rest of the fleet, s
    pieces : number of uniform pieces of the duration
    limit : name in ``ir.limits.Limits`` of the active limit
    drone : row of the drone for which it is active
    """

    ramps: Ramps
    departs: Array
    duration: float
    pieces: int
    limit: str
    drone: int

    @property
    def piece(self) -> float:
        """Return the duration of each piece, s."""
        return self.duration / self.pieces

    @property
    def own(self) -> float:
        """Return the duration of one drone's move, s."""
        return self.duration - 2.0 * self.piece - float(self.departs.max())

    def lasting(self, duration: float) -> WaveMove:
        """Return the same wave with another duration: each drone starts at the same time and is slower."""
        return replace(self, duration=duration)

    @property
    def s(self) -> Array:
        """Return the control points of the shares of the paths, shape (n, pieces + 3)."""
        elapsed = (np.arange(self.pieces + 3) - 2.0) * self.piece
        return profile(np.clip((elapsed - self.departs[:, None]) / self.own, 0.0, 1.0), self.ramps)

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        displacements = goals - starts
        return [starts + share[:, None] * displacements for share in self.s.T[3:-3]]


def fastest_wave(
    displacements: Array, departs: Array, limits: Limits, pace: float, easing: Easing
) -> WaveMove:
    """Return the shortest move of an easing that is found, within every limit times ``pace`` for all drones.

    displacements : g - x, shape (n, 3), m
    departs : start of each after the first, shape (n,), s
    """
    ceilings = Ceilings.of(displacements, limits, pace)
    every = ramps_of(easing)
    peaks = np.array([ramps.peaks for ramps in every])
    least = np.maximum(ceilings.least(peaks), LEAST_PIECE_S)
    # Of equally fast profiles, take the smoothest.
    k = int(np.where(least <= 1.001 * least.min(), peaks[:, 2], np.inf).argmin())
    own = float(least[k])
    whole = own + float(departs.max())
    pieces = ceil(min(PIECES_PER_MOVE * whole / own, whole / LEAST_PIECE_S, MOST_PIECES))
    pieces = max(pieces, LEAST_PIECES)
    seconds = max(whole / (1.0 - 2.0 / pieces), pieces * LEAST_PIECE_S)
    return WaveMove(
        every[k], departs, ceil(seconds / TICK_S) * TICK_S, pieces, *ceilings.binding(peaks[k], own)
    )
