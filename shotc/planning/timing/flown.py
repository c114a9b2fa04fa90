"""Check flown quintics against the limits at every instant, by their control points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, split_half
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.planning.timing.limits import LIMIT_SHARE, Ceiling, LimitedNorm
from shotc.planning.timing.profile import Profile, fly

Array = NDArray[np.float64]

# Halvings of each piece before its hull is taken; the bound is then tight to about 1e-4.
HULL_HALVINGS = 3
# Quintics whose error from the path exceeds the first (metres or rad) get more knots, as do those that leave
# a gimbal's range by more than the second; at most this many times.
STRAY_M, RANGE_ROUNDING = 5e-4, 1e-7
MOST_SPLITS = 5


@dataclass(frozen=True, slots=True, eq=False)
class Usage:
    """The share of one limit that each piece uses.

    name : of the limit in Ceiling
    order : 1 rate, 2 acceleration, 3 jerk
    share : upper bound of the norm over the limit, shape (P,)
    """

    name: str
    order: int
    limit: float
    share: Array

    @property
    def slowdown(self) -> Array:
        """The factor by which each piece has to be slowed to keep the limit; shape (P,)."""
        return np.asarray(self.share ** (1.0 / self.order))


def usages(curve: Piecewise, limits: tuple[LimitedNorm, ...]) -> tuple[Usage, ...]:
    """Return the use of every limit that is verified, proved for all t of each piece."""
    usages = []
    derivatives = {order: curve.derivative(order) for order in (1, 2, 3)}
    for axis in limits:
        for order, bound in ((1, axis.rate), (2, axis.acceleration), (3, None if axis.ease else axis.jerk)):
            if bound is not None:
                along = derivatives[order].ctrl @ axis.pick.T
                size = axis.rate_used if order == 1 else _norm
                usages.append(Usage(bound[0], order, bound[1], _peak(along, size) / bound[1]))
    return tuple(usages)


def needed_scale(usage: tuple[Usage, ...]) -> Array:
    """Return the slowdown of each piece (P,) that keeps every limit with a small margin; may be below 1."""
    return np.asarray(np.max([u.slowdown for u in usage], axis=0) / LIMIT_SHARE)


def on_path(path: Piecewise, profile: Profile, ceiling: Ceiling) -> tuple[Profile, Piecewise]:
    """Return the profile and its quintics, with more knots where these leave the path or a range."""
    flown = fly(path, profile)
    for _ in range(MOST_SPLITS):
        strays = straying(path, profile, flown, ceiling)
        if not strays.any():
            break
        profile = profile.split(strays)
        flown = fly(path, profile)
    return profile, flown


def straying(path: Piecewise, profile: Profile, flown: Piecewise, ceiling: Ceiling) -> NDArray[np.bool_]:
    """Return which flown pieces are too far from the path at the same s; shape (N,).

    The gimbal's ranges end sharply and the path may run along their ends, so there a piece has to be almost
    on the path.
    """
    inside = np.array([0.25, 0.5, 0.75])
    t = profile.t[:-1, None] + inside * np.diff(profile.t)[:, None]
    s = profile.curve()(t)[..., 0]
    offset = flown(t) - path(s)
    strays = np.abs(offset).max(axis=(1, 2)) > STRAY_M
    gimbal_yaw = flown.ctrl[:, :, CAM_YAW] - flown.ctrl[:, :, BODY_YAW]
    for angle, error, (low, high) in (
        (flown.ctrl[:, :, CAM_PITCH], offset[:, :, CAM_PITCH], ceiling.pitch),
        (gimbal_yaw, offset[:, :, CAM_YAW] - offset[:, :, BODY_YAW], ceiling.yaw),
    ):
        beyond = (angle.min(axis=1) < low - RANGE_ROUNDING) | (angle.max(axis=1) > high + RANGE_ROUNDING)
        strays |= beyond & (np.abs(error).max(axis=1) > RANGE_ROUNDING)
    return np.asarray(strays)


def _norm(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _peak(ctrl: Array, size: Callable[[Array], Array]) -> Array:
    """Return an upper bound of a convex function on every piece, at least 0; shape (P,)."""
    pieces = len(ctrl)
    parts = ctrl
    for _ in range(HULL_HALVINGS):
        left, right = split_half(parts)
        parts = np.concatenate([left, right])
    sizes = np.maximum(size(parts), 0.0)
    return np.asarray(sizes.max(axis=1).reshape(-1, pieces).max(axis=0))
