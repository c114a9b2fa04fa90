"""Pushes the drones of one stretch apart, iteration by iteration, until the separation is proved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.apart import keeps_separation
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.show import Fleet
from shotc.show.solvers.pusher import Index, Push, Pusher
from shotc.show.solvers.qcqp import INNER, DerivativeBounds, bounded

PUSH_ROUNDS = 25
WEIGHT_RATIO = 1.8
"""Growth of the weight of the separation from iteration to iteration."""

APART_WEIGHT = 10.0
MARGIN_SHARES = (0.02, 0.004)
"""Additional share of the distance that is requested: in the first iteration, and the increase in each
further one.
"""

NOISE_M = 0.01
"""Random shift that gives two drones flying head-on at each other a side to pass."""

CONTROL_DECIMALS = 6
"""Decimals of a metre in control points, as in ``assign-goals``."""

HOPELESS_SHARE = 0.05
"""Missing share of the distance above which the limits are not yet enforced, because this is the slowest
step.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Pushed:
    """The result of pushing.

    coef : control points that keep the separation and the limits, shape (n, K, 3), or None after all
        iterations
    rounds : the iterations done
    reached : proved separation of the best result within the limits, m
    """

    coef: Array | None
    rounds: int
    reached: float


def pushed(
    breaks: Array, reference: Array, fleet: Fleet, seed: int, rounds: int = PUSH_ROUNDS, free: slice = INNER
) -> Pushed:
    """Push the drones of a stretch apart.

    With too few iterations there is no result; additional ones change nothing.

    breaks : shape (P + 1,)
    reference : control points within the limits, shape (n, P + 3, 3)
    free : the control points that may change
    """
    bounds = DerivativeBounds(fleet.limits)
    pusher = Pusher(breaks, bounds.scaled(0.999), fleet.apart, free)
    rng = np.random.default_rng(seed)
    coef, movable, reached = reference, np.zeros(0, dtype=np.intp), 0.0
    for k in range(rounds):
        distance = fleet.apart.across * (1.0 + MARGIN_SHARES[0] + k * MARGIN_SHARES[1])
        crowded = np.setdiff1d(pusher.crowded(coef, distance), movable)
        coef, movable = _shaken(coef, crowded, free, rng), np.union1d(movable, crowded)
        coef = pusher.push(coef, reference, movable, Push(distance, APART_WEIGHT * WEIGHT_RATIO**k))
        if len(pusher.crowded(coef, (1.0 - HOPELESS_SHARE) * fleet.apart.across)):
            continue
        result = bounded(breaks, np.round(coef, CONTROL_DECIMALS), bounds, free)
        if len(result.failed):
            continue
        reached = max(reached, closest(breaks, result.coef, fleet.apart).proven)
        if keeps_separation(reached, fleet.apart.across):
            return Pushed(result.coef, k + 1, reached)
    return Pushed(None, rounds, reached)


def _shaken(coef: Array, rows: Index, free: slice, rng: np.random.Generator) -> Array:
    """Shift the free control points of some drones slightly, so that those flying head-on have a side to
    pass.
    """
    coef = coef.copy()
    coef[rows, free] += rng.normal(scale=NOISE_M, size=coef[rows, free].shape)
    return coef
