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

RECKONED_M_S, RECKONED_M_S2 = 0.1, 0.05
"""Standard deviations of the errors of velocity and of acceleration, on each horizontal axis, with which a
drone goes on by its inertial sensors when positions are lost. That of acceleration is what an attitude error
of 0.3 degrees takes for a motion. After 5 s the position is off by 0.8 m on each axis.
"""

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Gps:
    """A receiver of satellite positions; metres, each axis independent.

    noise : standard deviation of the white noise
    bias : standard deviation of the drift, with correlation time BIAS_MEMORY_S
    offset : constant error along East, North and Up
    period : seconds between positions
    delay : seconds from a position's time until it arrives
    """

    noise: float = 0.02
    bias: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float = 0.2
    delay: float = 0.1

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

    def own_error(
        self, times: Array, chances: Sequence[np.random.Generator], lost: Sequence[Interval] = ()
    ) -> Array:
        """Return the errors of a drone's own position at uniform times (M,), seconds; shape (M, R, 3),
        metres.

        Its filter smooths the noise over FILTER_S. Its barometer reduces the error of height to
        BAROMETER_SHARE of the receiver's. Without satellites it goes on by its inertial sensors, and comes
        back to its receiver within about FILTER_S.

        lost : intervals without satellites, (from, until), in order, seconds
        """
        noise = np.stack([rng.standard_normal((len(times), 6)) for rng in chances], axis=1)
        step = float(times[1] - times[0]) if len(times) > 1 else 0.0
        white = wandering(noise[..., :3], step / FILTER_S)
        drift = wandering(noise[..., 3:], step / BIAS_MEMORY_S)
        error = self.noise * white + self.bias * drift
        error[..., 2] *= BAROMETER_SHARE
        error += np.array(self.offset)
        for interval in lost:
            drawn = np.stack([rng.standard_normal((2, 2)) for rng in chances])
            _reckon(error, times, interval, drawn)
        return np.asarray(error)


def within(time: float, lost: Sequence[Interval]) -> bool:
    """Return whether a time is in one of some intervals."""
    return any(start <= time < end for start, end in lost)


def _reckon(error: Array, times: Array, lost: Interval, drawn: Array) -> None:
    """Replace position errors (M, R, 3) by those of inertial sensors in an interval, and let them fade after
    it.

    drawn : of the errors of velocity and acceleration, East and North, standard normal, (R, 2, 2)
    """
    first, after = np.searchsorted(times, lost).tolist()
    last = error[max(first - 1, 0), :, :2].copy()

    def reckoned(since: Array) -> Array:
        t = since[:, None, None]
        return np.asarray(last + RECKONED_M_S * drawn[:, 0] * t + 0.5 * RECKONED_M_S2 * drawn[:, 1] * t * t)

    error[first:after, :, :2] = reckoned(times[first:after] - lost[0])
    if after < len(times):
        gap = reckoned(np.array([lost[1] - lost[0]]))[0] - error[after, :, :2]
        error[after:, :, :2] += np.exp((lost[1] - times[after:]) / FILTER_S)[:, None, None] * gap


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

    def detections(self, uv: Array, chances: Sequence[np.random.Generator]) -> tuple[Array, Mask]:
        """Return detections of targets at (R, 2), half frames (NaN behind the camera), and their existence
        (R,).
        """
        drawn = np.stack([rng.standard_normal(3) for rng in chances])
        hit = np.stack([rng.uniform() for rng in chances]) >= self.misses
        inside = np.all(np.abs(uv) <= 1.0, axis=1)  # false for NaN
        return uv + self.noise * drawn[:, :2], np.asarray(hit & inside)
