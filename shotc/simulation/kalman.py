"""One step of a Kalman filter for a target's motion, vectorised over runs.

The state is x = [p, v, w, b] in W (m, m/s, m/s, m): position, velocity, the velocity of the course that the
target keeps, and the slow bias of satellite positions. The model is p' = v, v' = (w - v) / tau + noise of
density q, w' = noise of density q_w. A target that weaves steps aside for about a second and returns (the
acceleration of Singer, IEEE TAES 6(4), 1970, has a memory of the same form). A prediction over seconds
therefore follows w, which is known better than v. Without a memory, tau is infinite and v alone is predicted.

b is an Ornstein-Uhlenbeck process. Without it, the filter would treat a lasting bias as noise that averages
out. It would become certain of a wrong position, and reject correct detections.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import exp, inf
from typing import NamedTuple, Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.simulation.sensors import BIAS_MEMORY_S

GATE_CHI2 = 9.21
"""Squared Mahalanobis distance, above which a detection is taken for another object: chi-square, 99 %."""

STATE_COUNT = 12
WAY, BIAS = slice(6, 9), slice(9, 12)
"""Indices of the course's velocity and of the bias in a state."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
"""Quadrature of the integral for Q over one step, exact to 1e-10 for steps of up to five memories."""


@dataclass(frozen=True, slots=True)
class MotionModel:
    """The motion model of a target.

    agility : q of the noise on its acceleration, m^2/s^3
    bias : standard deviation of the slow bias of positions, metres, that of the drone's own position included
    memory : tau, time constant with which a velocity returns to that of the course, seconds; infinite if it
        never does
    drift : q_w of the noise on the velocity of the course, m^2/s^3
    """

    agility: float
    bias: float = 0.0
    memory: float = inf
    drift: float = 0.0

    def span(self, seconds: Array | float) -> Array:
        """Return the seconds of motion that a deviation from the course's velocity contributes in
        some time, shape (...) of ``seconds``.
        """
        if self.memory == inf:
            return np.asarray(seconds)
        return np.asarray(-self.memory * np.expm1(-np.asarray(seconds) / self.memory))


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """The state at a time, seconds: mean (R, 12) and covariance (R, 12, 12)."""

    time: float
    mean: Array
    covariance: Array

    @property
    def position(self) -> Array:
        """Position of the target, (R, 3), metres."""
        return self.mean[:, :3]

    @property
    def velocity(self) -> Array:
        """Velocity of the target, (R, 3), m/s."""
        return self.mean[:, 3:6]

    @property
    def course_velocity(self) -> Array:
        """Velocity of the course, (R, 3), m/s."""
        return self.mean[:, WAY]


class Taken(NamedTuple):
    """An estimate after a measurement.

    fit : log-likelihood of the measurement, (R,); 0 in runs without one
    """

    estimate: Estimate
    fit: Array


class Measurement(Protocol):
    """A sensor's measurement, with the time for which it holds."""

    @property
    def time(self) -> float:
        """The time, seconds."""

    def taken(self, estimate: Estimate) -> Taken:
        """Return the estimate of the same time, updated with the measurement."""


@dataclass(frozen=True, slots=True, eq=False)
class PositionFix:
    """A satellite position.

    place : (R, 3), metres
    deviation : standard deviation of its noise, metres
    used : the runs in which it is used, (R,)
    """

    time: float
    place: Array
    deviation: float
    used: Mask

    def taken(self, estimate: Estimate) -> Taken:
        """Return the estimate updated with the position."""
        jacobian = np.zeros((len(self.place), 3, STATE_COUNT))
        jacobian[:, :, :3] = jacobian[:, :, BIAS] = np.eye(3)
        noise = self.deviation**2 * np.eye(3)
        miss = self.place - estimate.position - estimate.mean[:, BIAS]
        return _updated(estimate, _Innovation(miss, jacobian, noise), self.used)


@dataclass(frozen=True, slots=True, eq=False)
class PictureFix:
    """A detection at (u, v) (R, 2), half frames, seen from eyes (R, 3) with axes R_WC (R, 3, 3).

    half : tan of half the fields of view, (R, 2)
    deviation : standard deviation of u and v
    used : the runs in which it is used, (R,)
    """

    time: float
    uv: Array
    eye: Array
    axes: Array
    half: Array
    deviation: float
    used: Mask

    def taken(self, estimate: Estimate) -> Taken:
        """Return the estimate updated with the detection unless the gate rejects it (extended
        Kalman filter).
        """
        expected, jacobian = projection(estimate.position - self.eye, self.axes, self.half)
        known = self.used & np.isfinite(expected).all(axis=1)
        miss = np.where(known[:, None], self.uv - expected, 0.0)
        rows = np.zeros((len(miss), 2, STATE_COUNT))
        rows[:, :, :3] = np.where(known[:, None, None], jacobian, 0.0)
        noise = self.deviation**2 * np.eye(2)
        spread = rows @ estimate.covariance @ np.swapaxes(rows, 1, 2) + noise
        off = np.einsum("ri,rij,rj->r", miss, np.linalg.inv(spread), miss)
        right = off <= GATE_CHI2
        updated = _updated(estimate, _Innovation(miss, rows, noise), known & right)
        # A model whose detections are always rejected has the likelihood of a detection at the gate.
        rest = -0.5 * (GATE_CHI2 + np.linalg.slogdet(spread)[1])
        return Taken(updated.estimate, np.where(known & ~right, rest, updated.fit))


