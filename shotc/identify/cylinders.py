"""The least vertical cylinder around points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from shotc.geom.bernstein import Array
from shotc.geom.vec import Vec2

TO_GROUND_M = 3.0
"""Height above ground, metres, below which visible points are taken to reach the ground."""
ROUNDING_RATIO = 1.0 + 1e-9


class Circle(NamedTuple):
    """A circle in the plan, metres."""

    centre: Vec2
    radius: float

    def holds(self, point: Array) -> bool:
        """Return whether a point (2,) is inside, up to rounding."""
        return bool(np.hypot(*(point - self.centre)) <= self.radius * ROUNDING_RATIO + 1e-12)


class Upright(NamedTuple):
    """A vertical cylinder, W, metres."""

    centre: Vec2
    radius: float
    bottom: float
    top: float

    @property
    def height(self) -> float:
        """Height, metres."""
        return self.top - self.bottom

    @property
    def middle(self) -> tuple[float, float, float]:
        """The centre of its axis."""
        return (*self.centre, 0.5 * (self.bottom + self.top))

    @property
    def described(self) -> str:
        """Its position and size in words."""
        x, y, z = self.middle
        return f"about [{x:.1f}, {y:.1f}, {z:.1f}], radius {self.radius:.1f} m, height {self.height:.1f} m"


def enclosing(points: Array, ground: float) -> Upright:
    """Return the least cylinder around points (P, 3).

    ground : z of the ground below them, metres
    """
    return upright(least_circle(points[:, :2]), points, ground)


def upright(circle: Circle, points: Array, ground: float) -> Upright:
    """Return a cylinder over a circle, as high as points (P, 3), from the ground if they are near it."""
    bottom, top = float(points[:, 2].min()), float(points[:, 2].max())
    return Upright(circle.centre, circle.radius, ground if bottom < ground + TO_GROUND_M else bottom, top)


def least_circle(points: Array) -> Circle:
    """Return the smallest circle around points (P, 2), metres, by Welzl's algorithm on the corners of their
    hull.

    E. Welzl, Smallest enclosing disks (1991), without recursion; the points are ordered by distance from the
    middle.
    """
    corners = outermost(points)
    corners = corners[np.argsort(-np.linalg.norm(corners - corners.mean(axis=0), axis=1), kind="stable")]
    circle = Circle(_pair(corners[0]), 0.0)
    for i, p in enumerate(corners):
        if circle.holds(p):
            continue
        circle = Circle(_pair(p), 0.0)
        for j, q in enumerate(corners[:i]):
            if circle.holds(q):
                continue
            circle = _about(p, q)
            for r in corners[:j]:
                if not circle.holds(r):
                    circle = _through(p, q, r)
    return circle


def outermost(points: Array) -> Array:
    """Return the corners of the hull of points (P, 2); the two ends if they lie on a line."""
    if len(points) > 3:
        try:
            return np.asarray(points[ConvexHull(points).vertices])
        except QhullError:  # the points lie on a line
            order = np.lexsort((points[:, 1], points[:, 0]))
            return np.asarray(points[[order[0], order[-1]]])
    return points


def _pair(point: Array) -> Vec2:
    return (float(point[0]), float(point[1]))


def _about(p: Array, q: Array) -> Circle:
    return Circle(_pair(0.5 * (p + q)), 0.5 * float(np.linalg.norm(p - q)))


def _through(p: Array, q: Array, r: Array) -> Circle:
    """Return the circle through three points; for points on a line, the one about the farthest two."""
    a, b = q - p, r - p
    twice = 2.0 * float(a[0] * b[1] - a[1] * b[0])
    if abs(twice) < 1e-12 * max(float(a @ a), float(b @ b), 1e-300):
        return max((_about(p, q), _about(p, r), _about(q, r)), key=lambda c: c.radius)
    centre = np.array([b[1] * (a @ a) - a[1] * (b @ b), a[0] * (b @ b) - b[0] * (a @ a)]) / twice
    return Circle(_pair(p + centre), float(np.linalg.norm(centre)))
