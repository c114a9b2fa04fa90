"""The shortest polyline through a vertical section, between a least and a greatest height at each place."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """Bounds of the height along a path, metres; between neighbouring places they are linear.

    along : distance from the start of the path, metres, increasing, shape (N,)
    low, high : (N,); at the first and the last place both are the heights of the path's ends
    """

    along: Array
    low: Array
    high: Array


def taut(section: Section) -> Array:
    """Return the corners (K, 2), distance and height, of the shortest path through a section, ends included.

    From each corner the interval of slopes that pass all places so far shrinks. Where it becomes empty, the
    place that bounds it on the other side is the next corner (Lee and Preparata 1984, in two dimensions).
    Where the greatest height is below the least one, the path takes the least.
    """
    along, low = section.along, section.low
    high = np.maximum(section.high, low)
    corners, i, z = [(0, float(low[0]))], 0, float(low[0])
    while i < len(along) - 1:
        run = along[i + 1 :] - along[i]
        least, most = (low[i + 1 :] - z) / run, (high[i + 1 :] - z) / run
        floor, roof = np.maximum.accumulate(least), np.minimum.accumulate(most)
        shut = np.flatnonzero(floor > roof)
        if not len(shut):
            i, z = len(along) - 1, float(low[-1])
        else:
            j = int(shut[0])
            up = least[j] > (roof[j - 1] if j else np.inf)
            bounds = most[:j] == roof[j - 1] if up else least[:j] == floor[j - 1]
            i += 1 + int(np.flatnonzero(bounds)[-1])
            z = float(high[i] if up else low[i])
        corners.append((i, z))
    return np.array([(along[k], height) for k, height in corners])


def fewer(section: Section, corners: Array, apart: float) -> Array:
    """Return a path with one corner in place of two that are nearer than ``apart`` metres.

    The new corner is the intersection of the segments before and after the two. It replaces them only where
    it keeps the bounds.

    corners : shape (K, 2), as of the section
    """
    line = [(float(x), float(z)) for x, z in corners]
    k = 1
    while k + 2 < len(line):
        met = _meet(line[k - 1 : k + 3]) if line[k + 1][0] - line[k][0] < apart else None
        if met is not None and _passes(section, [line[k - 1], met, line[k + 2]]):
            line[k : k + 2] = [met]
            k = max(1, k - 1)
        else:
            k += 1
    return np.array(line)


def cut(corners: Array, most: float) -> Array:
    """Return a path with additional corners, at most ``most`` metres apart along it.

    corners : shape (K, 2), as of a section
    """
    parts = [
        np.linspace(a, b, int(np.ceil((b[0] - a[0]) / most)) + 1)[:-1] if b[0] - a[0] > most else a[None]
        for a, b in pairwise(corners)
    ]
    return np.concatenate([*parts, corners[-1:]])


def _meet(four: list[tuple[float, float]]) -> tuple[float, float] | None:
    """Return where the line through the first two of four points meets that of the others, between these."""
    (x0, z0), (x1, z1), (x2, z2), (x3, z3) = four
    first, last = (z1 - z0) / (x1 - x0), (z3 - z2) / (x3 - x2)
    if first == last:
        return None
    x = (z2 - z0 + first * x0 - last * x2) / (first - last)
    return (x, z0 + first * (x - x0)) if x1 <= x <= x2 else None


def _passes(section: Section, line: list[tuple[float, float]]) -> bool:
    x, z = np.array(line).T
    part = slice(*np.searchsorted(section.along, [x[0], x[-1]], side="right"))
    height = np.interp(section.along[part], x, z)
    return bool(((height >= section.low[part] - 1e-9) & (height <= section.high[part] + 1e-9)).all())
