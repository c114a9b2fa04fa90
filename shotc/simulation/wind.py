"""Wind: one constant vector for a run, and gusts. World frame W, m/s."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, pi, sqrt

import numpy as np

from shotc.geom.bernstein import Array

GUST_MEMORY_S = 2.0
"""Correlation time of gusts, seconds: long enough to displace a drone, too short for its integrator."""


@dataclass(frozen=True, slots=True)
class WindField:
    """The wind of all runs.

    speed : of the constant part, m/s
    toward : yaw of the direction in which it blows, rad from East; None draws one for each run
    gusts : standard deviation of each axis of the gusts, m/s
    """

    speed: float = 0.0
    toward: float | None = None
    gusts: float = 0.0

    def steady(self, chances: Sequence[np.random.Generator]) -> Array:
        """Return the constant part of R runs, shape (R, 3), m/s.

        chances : random generator of each run
        """
        drawn = np.array([rng.uniform(0.0, 2 * pi) for rng in chances])
        toward = drawn if self.toward is None else np.full(len(drawn), self.toward)
        return self.speed * np.column_stack([np.cos(toward), np.sin(toward), np.zeros(len(drawn))])

    def blown(self, steps: int, step: float, chances: Sequence[np.random.Generator]) -> Array:
        """Return the gusts of R runs at ``steps`` instants ``step`` seconds apart, (steps, R, 3), m/s.

        They are an Ornstein-Uhlenbeck process, exact for a step of any length.
        """
        if self.gusts == 0.0:
            return np.broadcast_to(0.0, (steps, len(chances), 3))
        noise = np.stack([rng.standard_normal((steps, 3)) for rng in chances], axis=1)
        return np.asarray(self.gusts * wandering(noise, step / GUST_MEMORY_S))


def wandering(noise: Array, share: float) -> Array:
    """Return an Ornstein-Uhlenbeck process of standard deviation 1 from white noise of standard deviation 1.

    noise : shape (N, ...), one row for each instant
    share : time between instants over the correlation time
    """
    decay = exp(-share)
    fresh = sqrt(1.0 - decay * decay)
    out = np.empty_like(noise)
    out[0] = noise[0]
    for k in range(1, len(noise)):
        out[k] = decay * out[k - 1] + fresh * noise[k]
    return out
