"""Solid bodies for goal sets: unions of balls, capsules and boxes, and points drawn evenly in them.

Metres, z up; who walks looks along x.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from shotc.geom.bernstein import Array

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Limb:
    """A capsule, or with ``squash`` an ellipsoid about its first end: half axes radius times squash."""

    one: Point
    other: Point
    radius: float
    squash: Point | None = None

    def holds(self, points: Array) -> Array:
        """Tell which points (M, 3) are inside."""
        one = np.array(self.one)
        if self.squash is not None:
            return np.asarray(np.linalg.norm((points - one) / self.squash, axis=1) <= self.radius)
        way = np.array(self.other) - one
        share = np.clip((points - one) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        return np.asarray(np.linalg.norm(points - one - share[:, None] * way, axis=1) <= self.radius)


def drawn(limbs: tuple[Limb, ...], count: int, seed: int) -> Array:
    """Return points spread evenly over the union, shape (count, 3)."""
    rng = np.random.default_rng(seed)
    reach = [r * max(limb.squash or (1.0,)) for limb in limbs for r in (limb.radius,)]
    ends = np.array([[np.minimum(b.one, b.other) - r, np.maximum(b.one, b.other) + r]
                     for b, r in zip(limbs, reach, strict=True)])  # fmt: skip
    low, high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)
    found = np.empty((0, 3))
    while len(found) < count:
        some = rng.uniform(low, high, (4 * count, 3))
        inside = np.any([limb.holds(some) for limb in limbs], axis=0)
        found = np.concatenate([found, some[inside]])
    return np.asarray(found[:count])


def sphere(count: int, seed: int) -> Array:
    """Return points of the unit ball."""
    return drawn((Limb((0, 0, 0), (0, 0, 0), 1.0),), count, seed)


def cube(count: int, seed: int) -> Array:
    """Return points of a cube with half side 1."""
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3))


def human(count: int, seed: int, phase: float = 0.0) -> Array:
    """Return points of a human, 1.8 m tall, with arms and legs swung as at a phase of the walk (0 to 1)."""
    swing = 0.5 * sin(2 * pi * phase)
    limbs = [
        Limb((0, 0, 1.05), (0, 0, 1.38), 0.16),
        Limb((0, 0, 1.66), (0, 0, 1.68), 0.12),
    ]
    for side, turn in ((-1.0, swing), (1.0, -swing)):
        hip, shoulder = (0.0, 0.1 * side, 0.95), (0.0, 0.24 * side, 1.42)
        limbs += _bent(hip, turn, 0.44, 0.08, max(0.0, -turn))
        limbs += _bent(shoulder, -0.8 * turn, 0.3, 0.05, -0.3)
    return drawn(tuple(limbs), count, seed)


def _bent(joint: Point, angle: float, length: float, radius: float, bend: float) -> list[Limb]:
    """Return two capsules that hang from a joint, the lower one bent back; angles from the vertical."""
    x, y, z = joint
    middle = (x + length * sin(angle), y, z - length * cos(angle))
    lower = angle - bend
    end = (middle[0] + length * sin(lower), y, middle[2] - length * cos(lower))
    return [Limb(joint, middle, radius), Limb(middle, end, 0.85 * radius)]


def rhino(count: int, seed: int) -> Array:
    """Return points of something like a rhinoceros, 3.6 m long."""
    limbs = [
        Limb((0, 0, 1.1), (0, 0, 1.1), 0.62, (1.9, 0.95, 1.0)),
        Limb((1.45, 0, 1.05), (1.45, 0, 1.05), 0.34, (1.9, 0.9, 1.0)),
        Limb((2.0, 0, 1.1), (2.15, 0, 1.6), 0.07),
    ]
    limbs += [Limb((x, y, 0.75), (x, y, 0.16), 0.16) for x in (-0.7, 0.75) for y in (-0.34, 0.34)]
    return drawn(tuple(limbs), count, seed)
