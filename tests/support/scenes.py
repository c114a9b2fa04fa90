"""Scenes of triangles for tests: gable houses, trees, walls with an arch; and ways through them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array

SIZE_M = 80.0


class Scene(NamedTuple):
    """Triangles (N, 3, 3) on the ground z = 0, and the two ends of a way through them, (3,) each."""

    triangles: Array
    start: Array
    end: Array


def quad(a, b, c, d) -> Array:
    """Two triangles of a plane face."""
    return np.array([[a, b, c], [a, c, d]], dtype=np.float64)


def fine(triangles: Array, times: int) -> Array:
    """Every triangle cut in four, some times."""
    for _ in range(times):
        a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        triangles = np.concatenate([np.stack(part, axis=1) for part in parts])
    return triangles


def turned(triangles: Array, angle: float, at) -> Array:
    """Triangles turned about the vertical, and moved in the plan."""
    c, s = np.cos(angle), np.sin(angle)
    return triangles @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + np.array([at[0], at[1], 0.0])


def house(width: float, depth: float, eaves: float, ridge: float) -> Array:
    """A house with a gable roof about the origin, its floor on z = 0."""
    x, y = 0.5 * width, 0.5 * depth
    low = [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)]
    high = [(px, py, eaves) for px, py, _ in low]
    top = [(-x, 0, ridge), (x, 0, ridge)]
    walls = [quad(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
    roof = [quad(high[0], high[1], top[1], top[0]), quad(high[2], high[3], top[0], top[1])]
    gables = np.array([[high[3], high[0], top[0]], [high[1], high[2], top[1]]], dtype=np.float64)
    return np.concatenate([*walls, *roof, gables, quad(*low)])


def cone(radius: float, bottom: float, top: float, corners: int = 12) -> Array:
    """A tree: a cone on a thin trunk."""
    turn = np.linspace(0.0, 2 * np.pi, corners + 1)
    rim = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(corners + 1, bottom)])
    tip, foot, low = np.array([0.0, 0.0, top]), np.array([0.0, 0.0, bottom]), np.zeros(3)
    sides = [np.array([rim[i], rim[i + 1], tip]) for i in range(corners)]
    under = [np.array([rim[i + 1], rim[i], foot]) for i in range(corners)]
    trunk = np.array([[0.2, 0.0, bottom], [-0.2, 0.0, bottom], low])
    return np.stack([*sides, *under, trunk])


def arch_wall(length: float, height: float, gate: float, tall: float) -> Array:
    """A wall along y with a gate in its middle that is ``gate`` wide and ``tall`` high."""
    y, g, thick = 0.5 * length, 0.5 * gate, 0.4

    def box(y0: float, y1: float, z0: float, z1: float) -> Array:
        low = [(-thick, y0, z0), (thick, y0, z0), (thick, y1, z0), (-thick, y1, z0)]
        high = [(px, py, z1) for px, py, _ in low]
        sides = [quad(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
        return np.concatenate([*sides, quad(*low), quad(*high)])

    return np.concatenate([box(-y, -g, 0, height), box(g, y, 0, height), box(-g, g, tall, height)])


def some_scene(random: np.random.Generator, square: float = 0.0) -> Scene:
    """A village of 80 m, one in four of them with a wall between the ends of the way.

    square : metres about its middle in which no house or tree stands; the wall is beside it
    """
    parts = []
    for _ in range(int(random.integers(8, 22))):
        at, turn = random.uniform(-0.5, 0.5, 2) * SIZE_M, random.uniform(0.0, np.pi)
        eaves = random.uniform(3.0, 9.0)
        made = house(random.uniform(6, 14), random.uniform(6, 12), eaves, eaves + random.uniform(1.5, 4.0))
        if np.hypot(*at) >= square:
            parts.append(turned(fine(made, 2), turn, at))
    for _ in range(int(random.integers(5, 25))):
        at, bottom = random.uniform(-0.5, 0.5, 2) * SIZE_M, random.uniform(1.0, 3.0)
        made = cone(random.uniform(1.5, 4.0), bottom, bottom + random.uniform(5.0, 14.0))
        if np.hypot(*at) >= square:
            parts.append(turned(fine(made, 1), 0.0, at))
    if random.uniform() < 0.25:
        wall = arch_wall(random.uniform(60, 120), random.uniform(12, 25), random.uniform(6, 10), 9.0)
        parts.append(turned(fine(wall, 2), random.uniform(-0.3, 0.3), (square, random.uniform(-5, 5))))
    start = np.array([-52.0, random.uniform(-30, 30), random.uniform(3.5, 12.0)])
    end = np.array([52.0, random.uniform(-30, 30), random.uniform(3.5, 12.0)])
    return Scene(np.concatenate(parts), start, end)
