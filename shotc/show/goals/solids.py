"""Balls, boxes and rings: points of their volumes, surfaces and edges."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors
from shotc.ir.show import Box, Sphere, Torus
from shotc.show.goals.body import Fill, upright_axes


@dataclass(frozen=True, slots=True, eq=False)
class SolidBody:
    """A solid with its own axes, the rows of a (3, 3) matrix."""

    source: Sphere | Box | Torus
    axes: Array

    def draw(self, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
        """Return points (M, 3); None for the outline of a solid other than a box, which alone has edges."""
        local = _drawn(self.source, fill, count, rng)
        return None if local is None else np.array(self.source.centre) + local @ self.axes

    def encloses(self, place: Array) -> bool:
        """Tell whether a place (3,) is inside."""
        x, y, z = self.axes @ (place - np.array(self.source.centre))
        if isinstance(self.source, Sphere):
            return bool(x * x + y * y + z * z < self.source.radius**2)
        if isinstance(self.source, Torus):
            return bool((np.hypot(x, y) - self.source.radius) ** 2 + z * z < self.source.tube**2)
        return bool(np.all(np.abs([x, y, z]) < np.array(self.source.size) / 2.0))

    def colors(self, places: Array) -> Colors | None:
        """Return None for places (M, 3): the mission sets the colour."""
        return None


def solid_body(source: Sphere | Box | Torus) -> SolidBody:
    """Return the body of a built-in solid."""
    if isinstance(source, Sphere):
        return SolidBody(source, np.eye(3))
    right, ahead, up = upright_axes(source.heading)
    if isinstance(source, Box):
        return SolidBody(source, np.array([right, ahead, up]))
    axis = np.sin(source.tilt) * ahead + np.cos(source.tilt) * up
    return SolidBody(source, np.array([right, np.cross(axis, right), axis]))


def _drawn(source: Sphere | Box | Torus, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
    if isinstance(source, Box):
        return _of_box(np.array(source.size), fill, count, rng)
    if fill == "outline":
        return None
    if isinstance(source, Torus):
        return _of_torus(source, fill, count, rng)
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    reach = rng.random(count) ** (1.0 / 3.0) if fill == "volume" else np.ones(count)
    return np.asarray(source.radius * reach[:, None] * directions)


def _of_box(size: Array, fill: Fill, count: int, rng: np.random.Generator) -> Array:
    """Return points of the volume, of the faces by their areas, or of the edges by their lengths."""
    points = rng.random((count, 3)) - 0.5
    if fill != "volume":
        fixed, weight = _sides(size, fill)
        chosen = fixed[rng.choice(len(fixed), count, p=weight / weight.sum())]
        points = np.where(np.isnan(chosen), points, chosen)
    return np.asarray(points * size)


def _sides(size: Array, fill: Fill) -> tuple[Array, Array]:
    # Faces have one coordinate fixed at a half, edges two; the others are free (NaN).
    axes = 1 if fill == "surface" else 2
    rows = [row for row in product((-0.5, 0.5, np.nan), repeat=3) if np.sum(~np.isnan(row)) == axes]
    fixed = np.array(rows)
    return fixed, np.where(np.isnan(fixed), size, 1.0).prod(axis=1)


def _of_torus(source: Torus, fill: Fill, count: int, rng: np.random.Generator) -> Array:
    """Return points of the ring, uniform in volume or surface: of random places around the tube, outer ones
    are kept more often.
    """
    points = np.zeros((0, 2))
    while len(points) < count:
        round_tube = 2.0 * np.pi * rng.random(2 * count)
        depth = source.tube * (np.sqrt(rng.random(2 * count)) if fill == "volume" else np.ones(2 * count))
        out = depth * np.cos(round_tube)
        often = rng.random(2 * count) * (source.radius + source.tube) < source.radius + out
        points = np.concatenate([points, np.column_stack([out, depth * np.sin(round_tube)])[often]])
    out, up = points[:count].T
    turn = 2.0 * np.pi * rng.random(count)
    reach = source.radius + out
    return np.column_stack([reach * np.cos(turn), reach * np.sin(turn), up])
