"""Missions over terrain: a relief as a table of posts, and the text of a mission that names it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from shotc.geom.bernstein import Array
from tests.support.surfaces import Grid, grid

STEP, SIDE = 10.0, 61
MIDDLE = 0.5 * STEP * (SIDE - 1)
"""Half of the side of a relief, whose middle is the origin of W, metres."""

HEAD = """\
shotc: 1
mission: hills
world:
  terrain: {file: relief.csv}
targets:
TARGETS
drones:
  cam: {model: x500, home: [0, 0, {above: ground, height: 0}]}
rules: {RULES}
shots:
  - {id: film, drone: cam, SHOT}
"""


def relief(seed: int = 1, height: float = 30.0) -> Grid:
    """Hills and a valley, of waves; posts at (i, j) * STEP."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    waves = sum(
        np.sin(2 * np.pi * (x * a + y * b) / SIDE + c) / (abs(a) + abs(b))
        for a, b, c in zip(*random.uniform(-3, 3, (2, 8)), random.uniform(0, 6, 8), strict=True)
    )
    return grid(np.round(height * np.asarray(waves), 2), STEP)


def cliff(height: float = 40.0, at: int = 34) -> Grid:
    """A plain, and a plateau one cell behind it."""
    heights = np.zeros((SIDE, SIDE))
    heights[at:] = height
    return grid(heights, STEP)


def under(shape: Grid, points: Array) -> Array:
    """The height of the ground under points of W, computed without a tree."""
    return shape.height_at(points[:, 0] + MIDDLE, points[:, 1] + MIDDLE)


def table(shape: Grid) -> str:
    rows = shape.corners - [MIDDLE, MIDDLE, 0.0]
    return "x,y,z\n" + "".join(f"{x:g},{y:g},{z:g}\n" for x, y, z in rows)


def write(folder: Path, shape: Grid, shot: str, targets: str, rules: str = "") -> Path:
    """Write a relief and a mission beside it; return the mission's path."""
    (folder / "relief.csv").write_text(table(shape))
    text = HEAD.replace("SHOT", shot).replace("TARGETS", targets).replace("RULES", rules)
    path = folder / "hills.yaml"
    path.write_text(text)
    return path
