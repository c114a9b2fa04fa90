"""Solids as shaded triangles, for pictures and files of the world."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid, triangles

POLYGON_SIDES = 48
LIGHT_RAD = np.radians(215.0)
"""Direction to the light, an angle in W, rad."""


class ShadedMesh(NamedTuple):
    """Triangles: vertices (n, 3), metres; indices of vertices (m, 3); lightness of each vertex (n,)."""

    points: Array
    faces: NDArray[np.uint32]
    light: Array


def solid_mesh(solid: Solid) -> ShadedMesh:
    """Return a solid as triangles, lit from the south-west.

    Faces share no vertices, so that each face has its own lightness.
    """
    if isinstance(solid, Cylinder):
        turn = np.linspace(0, 2 * np.pi, POLYGON_SIDES, endpoint=False)
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        corner = np.array(solid.centre) + solid.radius * ring
        lids = [(corner[0], corner[i], corner[i + 1]) for i in range(1, POLYGON_SIDES - 1)]
    else:
        corner = np.array(solid.points)
        lids = [(np.array(a), np.array(b), np.array(c)) for a, b, c in triangles(solid.points)]
    points: list[Array] = []
    light: list[float] = []
    low, high = np.array([solid.bottom]), np.array([solid.top])
    for a, b in zip(corner, np.roll(corner, -1, axis=0), strict=True):
        quad = [np.concatenate(v) for v in ((a, low), (b, low), (b, high), (a, high))]
        points += [quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]
        outward = np.arctan2(a[0] - b[0], b[1] - a[1])
        light += [0.95 + 0.3 * float(np.cos(outward - LIGHT_RAD))] * 6
    for a, b, c in lids:
        points += [np.concatenate((v, high)) for v in (a, b, c)]
        light += [1.4] * 3
        points += [np.concatenate((v, low)) for v in (c, b, a)]
        light += [0.5] * 3
    faces = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
    return ShadedMesh(np.array(points), faces, np.array(light))
