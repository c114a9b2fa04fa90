"""The nearest of many pairs of drones: relative motions as cubics, halved until the least distance is proved.

Along any fixed direction a cubic is nowhere less than its control points. That bound closes quadratically as
intervals are halved, and only those that could still hold the least value are. Space is stretched as in
``geom.separation``.
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
"""How far the proved bound may stay below a value that is attained, relative beyond one metre."""

ROUNDS = 60
"""Halvings before a bound is given as it is, as in ``geom.proof``."""

OPEN_INTERVALS_LIMIT = 200_000
"""Intervals halved at once; beyond it the bound stays proven but is not made tighter."""


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
        """Return every interval cut in two."""
        left, right = split_half(self.ctrl)
        middle = self.ends.mean(axis=1)
        early = np.stack([self.ends[:, 0], middle], axis=1)
        late = np.stack([middle, self.ends[:, 1]], axis=1)
        return PairMotions(
            np.tile(self.pairs, (2, 1)), np.concatenate([early, late]), np.concatenate([left, right])
        )


class NearestPair:
    """Branch and bound over pairs and intervals.

    upright : whether what is kept free is an upright cylinder, as high as wide, else a ball
    best : the least distance found so far; rest : the least bound of what was not halved to the end
    pair, time : whose it is, and when
    """

    def __init__(self, *, upright: bool) -> None:
        self.upright = upright
        self.best = self.rest = np.inf
        self.pair, self.time = (0, 0), 0.0

    def note(self, apart: float, pair: tuple[int, int], time: float) -> None:
        """Keep a distance that is attained, if it is the least so far."""
        if apart < self.best:
            self.best, self.pair, self.time = apart, pair, time

    def close(self, bag: PairMotions) -> None:
        """Halve intervals until none could be nearer than the nearest found."""
        for _ in range(ROUNDS):
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
        """Return how far the proved bound may stay below the least distance."""
        return GAP_M * max(1.0, self.best)

    def size(self, relative: Array) -> Array:
        """Return how near the drones are whose stretched relative positions are given, shape (M,)."""
        if self.upright:
            return np.asarray(np.maximum(norm(relative[:, :2]), np.abs(relative[:, 2])))
        return norm(relative)

    def least(self, ctrl: Array) -> Array:
        """Return lower bounds of ``size`` along cubics, from planes across their middles."""
        middle = midway(ctrl)
        if not self.upright:
            return least_along(ctrl, middle)
        upright = (ctrl[:, :, 2] * np.sign(middle[:, 2])[:, None]).min(axis=1)
        return np.asarray(np.maximum(least_along(ctrl[:, :, :2], middle[:, :2]), upright))


def joined(bags: Sequence[PairMotions]) -> PairMotions:
    """Put bags into one."""
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
    """Return how far control points (M, 4, D) are at least along directions (M, D), 0 where there is none."""
    size = norm(towards)
    along = np.einsum("mkd,md->km", ctrl, towards)
    least = np.minimum(np.minimum(along[0], along[1]), np.minimum(along[2], along[3]))
    return np.asarray(least / np.where(size > 0.0, size, 1.0))
