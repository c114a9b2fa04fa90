"""Holds flown quintics to the limits, at every instant, by their control points; and how much to slow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, split_half
from shotc.passes.parameterize_time.limits import SHARE, Axis
from shotc.passes.parameterize_time.profile import Profile

Array = NDArray[np.float64]

# Each piece is halved this often before its hull is taken: the bound is then tight to about 1e-4.
HALVINGS = 3


@dataclass(frozen=True, slots=True, eq=False)
class Usage:
    """How much of one limit each piece uses.

    name : of the limit in Ceiling; order : 1 rate, 2 acceleration, 3 jerk
    share : shape (P,), upper bound of the norm over the limit
    """

    name: str
    order: int
    limit: float
    share: Array

    @property
    def slowdown(self) -> Array:
        """Return by how much each piece has to be slowed to keep the limit; shape (P,)."""
        return np.asarray(self.share ** (1.0 / self.order))


def usages(curve: Piecewise, limits: tuple[Axis, ...]) -> tuple[Usage, ...]:
    """Return the use of every limit that a proof will ask for, proved for all t of each piece."""
    found = []
    derivatives = {order: curve.derivative(order) for order in (1, 2, 3)}
    for axis in limits:
        for order, bound in ((1, axis.rate), (2, axis.acceleration), (3, None if axis.ease else axis.jerk)):
            if bound is not None:
                along = derivatives[order].ctrl @ axis.pick.T
                found.append(Usage(bound[0], order, bound[1], _peak(along, axis.sign) / bound[1]))
    return tuple(found)


def needed_scale(found: tuple[Usage, ...]) -> Array:
    """Return the slowdown per piece that keeps every limit with a little to spare; may be below 1."""
    return np.asarray(np.max([u.slowdown for u in found], axis=0) / SHARE)


def path_error(path: Piecewise, profile: Profile, flown: Piecewise) -> Array:
    """Return how far each flown piece strays from the path at the same s: metres or rad, shape (N,)."""
    inside = np.array([0.25, 0.5, 0.75])
    t = profile.t[:-1, None] + inside * np.diff(profile.t)[:, None]
    s = profile.curve()(t)[..., 0]
    return np.asarray(np.abs(flown(t) - path(s)).max(axis=(1, 2)))


def _peak(ctrl: Array, sign: int) -> Array:
    pieces = len(ctrl)
    parts = ctrl
    for _ in range(HALVINGS):
        left, right = split_half(parts)
        parts = np.concatenate([left, right])
    size = np.maximum(sign * parts[..., 0], 0.0) if sign else np.linalg.norm(parts, axis=-1)
    return np.asarray(size.max(axis=1).reshape(-1, pieces).max(axis=0))
