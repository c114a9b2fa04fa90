"""Learns a target's agility while it moves, with Kalman filters of several models weighted by their
likelihood.

The acceleration noise of a walker on a straight path and of one who turns a corner differ by a factor of a
hundred. A filter for the first lags in corners. A filter for the second follows every error of a receiver,
which misleads a drone that extrapolates its velocity by seconds. So one filter runs for each model, and each
is weighted by the likelihood of the measurements. This is the interacting multiple model filter (Blom and
Bar-Shalom, IEEE TAC 33(8), 1988): before a step the states are mixed by the models' transition probabilities.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.kalman import Estimate, Measurement, MotionModel, ahead, predicted

LASTS_S = 10.0
"""Mean duration of a model, seconds, before another one holds."""

LEAST_SHARE = 1e-6
"""Least weight of a model; a weight of zero could never grow again."""


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """The estimates of all models at one time, and their weights in R runs, (R, M)."""

    estimates: tuple[Estimate, ...]
    share: Array

    @property
    def time(self) -> float:
        """The time, seconds."""
        return self.estimates[0].time

    @property
    def whole(self) -> Estimate:
        """The estimate of the mixture of all models."""
        return self.estimates[0] if len(self.estimates) == 1 else _joined(self.estimates, self.share)


def begun(estimate: Estimate, models: tuple[MotionModel, ...]) -> Modes:
    """Return models with equal weights and the same estimate."""
    share = np.full((len(estimate.mean), len(models)), 1.0 / len(models))
    return Modes((estimate,) * len(models), share)


def stepped(modes: Modes, time: float, models: tuple[MotionModel, ...]) -> Modes:
    """Return the estimates predicted to a later time, seconds, after mixing by the transition
    probabilities.
    """
    count = len(models)
    if count == 1:
        return Modes((predicted(modes.estimates[0], time, models[0]),), modes.share)
    stays = exp(-max(time - modes.time, 0.0) / LASTS_S)
    follows = stays * np.eye(count) + (1.0 - stays) / count
    share = modes.share @ follows
    mixed = (
        predicted(_joined(modes.estimates, modes.share * follows[:, j] / share[:, j : j + 1]), time, model)
        for j, model in enumerate(models)
    )
    return Modes(tuple(mixed), share)


def updated_modes(modes: Modes, measurement: Measurement) -> Modes:
    """Return the estimates updated with a measurement of the same time."""
    updates = [measurement.taken(estimate) for estimate in modes.estimates]
    if len(updates) == 1:
        return Modes((updates[0].estimate,), modes.share)
    fit = np.stack([each.fit for each in updates], axis=1)
    share = np.maximum(modes.share * np.exp(fit - fit.max(axis=1, keepdims=True)), LEAST_SHARE)
    return Modes(tuple(each.estimate for each in updates), share / share.sum(axis=1, keepdims=True))


def expected(modes: Modes, times: Array, models: tuple[MotionModel, ...]) -> Array:
    """Return position and velocity at times (M,), the mean of the models' predictions by weight;
    (M, R, 6).
    """
    predictions = [
        ahead(each, times - modes.time, model) for each, model in zip(modes.estimates, models, strict=True)
    ]
    return np.asarray(np.einsum("kmrd,rk->mrd", np.array(predictions), modes.share))


def _joined(estimates: tuple[Estimate, ...], share: Array) -> Estimate:
    """Return the mean and the covariance of a mixture.

    share : weight of each estimate, (R, M)
    """
    mean = sum(share[:, [j]] * each.mean for j, each in enumerate(estimates))
    assert isinstance(mean, np.ndarray)
    covariance = np.zeros_like(estimates[0].covariance)
    for j, each in enumerate(estimates):
        off = each.mean - mean
        covariance += share[:, j, None, None] * (each.covariance + off[:, :, None] * off[:, None, :])
    return Estimate(estimates[0].time, mean, covariance)
