"""The nearest of many pairs of drones, by branch and bound over cubic relative motions.

Along any fixed direction a cubic is at least the minimum of its control points. The error of this bound falls
quadratically as intervals are halved. Only intervals that may contain the minimum are halved. Space is
stretched as in ``geom.separation``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, split_half
from shotc.geom.proof import norm

Index = NDArray[np.intp]

GAP_M = 5e-7
"""Admissible difference of the proved bound and an attained value; relative above one metre."""

MOST_HALVINGS = 60
"""Most halvings of an interval, as in ``geom.proof``."""

OPEN_INTERVALS_LIMIT = 200_000
"""Most intervals that are halved together; beyond it the bound stays proven but does not get tighter."""


@dataclass(frozen=True, slots=True, eq=False)
class PairMotions:
    """Relative motions of pairs over intervals; ends : (M, 2), seconds; ctrl : (M, 4, 3), stretched."""

    pairs: Index
    ends: Array
    ctrl: Array

    def pick(self, which: NDArray[np.bool_]) -> PairMotions:
        """Return the rows where a mask is true."""
        return PairMotions(self.pairs[which], self.ends[which], self.ctrl[which])

    def halves(self) -> PairMotions:
        """Return the halves of every interval."""
        left, right = split_half(self.ctrl)
        middle = self.ends.mean(axis=1)
        early = np.stack([self.ends[:, 0], middle], axis=1)
        late = np.stack([middle, self.ends[:, 1]], axis=1)
        return PairMotions(
            np.tile(self.pairs, (2, 1)), np.concatenate([early, late]), np.concatenate([left, right])
        )


class NearestPair:
    """Branch and bound over pairs and intervals.

    upright : whether the separation is an upright cylinder, as high as wide; else a ball
    best : the least distance found so far; rest : the least bound of intervals that were not halved to the
        end
    pair, time : of the least distance
    """

    def __init__(self, *, upright: bool) -> None:
        self.upright = upright
        self.best = self.rest = np.inf
        self.pair, self.time = (0, 0), 0.0

    def note(self, apart: float, pair: tuple[int, int], time: float) -> None:
        """Store an attained distance if it is the least so far."""
        if apart < self.best:
            self.best, self.pair, self.time = apart, pair, time

    def close(self, bag: PairMotions) -> None:
        """Halve intervals until none can contain a smaller distance than the least one found."""
        for _ in range(MOST_HALVINGS):
            if not len(bag.ends):
                return
            sizes = self.size(midway(bag.ctrl))
            k = int(np.argmin(sizes))
            pair = (int(bag.pairs[k, 0]), int(bag.pairs[k, 1]))
            self.note(float(sizes[k]), pair, float(bag.ends[k].mean()))
            bag = bag.pick(self.least(bag.ctrl) < self.best - self.gap())
            if len(bag.ends) > OPEN_INTERVALS_LIMIT:
                break
            bag = bag.halves()
        self.rest = min(self.rest, float(self.least(bag.ctrl).min(initial=np.inf)))

    def gap(self) -> float:
        """Return the admissible difference of the proved bound and the least distance."""
        return GAP_M * max(1.0, self.best)

    def size(self, relative: Array) -> Array:
        """Return the distances (M,) of drones with stretched relative positions (M, 3)."""
        if self.upright:
            return np.asarray(np.maximum(norm(relative[:, :2]), np.abs(relative[:, 2])))
        return norm(relative)

    def least(self, ctrl: Array) -> Array:
        """Return lower bounds (M,) of ``size`` along cubics (M, 4, 3), by planes perpendicular to their
        middles.
        """
        middle = midway(ctrl)
        if not self.upright:
            return least_along(ctrl, middle)
        upright = (ctrl[:, :, 2] * np.sign(middle[:, 2])[:, None]).min(axis=1)
        return np.asarray(np.maximum(least_along(ctrl[:, :, :2], middle[:, :2]), upright))


def joined(bags: Sequence[PairMotions]) -> PairMotions:
    """Return the union of bags."""
    if not bags:
        return PairMotions(np.zeros((0, 2), dtype=np.intp), np.zeros((0, 2)), np.zeros((0, 4, 3)))
    return PairMotions(
        np.concatenate([bag.pairs for bag in bags]),
        np.concatenate([bag.ends for bag in bags]),
        np.concatenate([bag.ctrl for bag in bags]),
    )


def midway(ctrl: Array) -> Array:
    """Return the places (M, 3) in the middle of cubics (M, 4, 3)."""
    return np.asarray((ctrl[:, 0] + ctrl[:, 3] + 3.0 * (ctrl[:, 1] + ctrl[:, 2])) / 8.0)


def least_along(ctrl: Array, towards: Array) -> Array:
    """Return the least of control points (M, 4, D) along directions (M, D), (M,); 0 for no direction."""
    size = norm(towards)
    along = np.einsum("mkd,md->km", ctrl, towards)
    least = np.minimum(np.minimum(along[0], along[1]), np.minimum(along[2], along[3]))
    return np.asarray(least / np.where(size > 0.0, size, 1.0))
