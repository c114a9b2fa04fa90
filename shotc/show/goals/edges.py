"""Lights along the edges of a flat picture: on its corners, and evenly between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heapify, heapreplace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped

CORNER_RAD = np.radians(40.0)
"""Change of direction from which a place is a corner, which a letter without a light there loses."""
RING_LIGHTS = 3
"""Lights that a closed line without corners takes at least."""


class _Part(NamedTuple):
    """A line (K, 2) from corner to corner; open : that its end is no other part's start."""

    line: Array
    open: bool

    @property
    def length(self) -> float:
        return float(_steps(self.line).sum())

    @property
    def fewest(self) -> int:
        return RING_LIGHTS if _closed(self.line) else 1 + self.open


def along_edges(edges: Sequence[Array], count: int, least: float, metric: Array) -> Array:
    """Return ``count`` places evenly along edges, shape (count, 2).

    edges : of each shape (E, 2, 2), one after another along its lines, as ``flat.Shape`` has them
    least : of corners that are nearer to each other, by the factors of ``metric`` (2,), the sharpest has a
    light. Where there are fewer lights than corners they follow the lines alone, the longest first.
    """
    lines = [line for each in edges for line in _lines(each)]
    parts = [part for line in lines for part in _parts(line, least, metric)]
    if sum(part.fewest for part in parts) > count:
        whole = [_Part(line, not _closed(line)) for line in lines]
        parts = sorted(whole, key=lambda part: -part.length)[:count]
    shares = _shared(parts, count)
    return np.concatenate([_spread(part, n) for part, n in zip(parts, shares, strict=True)])


def _shared(parts: Sequence[_Part], count: int) -> list[int]:
    """Give lights to parts one by one, each to that which has them farthest apart."""
    shares = [part.fewest for part in parts]
    if sum(shares) > count:
        shares = [1] * len(shares)
    lengths = [part.length for part in parts]
    gaps = [(-length / share, i) for i, (length, share) in enumerate(zip(lengths, shares, strict=True))]
    heapify(gaps)
    for _ in range(count - sum(shares)):
        i = gaps[0][1]
        shares[i] += 1
        heapreplace(gaps, (-lengths[i] / (shares[i] - parts[i].open), i))
    return shares


def _lines(edges: Array) -> Iterator[Array]:
    """Yield the lines, (K, 2), that edges follow from end to start, without those of no length."""
    edges = edges[np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1) > 1e-9]
    if len(edges):
        breaks = np.flatnonzero(np.linalg.norm(edges[1:, 0] - edges[:-1, 1], axis=1) > 1e-6) + 1
        for run in np.split(edges, breaks):
            yield np.concatenate([run[:1, 0], run[:, 1]])


def _closed(line: Array) -> bool:
    return bool(np.linalg.norm(line[0] - line[-1]) <= 1e-6)


def _parts(line: Array, least: float, metric: Array) -> list[_Part]:
    """Cut a line at its corners; of those nearer to each other than ``least`` at the sharper one."""
    way = np.diff(line, axis=0)
    angle = np.arctan2(way[:, 1], way[:, 0])
    turn = np.abs(wrapped(np.roll(angle, -1) - angle))  # at the end of each edge
    closed = _closed(line)
    if not closed:
        turn[-1] = 0.0
    kept: list[int] = []
    for k in np.argsort(-turn, kind="stable")[: int((turn > CORNER_RAD).sum())] + 1:
        if (np.linalg.norm((line[kept] - line[k]) * metric, axis=1) >= least).all():
            kept.append(int(k))
    if not kept:
        return [_Part(line, not closed)]
    cuts = np.sort(kept)
    if closed:
        line = np.concatenate([np.roll(line[:-1], -cuts[0], axis=0), line[cuts[:1] % (len(line) - 1)]])
        cuts = cuts[1:] - cuts[0]
    ends = [0, *cuts.tolist(), len(line) - 1]
    return [_Part(line[i : j + 1], not closed and j == ends[-1]) for i, j in pairwise(ends) if j > i]


def _steps(line: Array) -> Array:
    return np.asarray(np.linalg.norm(np.diff(line, axis=0), axis=1))


def _spread(part: _Part, count: int) -> Array:
    """Return places along a part from its start to its end, or a step before an end that begins another."""
    line = part.line
    ends = np.concatenate([[0.0], np.cumsum(_steps(line))])
    at = np.arange(count) / max(1, count - part.open) * ends[-1]
    return np.column_stack([np.interp(at, ends, line[:, 0]), np.interp(at, ends, line[:, 1])])
