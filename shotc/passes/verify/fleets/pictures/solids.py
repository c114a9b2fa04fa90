"""Balls, cubes and rings as figures: their inside, their surface, or a cube's edges."""

from __future__ import annotations

from itertools import product
from math import pi, sqrt
from typing import Literal

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.show import Box, Sphere, Torus
from shotc.passes.verify.fleets.pictures.figure import Figure, evenly, turned

Fill = Literal["volume", "surface", "outline"]

POINTS_ACROSS = 24
"""Points across a shape."""


def solid_figure(source: Sphere | Box | Torus, fill: Fill) -> Figure:
    """Return a solid, filled as a picture asks."""
    if isinstance(source, Sphere):
        return _ball(source, fill)
    return _box(source, fill) if isinstance(source, Box) else _ring(source, fill)


def _ball(ball: Sphere, fill: Fill) -> Figure:
    centre, radius = np.array(ball.centre), ball.radius

    def out(places: Array) -> Array:
        return np.asarray(np.linalg.norm(places - centre, axis=1) - radius)

    if fill == "volume":
        points = _cells((2 * radius, 2 * radius, 2 * radius), POINTS_ACROSS)
        points = points[np.linalg.norm(points, axis=1) <= radius]
        volume = 4.0 / 3.0 * pi * radius**3
        return Figure(
            centre + points,
            evenly(len(points)),
            lambda p: np.maximum(out(p), 0.0),
            lambda n: (volume / n) ** (1 / 3),
        )
    # A spiral of equal steps in height has equal areas between its turns (Archimedes).
    number = 4 * POINTS_ACROSS * POINTS_ACROSS
    height = 1.0 - (2.0 * np.arange(number) + 1.0) / number
    around = pi * (1.0 + sqrt(5.0)) * np.arange(number)
    level = np.sqrt(1.0 - height**2)
    points = radius * np.column_stack([level * np.cos(around), level * np.sin(around), height])
    area = 4.0 * pi * radius**2
    return Figure(centre + points, evenly(number), lambda p: np.abs(out(p)), lambda n: sqrt(area / n))


def _box(box: Box, fill: Fill) -> Figure:
    centre, axes, half = np.array(box.centre), turned(box.heading), np.array(box.size) / 2.0

    def off(places: Array) -> Array:
        """Distance from the inside, the faces or the edges: that of the 0, 1 or 2 nearest pairs of sides."""
        beyond = np.abs((places - centre) @ axes.T) - half
        near = np.sort(beyond, axis=1)[:, ::-1]
        bound = {"volume": 0, "surface": 1, "outline": 2}[fill]
        # Of the sides that bind, the distance counts from within as well.
        held = np.where(np.arange(3) < bound, near, np.maximum(near, 0.0))
        return np.asarray(np.linalg.norm(held, axis=1))

    if fill == "volume":
        local = _cells(box.size, POINTS_ACROSS)
        measure, power = float(np.prod(box.size)), 1 / 3
    else:
        fixed = 1 if fill == "surface" else 2
        sides = [s for s in product((-1.0, 1.0, 0.0), repeat=3) if sum(map(abs, s)) == fixed]
        step = max(box.size) / POINTS_ACROSS
        local = np.concatenate([_side(half, np.array(side), step) for side in sides])
        measure = sum(float(np.prod(np.where(np.array(s) == 0.0, box.size, 1.0))) for s in sides)
        power = 1.0 / (3 - fixed)
    return Figure(centre + local @ axes, evenly(len(local)), off, lambda n: (measure / n) ** power)


def _side(half: Array, side: Array, step: float) -> Array:
    """Return points of a face or an edge; side : -1 or 1 for the coordinates that are fixed, else 0."""
    counts = [1 if s else max(1, round(2.0 * h / step)) for s, h in zip(side, half, strict=True)]
    free = [np.array([s * h]) if s else _middles(h, n) for s, h, n in zip(side, half, counts, strict=True)]
    return np.stack(np.meshgrid(*free, indexing="ij"), axis=-1).reshape(-1, 3)


def _ring(ring: Torus, fill: Fill) -> Figure:
    right, ahead, up = turned(ring.heading)
    axis = np.sin(ring.tilt) * ahead + np.cos(ring.tilt) * up
    axes = np.array([right, np.cross(axis, right), axis])
    centre, radius, tube = np.array(ring.centre), ring.radius, ring.tube

    def off(places: Array) -> Array:
        x, y, z = ((places - centre) @ axes.T).T
        deep = np.hypot(np.hypot(x, y) - radius, z) - tube
        return np.asarray(np.maximum(deep, 0.0) if fill == "volume" else np.abs(deep))

    across = _disc(tube) if fill == "volume" else _circle(tube, 16)
    around = 2.0 * pi * (np.arange(4 * POINTS_ACROSS) + 0.5) / (4 * POINTS_ACROSS)
    out = radius + across[:, 0]
    high = np.tile(across[:, 1], (len(around), 1))
    local = np.stack([np.outer(np.cos(around), out), np.outer(np.sin(around), out), high], axis=-1)
    # What is farther out goes a longer way round (Pappus).
    weights = np.tile(out / out.sum() / len(around), len(around))
    whole, power = 2.0 * pi * radius, 1 / 3 if fill == "volume" else 1 / 2
    measure = whole * (pi * tube**2 if fill == "volume" else 2.0 * pi * tube)

    def part(n: int) -> float:
        """Where the ring is thin, its drones stand in a row along it."""
        return max(float((measure / n) ** power), whole / n)

    return Figure(centre + local.reshape(-1, 3) @ axes, weights, off, part)


def _disc(radius: float) -> Array:
    """Return points of a disc, (M, 2)."""
    axis = _middles(radius, 8)
    points = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(points[np.linalg.norm(points, axis=1) <= radius])


def _circle(radius: float, number: int) -> Array:
    angle = 2.0 * pi * (np.arange(number) + 0.5) / number
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _cells(size: tuple[float, float, float], across: int) -> Array:
    """Return the middles of the cells of a box about the origin."""
    axes = [_middles(length / 2.0, across) for length in size]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _middles(half: float, number: int) -> Array:
    return np.asarray(half * ((2.0 * np.arange(number) + 1.0) / number - 1.0))
