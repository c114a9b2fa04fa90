"""Where a target is and how it moves, estimated of what sensors say: a Kalman filter for many runs at once.

State x = [p, v] in W (metres, m/s) with white noise on the acceleration:
F = [I dt I; 0 I], Q = q [dt^3/3 I, dt^2/2 I; dt^2/2 I, dt I]. A measurement that arrives late is taken in at
the moment it holds for: what came after it is taken in again.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask

GATE = 9.21
"""Squared distance from what is expected beyond which a detection is of something else: chi-square, 99 %."""

FIRST_VARIANCE = 0.5
"""Of each component of the first state, m^2 and m^2/s^2."""

KEPT_S = 2.0
"""Seconds for which the past is kept: what arrives later than that is too old to be taken in."""


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """The state at a time, seconds: mean (R, 6) and covariance (R, 6, 6)."""

    time: float
    mean: Array
    covariance: Array

    @property
    def position(self) -> Array:
        """Where the target is, (R, 3), metres."""
        return self.mean[:, :3]

    @property
    def velocity(self) -> Array:
        """How it moves, (R, 3), m/s."""
        return self.mean[:, 3:]


class Measurement(Protocol):
    """What a sensor says, stamped with the moment it holds for."""

    @property
    def time(self) -> float:
        """That moment, seconds."""

    def taken(self, estimate: Estimate) -> Estimate:
        """Return the estimate of the same moment with the measurement taken in."""


@dataclass(frozen=True, slots=True, eq=False)
class PositionFix:
    """A satellite position: place (R, 3), metres; deviation : of each axis; used : in which runs, (R,)."""

    time: float
    place: Array
    deviation: float
    used: Mask

    def taken(self, estimate: Estimate) -> Estimate:
        """Take the position in."""
        jacobian = np.zeros((len(self.place), 3, 6))
        jacobian[:, :, :3] = np.eye(3)
        noise = self.deviation**2 * np.eye(3)
        return _updated(estimate, (self.place - estimate.position, jacobian, noise), self.used)


@dataclass(frozen=True, slots=True, eq=False)
class PictureFix:
    """A detection: (u, v) (R, 2), half frames, seen from eyes (R, 3) with axes R_WC (R, 3, 3).

    half : tan of half the fields of view, (R, 2); deviation : of u and v; used : in which runs, (R,)
    """

    time: float
    uv: Array
    eye: Array
    axes: Array
    half: Array
    deviation: float
    used: Mask

    def taken(self, estimate: Estimate) -> Estimate:
        """Take the detection in, where it is not another thing's (the extended Kalman filter's row)."""
        expected, jacobian = projection(estimate.position - self.eye, self.axes, self.half)
        known = self.used & np.isfinite(expected).all(axis=1)
        miss = np.where(known[:, None], self.uv - expected, 0.0)
        rows = np.zeros((len(miss), 2, 6))
        rows[:, :, :3] = np.where(known[:, None, None], jacobian, 0.0)
        noise = self.deviation**2 * np.eye(2)
        spread = rows @ estimate.covariance @ np.swapaxes(rows, 1, 2) + noise
        off = np.einsum("ri,rij,rj->r", miss, np.linalg.inv(spread), miss)
        return _updated(estimate, (miss, rows, noise), known & (off <= GATE))


def projection(offset: Array, axes: Array, half: Array) -> tuple[Array, Array]:
    """Return (u, v) of points at offsets from eyes, (R, 2), and its derivative by the offset, (R, 2, 3).

    offset : (R, 3), W; axes : R_WC (R, 3, 3); half : (R, 2); NaN behind the camera
    """
    inside = np.einsum("rij,ri->rj", axes, offset)
    depth = np.where(inside[:, 2] > 1e-6, inside[:, 2], np.nan)
    flat = inside[:, :2] * np.array([1.0, -1.0]) / half
    uv = flat / depth[:, None]
    across = np.swapaxes(axes[:, :, :2], 1, 2) * np.array([1.0, -1.0])[:, None] / half[:, :, None]
    jacobian = (across - uv[:, :, None] * axes[:, None, :, 2]) / depth[:, None, None]
    return uv, jacobian


@dataclass(slots=True)
class Tracker:
    """One target of R runs.

    agility : q, of the noise on its acceleration, m^2/s^3
    """

    agility: float
    _past: list[tuple[Estimate, Measurement | None]] = field(default_factory=list)

    @staticmethod
    def beginning(time: float, place: Array, velocity: Array, agility: float) -> Tracker:
        """Return a tracker that knows a first place and velocity, (R, 3) each, roughly."""
        mean = np.concatenate([place, velocity], axis=1)
        covariance = np.tile(FIRST_VARIANCE * np.eye(6), (len(place), 1, 1))
        return Tracker(agility, [(Estimate(time, mean, covariance), None)])

    def take(self, measurement: Measurement) -> bool:
        """Take a measurement in, in its place in time; tell whether it was not too old for that."""
        k = bisect_right(self._past, measurement.time, key=lambda entry: entry[0].time)
        if k == 0:
            return False
        again = [measurement, *(later for _, later in self._past[k:] if later is not None)]
        del self._past[k:]
        for each in again:
            at = predicted(self._past[-1][0], each.time, self.agility)
            self._past.append((each.taken(at), each))
        self._forget()
        return True

    def now(self, time: float) -> Estimate:
        """Return what is known of the target at a time at or after all that was taken in."""
        return predicted(self._past[-1][0], time, self.agility)

    def _forget(self) -> None:
        oldest = self._past[-1][0].time - KEPT_S
        k = bisect_right(self._past, oldest, key=lambda entry: entry[0].time)
        if k > 1:
            del self._past[: k - 1]


def predicted(estimate: Estimate, time: float, agility: float) -> Estimate:
    """Return an estimate as of a later time, seconds."""
    dt = time - estimate.time
    if dt <= 0.0:
        return estimate
    forward = np.eye(6)
    forward[:3, 3:] = dt * np.eye(3)
    noise = np.kron(np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]), np.eye(3))
    return Estimate(
        time,
        estimate.mean @ forward.T,
        forward @ estimate.covariance @ forward.T + agility * noise,
    )


def _updated(estimate: Estimate, row: tuple[Array, Array, Array], used: Mask) -> Estimate:
    """Return an estimate with innovation (R, m), Jacobian (R, m, 6) and noise (m, m) taken in where used."""
    miss, jacobian, noise = row
    across = np.swapaxes(jacobian, 1, 2)
    spread = jacobian @ estimate.covariance @ across + noise
    gain = estimate.covariance @ across @ np.linalg.inv(spread)
    gain = np.where(used[:, None, None], gain, 0.0)
    mean = estimate.mean + np.einsum("rij,rj->ri", gain, miss)
    # Joseph's form stays symmetric and positive.
    left = np.eye(6) - gain @ jacobian
    covariance = left @ estimate.covariance @ np.swapaxes(left, 1, 2) + gain @ noise @ np.swapaxes(gain, 1, 2)
    return Estimate(estimate.time, mean, covariance)
