"""Sensor models: satellite positions with noise, bias, delay and drop-outs, and detections in pictures."""

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
    """A receiver of satellite positions; metres, each axis independent.

    noise : standard deviation of the white noise
    bias : standard deviation of the drift, with correlation time BIAS_MEMORY_S
    offset : constant error along East, North and Up
    period : seconds between positions
    delay : seconds from a position's time until it arrives
    lost : intervals without positions, (from, until), seconds of mission time
    """

    noise: float = 0.02
    bias: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float = 0.2
    delay: float = 0.1
    lost: tuple[tuple[float, float], ...] = ()

    @property
    def deviation(self) -> float:
        """Standard deviation of a position, metres."""
        return float(np.hypot(self.noise, self.bias))

    def error(self, times: Array, chances: Sequence[np.random.Generator]) -> Array:
        """Return position errors at uniform times (M,), seconds; shape (M, R, 3) for R runs, metres."""
        # One draw for both, so that a longer series begins like a shorter one.
        noise = np.stack([rng.standard_normal((len(times), 6)) for rng in chances], axis=1)
        white, slow = noise[..., :3], noise[..., 3:]
        step = float(times[1] - times[0]) if len(times) > 1 else 0.0
        drift = wandering(slow, step / BIAS_MEMORY_S)
        return np.asarray(self.noise * white + self.bias * drift + np.array(self.offset))

    def own_error(self, times: Array, chances: Sequence[np.random.Generator]) -> Array:
        """Return the errors of a drone's own position at uniform times (M,), seconds; shape (M, R, 3),
        metres.

        Its filter smooths the noise over FILTER_S. Its barometer reduces the error of height to
        BAROMETER_SHARE of the receiver's.
        """
        noise = np.stack([rng.standard_normal((len(times), 6)) for rng in chances], axis=1)
        step = float(times[1] - times[0]) if len(times) > 1 else 0.0
        white = wandering(noise[..., :3], step / FILTER_S)
        drift = wandering(noise[..., 3:], step / BIAS_MEMORY_S)
        error = self.noise * white + self.bias * drift
        error[..., 2] *= BAROMETER_SHARE
        return np.asarray(error + np.array(self.offset))

    def arrives(self, time: float) -> bool:
        """Return whether there is a position at a time."""
        return not any(start <= time < end for start, end in self.lost)


RTK = Gps()
PLAIN = Gps(noise=0.3, bias=1.5)
GRADES = {"rtk": RTK, "plain": PLAIN}
"""Receivers by name: with corrections (RTK), and without."""


@dataclass(frozen=True, slots=True)
class Detector:
    """A detector of targets in pictures.

    noise : standard deviation of u and of v, half frames
    period : seconds between pictures
    delay : seconds until a detection is available
    misses : share of visible targets that are not found, 0 to 1
    """

    noise: float = 0.01
    period: float = 0.1
    delay: float = 0.1
    misses: float = 0.05

    def found(self, uv: Array, chances: Sequence[np.random.Generator]) -> tuple[Array, Mask]:
        """Return detections of targets at (R, 2), half frames (NaN behind the camera), and their existence
        (R,).
        """
        drawn = np.stack([rng.standard_normal(3) for rng in chances])
        hit = np.stack([rng.uniform() for rng in chances]) >= self.misses
        inside = np.all(np.abs(uv) <= 1.0, axis=1)  # false for NaN
        return uv + self.noise * drawn[:, :2], np.asarray(hit & inside)
