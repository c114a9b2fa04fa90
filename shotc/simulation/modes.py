"""How agile a target is, learned while it moves: Kalman filters of several models, weighed by their success.

A walker who keeps to his way and one who turns a corner differ by a factor of a hundred in the noise on their
acceleration. A filter for the one cuts the other's corners; a filter for the other believes every error of a
receiver, and who flies seconds ahead along its velocity is led about. So one filter runs for each model, and
each is believed by how well it expected what was measured (the interacting multiple model of Blom and
Bar-Shalom, IEEE TAC 33(8), 1988): before a step their states are mixed by how likely one follows another.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.kalman import Estimate, Measurement, MotionModel, ahead, predicted

LASTS_S = 10.0
"""Seconds for which a model holds in the mean before another one does."""

LEAST_SHARE = 1e-6
"""Share that no model falls below: one that is given up never comes back."""


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """The estimates of all models at one moment, and how much each is believed in R runs, (R, M)."""

    estimates: tuple[Estimate, ...]
    share: Array

    @property
    def time(self) -> float:
        """The moment, seconds."""
        return self.estimates[0].time

    @property
    def whole(self) -> Estimate:
        """What is known, over all models."""
        return self.estimates[0] if len(self.estimates) == 1 else _joined(self.estimates, self.share)


def begun(estimate: Estimate, models: tuple[MotionModel, ...]) -> Modes:
    """Return models that are believed alike and know the same."""
    share = np.full((len(estimate.mean), len(models)), 1.0 / len(models))
    return Modes((estimate,) * len(models), share)


def stepped(modes: Modes, time: float, models: tuple[MotionModel, ...]) -> Modes:
    """Return what is known as of a later time, seconds, where a model may have followed another one."""
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


def taken(modes: Modes, measurement: Measurement) -> Modes:
    """Return what is known with a measurement of that moment taken in."""
    found = [measurement.taken(estimate) for estimate in modes.estimates]
    if len(found) == 1:
        return Modes((found[0].estimate,), modes.share)
    fit = np.stack([each.fit for each in found], axis=1)
    share = np.maximum(modes.share * np.exp(fit - fit.max(axis=1, keepdims=True)), LEAST_SHARE)
    return Modes(tuple(each.estimate for each in found), share / share.sum(axis=1, keepdims=True))


def expected(modes: Modes, times: Array, models: tuple[MotionModel, ...]) -> Array:
    """Return place and velocity at times (M,), each model by itself as far as it is believed; (M, R, 6)."""
    found = [
        ahead(each, times - modes.time, model) for each, model in zip(modes.estimates, models, strict=True)
    ]
    return np.asarray(np.einsum("kmrd,rk->mrd", np.array(found), modes.share))


def _joined(estimates: tuple[Estimate, ...], share: Array) -> Estimate:
    """Return the mean and the covariance of a mixture; share : of each, (R, M)."""
    mean = sum(share[:, [j]] * each.mean for j, each in enumerate(estimates))
    assert isinstance(mean, np.ndarray)
    covariance = np.zeros_like(estimates[0].covariance)
    for j, each in enumerate(estimates):
        off = each.mean - mean
        covariance += share[:, j, None, None] * (each.covariance + off[:, :, None] * off[:, None, :])
    return Estimate(estimates[0].time, mean, covariance)
