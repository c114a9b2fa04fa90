"""Triangles, grids and curves for tests of surfaces, and answers computed anew, without a tree."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.geom.bspline import IntArray


class Grid(NamedTuple):
    """Posts at (i, j) * step, and the triangles between them; corners (V, 3), faces (T, 3)."""

    heights: Array
    step: float
    corners: Array
    faces: IntArray

    @property
    def triangles(self) -> Array:
        return self.corners[self.faces]

    def height_at(self, x: Array, y: Array) -> Array:
        """The height by the cell that a point is in, cut from (i, j) to (i + 1, j + 1)."""
        u, v = x / self.step, y / self.step
        i = np.clip(np.floor(u).astype(int), 0, self.heights.shape[0] - 2)
        j = np.clip(np.floor(v).astype(int), 0, self.heights.shape[1] - 2)
        a, b, h = u - i, v - j, self.heights
        low, high = h[i, j], h[i + 1, j + 1]
        below = low + a * (h[i + 1, j] - low) + b * (high - h[i + 1, j])
        above = low + b * (h[i, j + 1] - low) + a * (high - h[i, j + 1])
        return np.where(a >= b, below, above)


def grid(heights: Array, step: float = 1.0) -> Grid:
    rows, columns = heights.shape
    x, y = np.meshgrid(np.arange(rows) * step, np.arange(columns) * step, indexing="ij")
    n = np.arange(heights.size).reshape(heights.shape)
    a, b, c, d = n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return Grid(heights, step, np.stack([x, y, heights], -1).reshape(-1, 3), faces)


def some_triangles(random: np.random.Generator, count: int) -> Array:
    """Triangles of many sizes that cross one another; needles, flat ones, points among them."""
    sizes = random.choice([0.05, 1.0, 5.0], size=(count, 1, 1))
    found = random.normal(size=(count, 1, 3)) * 5 + random.normal(size=(count, 3, 3)) * sizes
    kind = random.integers(0, 6, count)
    ends = found[:, :2]
    share = random.uniform(size=(count, 1))
    needle = ends[:, 0] + share * (ends[:, 1] - ends[:, 0])
    found[kind == 0, 2] = needle[kind == 0]
    found[kind == 1, 2] = needle[kind == 1] + 1e-6 * random.normal(size=needle[kind == 1].shape)
    found[kind == 2, :, 2] = 0.0
    found[kind == 3, 1] = found[kind == 3, 0]
    return found


def some_curve(random: np.random.Generator, pieces: int = 3) -> Piecewise:
    ctrl = random.normal(size=3) * 8 + random.normal(size=(pieces, 6, 3)) * 3
    ctrl[1:, 0] = ctrl[:-1, -1]
    return Piecewise(np.arange(pieces + 1.0), ctrl)


def orbit(radius: float, height: float, pieces: int = 40) -> Piecewise:
    """A circle, but for the error of its quintics."""
    turn = np.linspace(0.0, 2 * np.pi, pieces + 1)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(pieces + 1)]) * radius
    on = np.column_stack([-out[:, 1], out[:, 0], out[:, 2]])
    return quintic_hermite(turn, out + np.array([0.0, 0.0, height]), on, -out)


def line(a: tuple[float, float, float], b: tuple[float, float, float], pieces: int = 1) -> Piecewise:
    """A straight way from a to b at one speed, within 0 and 1."""
    x = np.linspace(0.0, 1.0, 5 * pieces + 1)[:, None]
    points = (1.0 - x) * np.array(a) + x * np.array(b)
    ctrl = np.stack([points[5 * k : 5 * k + 6] for k in range(pieces)])
    return Piecewise(np.linspace(0.0, 1.0, pieces + 1), ctrl)


def samples(curve: Piecewise, count: int) -> Array:
    """Points of a curve, (count, 3)."""
    return curve(np.linspace(curve.start, curve.end, count))


def distances(triangles: Array, points: Array) -> Array:
    """How far points (K, 3) are from the nearest of triangles (N, 3, 3), by all pairs."""
    p, a, b, c = points[:, None], triangles[:, 0], triangles[:, 1], triangles[:, 2]
    sides = ((a, b), (b, c), (c, a))
    best = np.minimum.reduce([_to_segments(u, v, p) for u, v in sides])
    normal = np.cross(b - a, c - a)
    square = (normal**2).sum(axis=1)
    height = ((p - a) * normal).sum(axis=2) / np.where(square > 1e-18, square, np.nan)
    foot = p - height[..., None] * normal
    inside = np.all([(np.cross(v - u, foot - u) * normal).sum(axis=2) >= 0 for u, v in sides], axis=0)
    over = np.where(inside, np.linalg.norm(p - foot, axis=2), np.inf)
    return np.minimum(best, over).min(axis=1)


def _to_segments(a: Array, b: Array, p: Array) -> Array:
    side = b - a
    share = np.clip(((p - a) * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-300), 0.0, 1.0)
    return np.linalg.norm(p - a - share[..., None] * side, axis=2)
