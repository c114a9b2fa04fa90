"""Distances of points from upright solids: cylinders and prisms, negative inside."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tests.support.second_opinion.flight import Array


class Cylinder(NamedTuple):
    """An upright cylinder; its axis may be given for every point, shape (M, 2)."""

    centre: Array
    radius: float
    bottom: Array | float
    top: Array | float

    def distance(self, p: Array) -> Array:
        """Return how far points (M, 3) are outside, shape (M,)."""
        aside = np.hypot(p[:, 0] - self.centre[..., 0], p[:, 1] - self.centre[..., 1]) - self.radius
        return _both(aside, _beyond(p[:, 2], self.bottom, self.top))

    def depth(self, p: Array) -> Array:
        """Return how far points are from all of the outside, negative outside: of spheres that stay in."""
        aside = self.radius - np.hypot(p[:, 0] - self.centre[..., 0], p[:, 1] - self.centre[..., 1])
        return np.minimum(aside, -_beyond(p[:, 2], self.bottom, self.top))


class Prism(NamedTuple):
    """An upright prism over a simple polygon (K, 2), which need not be convex."""

    points: Array
    bottom: float
    top: float

    def distance(self, p: Array) -> Array:
        """Return how far points (M, 3) are outside, shape (M,)."""
        return _both(self._aside(p), _beyond(p[:, 2], self.bottom, self.top))

    def depth(self, p: Array) -> Array:
        """Return how far points are from all of the outside, negative outside."""
        return np.minimum(-self._aside(p), -_beyond(p[:, 2], self.bottom, self.top))

    def _aside(self, p: Array) -> Array:
        a, b = self.points, np.roll(self.points, -1, axis=0)
        along = b - a
        away = p[:, None, :2] - a
        share = np.clip((away * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
        near = np.linalg.norm(away - share[..., None] * along, axis=2).min(axis=1)
        x, y = p[:, 0][:, None], p[:, 1][:, None]
        spans = (a[:, 1] > y) != (b[:, 1] > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        within = (spans & (x < crossing)).sum(axis=1) % 2 == 1
        return np.where(within, -near, near)


Solid = Cylinder | Prism


def _beyond(z: Array, bottom: Array | float, top: Array | float) -> Array:
    return np.maximum(bottom - z, z - top)


def _both(aside: Array, beyond: Array) -> Array:
    outside = np.hypot(np.maximum(aside, 0.0), np.maximum(beyond, 0.0))
    return np.where((aside > 0) | (beyond > 0), outside, np.maximum(aside, beyond))
