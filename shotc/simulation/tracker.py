"""Tracks one target with measurements that arrive late or out of order.

A late measurement is applied at the time for which it holds, and all later ones are applied again.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.kalman import Estimate, Measurement, MotionModel
from shotc.simulation.modes import Modes, begun, expected, stepped, updated_modes

FIRST_VARIANCE = 0.5
"""Variance of each component of the first state, m^2 and m^2/s^2."""

KEPT_S = 2.0
"""Seconds of history; a measurement older than that is ignored."""


@dataclass(slots=True)
class Tracker:
    """The tracker of one target in R runs.

    models : one or several models of its motion and its receiver's bias
    """

    models: tuple[MotionModel, ...]
    _past: list[tuple[Modes, Measurement | None]] = field(default_factory=list)

    @staticmethod
    def beginning(time: float, place: Array, velocity: Array, *models: MotionModel) -> Tracker:
        """Return a tracker initialised with a satellite position and a velocity, (R, 3) each."""
        mean = np.concatenate([place, velocity, velocity, np.zeros_like(place)], axis=1)
        off = models[0].bias ** 2
        # The receiver's bias shifts a measured position, so the errors of position and bias are
        # anticorrelated. The first velocity is that of the path.
        spread = np.zeros((4, 4))
        spread[1:3, 1:3] = FIRST_VARIANCE
        spread[0, 0], spread[3, 3], spread[0, 3], spread[3, 0] = FIRST_VARIANCE + off, off, -off, -off
        covariance = np.tile(np.kron(spread, np.eye(3)), (len(place), 1, 1))
        return Tracker(models, [(begun(Estimate(time, mean, covariance), models), None)])

    def take(self, measurement: Measurement) -> bool:
        """Apply a measurement at its time; return whether it was recent enough."""
        k = bisect_right(self._past, measurement.time, key=lambda entry: entry[0].time)
        if k == 0:
            return False
        again = [measurement, *(later for _, later in self._past[k:] if later is not None)]
        del self._past[k:]
        for each in again:
            at = stepped(self._past[-1][0], each.time, self.models)
            self._past.append((updated_modes(at, each), each))
        self._forget()
        return True

    def now(self, time: float) -> Estimate:
        """Return the estimate of the target at a time not before any applied measurement."""
        return stepped(self._past[-1][0], time, self.models).whole

    def ahead(self, times: Array) -> Array:
        """Return position and velocity, predicted from the last estimate to times (M,), (M, R,
        6), m and m/s.
        """
        return expected(stepped(self._past[-1][0], float(times[0]), self.models), times, self.models)

    def spread(self, times: Array) -> Array:
        """Return the standard deviation of the position predicted to times (M,), (M, R), metres: of the
        horizontal direction in which it is largest.
        """
        estimate = stepped(self._past[-1][0], float(times[0]), self.models)
        return np.array([_across(stepped(estimate, time, self.models).whole) for time in times.tolist()])

    def _forget(self) -> None:
        oldest = self._past[-1][0].time - KEPT_S
        k = bisect_right(self._past, oldest, key=lambda entry: entry[0].time)
        if k > 1:
            del self._past[: k - 1]


def _across(estimate: Estimate) -> Array:
    """Return the larger standard deviation of the horizontal position, (R,), metres."""
    flat = estimate.covariance[:, :2, :2]
    mean, half = 0.5 * (flat[:, 0, 0] + flat[:, 1, 1]), 0.5 * (flat[:, 0, 0] - flat[:, 1, 1])
    return np.asarray(np.sqrt(mean + np.hypot(half, flat[:, 0, 1])))
