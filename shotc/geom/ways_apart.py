"""A proved bound on the distance of two curves, for any times at which they are flown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array, bernstein_basis
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.proof import norm

SAMPLES_PER_PIECE = 9
"""Samples of a piece for the first search of the nearest points."""
MOST_HALVINGS = 40
OPEN_PAIRS_LIMIT = 100_000
"""Most pairs of pieces that are halved together; beyond it the bound stays proven but does not get
tighter."""


@dataclass(frozen=True, slots=True)
class CurveDistance:
    """The least distance of two curves, metres.

    proven : a lower bound on it; attained : the distance of the points at parameters ``one`` and ``other``
    """

    proven: float
    attained: float
    one: float
    other: float


def nearest(one: Pieces, other: Pieces, gap: Callable[[float], float]) -> CurveDistance:
    """Bound the infimum of the distance of two curves (M, n + 1, 3) over both of their parameters.

    gap : as in ``proof.inf_distance``
    """
    best, at = _sampled(one, other)
    pairs = _near(one, other, best)
    closed, rest = np.inf, np.inf
    for _ in range(MOST_HALVINGS):
        if not len(pairs.first):
            break
        first, second = pairs.one.ctrl[pairs.first], pairs.other.ctrl[pairs.second]
        middle = _middle(first) - _middle(second)
        distance = norm(middle)
        k = int(np.argmin(distance))
        if distance[k] < best:
            best = float(distance[k])
            at = (_when(pairs.one, int(pairs.first[k])), _when(pairs.other, int(pairs.second[k])))
        along = middle / np.maximum(distance, 1e-12)[:, None]
        apart = np.einsum("mkd,md->mk", first, along).min(axis=1)
        lower = np.maximum(apart - np.einsum("mkd,md->mk", second, along).max(axis=1), 0.0)
        is_open = lower < best - gap(best)
        closed = min(closed, float(lower[~is_open].min(initial=np.inf)))
        rest = float(lower[is_open].min(initial=np.inf))
        if best <= 0.0 or is_open.sum() > OPEN_PAIRS_LIMIT:
            break
        pairs = _halved(pairs, is_open)
    return CurveDistance(min(closed, best, rest), best, *at)


class _Pairs(NamedTuple):
    """Pairs of pieces of two curves: the pieces, and their indices in each pair, (M,)."""

    one: Pieces
    other: Pieces
    first: IntArray
    second: IntArray


def _sampled(one: Pieces, other: Pieces) -> tuple[float, tuple[float, float]]:
    share = np.linspace(0.0, 1.0, SAMPLES_PER_PIECE)
    places = [
        np.einsum("tk,mkd->mtd", bernstein_basis(bag.ctrl.shape[1] - 1, share), bag.ctrl).reshape(-1, 3)
        for bag in (one, other)
    ]
    times = [(bag.low[:, None] + share * (bag.high - bag.low)[:, None]).ravel() for bag in (one, other)]
    distance, index = cKDTree(places[1]).query(places[0])
    k = int(np.argmin(distance))
    return float(distance[k]), (float(times[0][k]), float(times[1][int(index[k])]))


def _near(one: Pieces, other: Pieces, reach: float) -> _Pairs:
    """Return the pairs of pieces whose bounding balls are within reach."""
    balls = []
    for bag in (one, other):
        centre = 0.5 * (bag.ctrl.min(axis=1) + bag.ctrl.max(axis=1))
        balls.append((centre, norm(bag.ctrl - centre[:, None]).max(axis=1)))
    (a, r), (b, s) = balls
    neighbours = cKDTree(b).query_ball_point(a, reach + r + s.max())
    first = np.repeat(np.arange(len(a)), [len(each) for each in neighbours])
    second = np.array([j for each in neighbours for j in each], dtype=np.intp)
    near = norm(a[first] - b[second]) <= reach + r[first] + s[second]
    return _Pairs(one, other, first[near], second[near])


def _halved(pairs: _Pairs, which: Mask) -> _Pairs:
    """Return every pair of halves of the pieces of some pairs."""
    halves, bags = [], []
    for bag, index in ((pairs.one, pairs.first[which]), (pairs.other, pairs.second[which])):
        used, renamed = np.unique(index, return_inverse=True)
        bags.append(Pieces(bag.low[used], bag.high[used], bag.ctrl[used]).halves())
        halves.append((renamed, len(used)))
    (a, m), (b, n) = halves
    first = np.concatenate([a, a, a + m, a + m])
    second = np.concatenate([b, b + n, b, b + n])
    return _Pairs(bags[0], bags[1], first, second)


def _middle(ctrl: Array) -> Array:
    return np.asarray(np.einsum("k,mkd->md", bernstein_basis(ctrl.shape[1] - 1, np.array(0.5)), ctrl))


def _when(bag: Pieces, k: int) -> float:
    return float(0.5 * (bag.low[k] + bag.high[k]))
