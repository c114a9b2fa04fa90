"""Missions of keyframes in random villages, each keyframe where all of its target is seen."""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
import trimesh

from shotc.geom.bernstein import Array
from shotc.geom.surface.boards import upright
from shotc.geom.surface.near import nearest
from shotc.geom.surface.occlusion import hidden
from shotc.geom.surface.tree import Surface, surface_of
from tests.support.scenes import some_scene

SQUARE_M = 18.0
"""Metres about the target in which nothing else stands."""
AWAY_M = 2.8
"""Metres from triangles that keyframes keep at least: the clearance, the body's radius and a margin."""
DISTANCE = (1.3, 2.6)
"""Times the distance at which the target just fits."""
HFOV, ASPECT = radians(70), 16 / 9
HOME = (-62.0, -58.0)
SCENE_FILE = "village.ply"


class Film(NamedTuple):
    """A mission, and the triangles of its scene, (N, 3, 3)."""

    text: str
    triangles: Array


def some_film(random: np.random.Generator) -> Film:
    """Return a film of a monument on the square of a village, by three to five keyframes."""
    triangles = some_scene(random, SQUARE_M).triangles
    surface = surface_of(triangles)
    radius, height = (round(float(random.uniform(*b)), 2) for b in ((0.5, 2.5), (3.0, 14.0)))
    composition = str(random.choice(["center", "thirds"]))
    azimuth, turn = random.uniform(0, 2 * pi), random.choice([-1.0, 1.0])
    rows = []
    for _ in range(int(random.integers(3, 6))):
        place = _seeing(random, surface, (radius, height), azimuth)
        azimuth += turn * radians(random.uniform(25.0, 70.0))
        if place is not None:
            rows.append(f"{{at: [{', '.join(f'{c:.2f}' for c in place)}], look_at: monument}}")
    if len(rows) < 2:
        return some_film(random)
    return Film(_text((radius, height), composition, rows), triangles)


def ply(triangles: Array) -> bytes:
    """Return triangles as a file."""
    mesh = trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    data = mesh.export(file_type="ply")
    assert isinstance(data, bytes)
    return data


def _seeing(
    random: np.random.Generator, surface: Surface, size: tuple[float, float], azimuth: float
) -> Array | None:
    """Return a place about a bearing from which nothing hides the target; None where none is drawn."""
    radius, height = size
    tall = radius + height / 2 / (tan(HFOV / 2) / ASPECT)
    fits = max(tall, radius / sin(HFOV / 2))
    for _ in range(40):
        distance, bearing = max(8.0, fits * random.uniform(*DISTANCE)), azimuth + random.normal(0.0, 0.3)
        z = max(3.0, height * random.uniform(0.3, 1.3))
        level = sqrt(max(distance**2 - (z - height / 2) ** 2, 36.0))
        eye = np.array([[level * cos(bearing), level * sin(bearing), z]])
        boards = upright(eye, np.array([[0.0, 0.0, height / 2]]), radius, height)
        if float(nearest(surface, eye).distance[0]) > AWAY_M and not hidden(surface, boards).any():
            return np.asarray(eye[0])
    return None


def _text(size: tuple[float, float], composition: str, rows: list[str]) -> str:
    radius, height = size
    frames = "".join(f"      - {row}\n" for row in rows)
    return (
        "shotc: 1\nmission: square\n"
        f"world: {{scene: {{file: {SCENE_FILE}, units: m}}}}\n"
        f"targets: {{monument: {{at: [0, 0, {height / 2}], radius: {radius}, height: {height}}}}}\n"
        f"drones: {{cam: {{model: x500, home: [{HOME[0]}, {HOME[1]}, 0]}}}}\n"
        f"shots:\n  - id: film\n    kind: keyframes\n    drone: cam\n    target: monument\n"
        f"    composition: {composition}\n    keyframes:\n{frames}"
        "output: {rate: 10}\n"
    )
