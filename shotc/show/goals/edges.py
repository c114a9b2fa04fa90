"""Lights along the edges of a flat picture: on its corners, and uniformly in between."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heapify, heapreplace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped

CORNER_RAD = np.radians(40.0)
"""Change of direction of a corner, which must have a light for a letter to be legible."""
RING_LIGHTS = 3
"""Least lights of a closed line without corners."""


class _EdgeLine(NamedTuple):
    """A line (K, 2) between corners.

    open : whether its end is not the start of another part
    """

    line: Array
    open: bool

    @property
    def length(self) -> float:
        return float(_steps(self.line).sum())

    @property
    def fewest(self) -> int:
        return RING_LIGHTS if _closed(self.line) else 1 + self.open


def along_edges(edges: Sequence[Array], count: int, least: float, metric: Array) -> Array:
    """Return ``count`` places uniformly along edges, shape (count, 2).

    If there are fewer lights than corners, they follow the lines alone, the longest first.

    edges : of each shape (E, 2, 2), consecutive along its lines, as in ``flat.FlatPart``
    least : of corners nearer to each other than this, scaled by ``metric`` (2,), only the sharpest has a
        light
    """
    lines = [line for each in edges for line in _lines(each)]
    parts = [part for line in lines for part in _parts(line, least, metric)]
    if sum(part.fewest for part in parts) > count:
        whole = [_EdgeLine(line, not _closed(line)) for line in lines]
        parts = sorted(whole, key=lambda part: -part.length)[:count]
    shares = _shared(parts, count)
    return np.concatenate([_spread(part, n) for part, n in zip(parts, shares, strict=True)])


def _shared(parts: Sequence[_EdgeLine], count: int) -> list[int]:
    """Return the number of lights of each part; each light goes to the part with the largest spacing."""
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
    """Yield the lines, (K, 2), of consecutive edges, without edges of zero length."""
    edges = edges[np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1) > 1e-9]
    if len(edges):
        breaks = np.flatnonzero(np.linalg.norm(edges[1:, 0] - edges[:-1, 1], axis=1) > 1e-6) + 1
        for run in np.split(edges, breaks):
            yield np.concatenate([run[:1, 0], run[:, 1]])


def _closed(line: Array) -> bool:
    return bool(np.linalg.norm(line[0] - line[-1]) <= 1e-6)


def _parts(line: Array, least: float, metric: Array) -> list[_EdgeLine]:
    """Return a line cut at its corners; of corners nearer than ``least``, only the sharpest counts."""
    steps = np.diff(line, axis=0)
    angle = np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs(wrapped(np.roll(angle, -1) - angle))  # at the end of each edge
    closed = _closed(line)
    if not closed:
        turn[-1] = 0.0
    chosen: list[int] = []
    for k in np.argsort(-turn, kind="stable")[: int((turn > CORNER_RAD).sum())] + 1:
        if (np.linalg.norm((line[chosen] - line[k]) * metric, axis=1) >= least).all():
            chosen.append(int(k))
    if not chosen:
        return [_EdgeLine(line, not closed)]
    cuts = np.sort(chosen)
    if closed:
        line = np.concatenate([np.roll(line[:-1], -cuts[0], axis=0), line[cuts[:1] % (len(line) - 1)]])
        cuts = cuts[1:] - cuts[0]
    ends = [0, *cuts.tolist(), len(line) - 1]
    return [_EdgeLine(line[i : j + 1], not closed and j == ends[-1]) for i, j in pairwise(ends) if j > i]


def _steps(line: Array) -> Array:
    return np.asarray(np.linalg.norm(np.diff(line, axis=0), axis=1))


def _spread(part: _EdgeLine, count: int) -> Array:
    """Return places along a part, from its start to its end, or to one step before the start of
    another part.
    """
    line = part.line
    ends = np.concatenate([[0.0], np.cumsum(_steps(line))])
    at = np.arange(count) / max(1, count - part.open) * ends[-1]
    return np.column_stack([np.interp(at, ends, line[:, 0]), np.interp(at, ends, line[:, 1])])