def projection(offset: Array, axes: Array, half: Array) -> tuple[Array, Array]:
    """Return (u, v) of points at offsets from eyes, (R, 2), and the derivative by the offset, (R, 2, 3).

    The result is NaN behind the camera.

    offset : (R, 3), W, metres
    axes : R_WC (R, 3, 3)
    half : tan of half the fields of view, (R, 2)
    """
    inside = np.einsum("rij,ri->rj", axes, offset)
    depth = np.where(inside[:, 2] > 1e-6, inside[:, 2], np.nan)
    flat = inside[:, :2] * np.array([1.0, -1.0]) / half
    uv = flat / depth[:, None]
    across = np.swapaxes(axes[:, :, :2], 1, 2) * np.array([1.0, -1.0])[:, None] / half[:, :, None]
    jacobian = (across - uv[:, :, None] * axes[:, None, :, 2]) / depth[:, None, None]
    return uv, jacobian


def predicted(estimate: Estimate, time: float, model: MotionModel) -> Estimate:
    """Return an estimate predicted to a later time, seconds."""
    dt = time - estimate.time
    if dt <= 0.0:
        return estimate
    forward, noise = _transition(dt, model)
    spread = forward @ estimate.covariance @ forward.T + noise
    return Estimate(time, estimate.mean @ forward.T, spread)


def ahead(estimate: Estimate, seconds: Array, model: MotionModel) -> Array:
    """Return predicted position and velocity after times (M,), seconds, shape (M, R, 6), metres and m/s."""
    span, left = model.span(seconds)[:, None, None], np.asarray(seconds)[:, None, None]
    course, beside = estimate.course_velocity, estimate.velocity - estimate.course_velocity
    decay = 1.0 - span / model.memory
    place = estimate.position + left * course + span * beside
    return np.concatenate([place, course + decay * beside], axis=2)


@lru_cache(maxsize=1024)
def _transition(dt: float, model: MotionModel) -> tuple[Array, Array]:
    """Return F and Q over dt seconds, (12, 12) each."""
    decay = exp(-dt / BIAS_MEMORY_S)
    forward, noise = np.eye(4), np.zeros((4, 4))
    forward[:3, :3], forward[3, 3] = _forward(dt, model), decay
    fresh = np.diag([0.0, model.agility, model.drift])
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        transition = _forward(0.5 * dt * (1.0 + node), model)
        noise[:3, :3] += 0.5 * dt * weight * transition @ fresh @ transition.T
    noise[3, 3] = model.bias**2 * (1.0 - decay * decay)
    return np.asarray(np.kron(forward, np.eye(3))), np.asarray(np.kron(noise, np.eye(3)))


def _forward(dt: float, model: MotionModel) -> Array:
    """Return F of position, velocity and the course's velocity along one axis, (3, 3)."""
    span = float(model.span(dt))
    share = span / model.memory
    return np.array([[1.0, span, dt - span], [0.0, 1.0 - share, share], [0.0, 0.0, 1.0]])


class _Innovation(NamedTuple):
    """The residual of a measurement (R, m), its Jacobian (R, m, 12), and its noise covariance (m, m)."""

    miss: Array
    jacobian: Array
    noise: Array


def _updated(estimate: Estimate, innovation: _Innovation, used: Mask) -> Taken:
    """Return an estimate after an update where ``used``, (R,)."""
    miss, jacobian, noise = innovation
    across = np.swapaxes(jacobian, 1, 2)
    spread = jacobian @ estimate.covariance @ across + noise
    inverse = np.linalg.inv(spread)
    fit = -0.5 * (np.einsum("ri,rij,rj->r", miss, inverse, miss) + np.linalg.slogdet(spread)[1])
    gain = estimate.covariance @ across @ inverse
    gain = np.where(used[:, None, None], gain, 0.0)
    mean = estimate.mean + np.einsum("rij,rj->ri", gain, miss)
    # Joseph's form keeps the covariance symmetric and positive.
    left = np.eye(STATE_COUNT) - gain @ jacobian
    covariance = left @ estimate.covariance @ np.swapaxes(left, 1, 2) + gain @ noise @ np.swapaxes(gain, 1, 2)
    return Taken(Estimate(estimate.time, mean, covariance), np.where(used, fit, 0.0))
