"""Sensors: satellite positions with noise, bias, delay and drop-outs; targets found in pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.simulation.wind import wandering

BIAS_MEMORY_S = 20.0
"""Correlation time of the bias of a satellite position, seconds."""


FILTER_S = 1.0
BAROMETER_SHARE = 0.2


@dataclass(frozen=True, slots=True)
class Gps:
    """A receiver of satellite positions; metres, each axis by itself.

    noise : standard deviation of what is new in every position
    bias : standard deviation of what drifts over BIAS_MEMORY_S, nearly the same from one position to the next
    offset : what all positions of an axis are off, m, along East, North and Up
    period, delay : seconds between positions, and from the moment they hold for until they arrive
    lost : stretches of time without any, (from, until), seconds of the mission
    """

    noise: float = 0.02
    bias: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float = 0.2
    delay: float = 0.1
    lost: tuple[tuple[float, float], ...] = ()

    @property
    def deviation(self) -> float:
        """Standard deviation of a position, m."""
        return float(np.hypot(self.noise, self.bias))

    def error(self, times: Array, chances: Sequence[np.random.Generator]) -> Array:
        """Return what positions are off at even times (M,), metres; shape (M, R, 3) for R runs."""
        # One draw for both, so that a longer recording begins as a shorter one does.
        noise = np.stack([rng.standard_normal((len(times), 6)) for rng in chances], axis=1)
        white, slow = noise[..., :3], noise[..., 3:]
        step = float(times[1] - times[0]) if len(times) > 1 else 0.0
        drift = wandering(slow, step / BIAS_MEMORY_S)
        return np.asarray(self.noise * white + self.bias * drift + np.array(self.offset))

    def own_error(self, times: Array, chances: Sequence[np.random.Generator]) -> Array:
        """Return what a drone takes its own place to be off at even times (M,), metres; shape (M, R, 3).

        Its filter smooths the noise over FILTER_S, and a barometer holds its height, to BAROMETER_SHARE of
        what the receiver is off.
        """
        noise = np.stack([rng.standard_normal((len(times), 6)) for rng in chances], axis=1)
        step = float(times[1] - times[0]) if len(times) > 1 else 0.0
        white = wandering(noise[..., :3], step / FILTER_S)
        drift = wandering(noise[..., 3:], step / BIAS_MEMORY_S)
        error = self.noise * white + self.bias * drift
        error[..., 2] *= BAROMETER_SHARE
        return np.asarray(error + np.array(self.offset))

    def arrives(self, time: float) -> bool:
        """Tell whether there is a position at a time."""
        return not any(start <= time < end for start, end in self.lost)


RTK = Gps()
PLAIN = Gps(noise=0.3, bias=1.5)
GRADES = {"rtk": RTK, "plain": PLAIN}
"""Receivers by name: with corrections (RTK), and without."""


@dataclass(frozen=True, slots=True)
class Detector:
    """What finds a target in the picture.

    noise : standard deviation of u and of v, half frames
    period, delay : seconds between pictures, and until what was found in one is known
    misses : share of pictures in which a target that is there is not found, 0 to 1
    """

    noise: float = 0.01
    period: float = 0.1
    delay: float = 0.1
    misses: float = 0.05

    def found(self, uv: Array, chances: Sequence[np.random.Generator]) -> tuple[Array, Mask]:
        """Return what is found of targets at (R, 2), half frames (NaN behind the camera), and whether."""
        drawn = np.stack([rng.standard_normal(3) for rng in chances])
        hit = np.stack([rng.uniform() for rng in chances]) >= self.misses
        inside = np.all(np.abs(uv) <= 1.0, axis=1)  # NaN is not inside
        return uv + self.noise * drawn[:, :2], np.asarray(hit & inside)
