"""Targets by the language guide alone: cylinders, boxes that turn with their course, and groups of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.quantities import number
from tests.support.second_opinion.solids import Cylinder

RIM = 180  # points of a rim; between two of them it bulges by 1.5e-4 of the radius
STILL = 0.1  # metres over the second before and the one after; what goes less keeps its course


class Size(NamedTuple):
    """A body: half its sides along and across of a box, else its radius; its height."""

    radius: float
    height: float
    half: tuple[float, float] | None = None

    @staticmethod
    def written(target: dict[str, Any]) -> Size:
        if "size" not in target:
            return Size(number(target["radius"]), number(target["height"]))
        length, width, height = (number(side) for side in target["size"])
        return Size(float(np.hypot(length, width)) / 2, height, (length / 2, width / 2))

    @property
    def ring(self) -> Array:
        """Return points round its foot, (K, 2), ahead and to the left."""
        if self.half is None:
            turn = np.linspace(0.0, 2 * np.pi, RIM, endpoint=False)
            return self.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * self.half


@dataclass(frozen=True)
class Target:
    """A body about its centre; ``velocity`` is that after the last row; facing : yaw at the rows, rad.

    parts : the bodies of a group, which stand
    """

    name: str
    size: Size
    times: Array
    points: Array
    velocity: Array
    facing: Array | None = None
    parts: tuple[Target, ...] = ()

    @property
    def height(self) -> float:
        return self.size.height

    def at(self, t: Array) -> Array:
        """Return its centre at times (M,), shape (M, 3)."""
        rows = np.stack([np.interp(t, self.times, part) for part in self.points.T], axis=1)
        return np.asarray(rows + np.maximum(t - self.times[-1], 0.0)[:, None] * self.velocity)

    def yaw(self, t: Array) -> Array:
        """Return where it faces at times (M,): as it is written, else the way that it goes."""
        if self.facing is not None:
            return np.interp(t, self.times, self.facing)
        way = self.at(t + 1.0) - self.at(t - 1.0)
        yaw = np.arctan2(way[:, 1], way[:, 0])
        slow = np.hypot(way[:, 0], way[:, 1]) < STILL
        yaw[slow] = [self._last_way(float(time)) for time in t[slow]]
        return np.asarray(yaw)

    def _last_way(self, t: float) -> float:
        """Return the way of the last stretch that it went by a time, else of the first that it will go."""
        ends = np.append(self.times, self.times[-1] + 1.0)
        places = np.vstack([self.points, self.points[-1] + self.velocity])
        ways = [
            (start, np.arctan2(*(b - a)[1::-1]))
            for start, a, b in zip(ends[:-1], places[:-1], places[1:], strict=True)
            if np.hypot(*(b - a)[:2]) > 1e-6
        ]
        gone = [way for start, way in ways if start <= t]
        return float(gone[-1] if gone else ways[0][1] if ways else np.pi / 2)

    def outline(self, t: Array) -> Array:
        """Return points whose hull it is, at times (M,), shape (M, K, 3)."""
        if self.parts:
            return np.concatenate([part.outline(t) for part in self.parts], axis=1)
        yaw, ring, centre = self.yaw(t)[:, None], self.size.ring, self.at(t)[:, None]
        if self.size.half is None:
            yaw = np.zeros_like(yaw)
        x = ring[:, 0] * np.cos(yaw) - ring[:, 1] * np.sin(yaw)
        y = ring[:, 0] * np.sin(yaw) + ring[:, 1] * np.cos(yaw)
        up = np.full_like(x, self.size.height / 2)
        return np.concatenate([centre + np.stack([x, y, z], axis=-1) for z in (up, -up)], axis=1)

    def room(self, p: Array, t: Array) -> Array:
        """Return how far places (M, 3) are at times (M,) from what clearances count from.

        That is the body, and of a box that does not go one way only the cylinder about it.
        """
        if self.size.half is None or not self.turns:
            return self.distance(p[:, None], t)[:, 0]
        at, up = self.at(t), self.size.height / 2
        return Cylinder(at[:, :2], self.size.radius, at[:, 2] - up, at[:, 2] + up).distance(p)

    @property
    def turns(self) -> bool:
        """Whether it faces another way at one time than at another."""
        if self.facing is not None:
            return bool(np.ptp(self.facing) > 0)
        ways = np.diff(np.vstack([self.points, self.points[-1] + self.velocity]), axis=0)[:, :2]
        ways = ways[np.linalg.norm(ways, axis=1) > 1e-9]
        if not len(ways):
            return self.moves
        ways = ways / np.linalg.norm(ways, axis=1)[:, None]
        return bool((ways @ ways[0] < 1 - 1e-12).any())

    def distance(self, p: Array, t: Array) -> Array:
        """Return how far places (M, K, 3) are outside of the body at times (M,), shape (M, K)."""
        away, yaw = p - self.at(t)[:, None], self.yaw(t)[:, None]
        beyond = np.abs(away[..., 2]) - self.size.height / 2
        if self.size.half is None:
            aside = np.hypot(away[..., 0], away[..., 1]) - self.size.radius
        else:
            along = np.abs(away[..., 0] * np.cos(yaw) + away[..., 1] * np.sin(yaw)) - self.size.half[0]
            across = np.abs(away[..., 1] * np.cos(yaw) - away[..., 0] * np.sin(yaw)) - self.size.half[1]
            out = np.hypot(np.maximum(along, 0.0), np.maximum(across, 0.0))
            aside = np.where(out > 0, out, np.maximum(along, across))
        out = np.hypot(np.maximum(aside, 0.0), np.maximum(beyond, 0.0))
        return np.where(out > 0, out, np.maximum(aside, beyond))

    @property
    def moves(self) -> bool:
        return len(self.times) > 1 or bool(self.velocity.any())


def group(name: str, parts: list[Target]) -> Target:
    """Return bodies that stand as one, about the middle of the box round them all."""
    cloud = np.concatenate([part.outline(np.zeros(1))[0] for part in parts])
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    size = Size(float(np.hypot(*(high - low)[:2])) / 2, float(high[2] - low[2]))
    return Target(name, size, np.zeros(1), (low + high)[None] / 2, np.zeros(3), parts=tuple(parts))


def touch(a: Target, b: Target, t: Array) -> Array:
    """Tell when two bodies overlap or touch at times (M,): no direction parts them."""
    away = a.at(t) - b.at(t)
    upright = np.abs(away[:, 2]) - 0.5 * (a.size.height + b.size.height)
    near = np.hypot(away[:, 0], away[:, 1]) <= a.size.radius + b.size.radius + 1e-3
    found = near & (upright <= 1e-9)
    found[found] = _overlap(a, b, t[found])
    return np.asarray(found)


def _overlap(a: Target, b: Target, t: Array) -> Array:
    """Tell when the floor plans of two bodies overlap or touch."""
    level = np.linspace(0.0, np.pi, 721)
    axes = np.stack([np.cos(level), np.sin(level)])
    one, other = (body.outline(t)[..., :2] @ axes for body in (a, b))
    apart = np.maximum(one.min(axis=1) - other.max(axis=1), other.min(axis=1) - one.max(axis=1)).max(axis=1)
    return np.asarray(apart <= 1e-3)
