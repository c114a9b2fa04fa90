"""Triangles of the ground and of solids, shaded for pictures and for files of the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid, triangles

POLYGON_SIDES = 48
LIGHT_RAD = np.radians(215.0)
"""Direction to the light, an angle in W, rad."""


@dataclass(frozen=True, slots=True, eq=False)
class GroundMesh:
    """Corners (V, 3) in W, metres; their unit normals (V, 3); triangles as indices of corners, (T, 3)."""

    corners: NDArray[np.float32]
    normals: Array
    faces: NDArray[np.uint32]


def mesh_of(ground: Array) -> GroundMesh:
    """Return the triangles of the ground, (T, 3, 3), as one mesh, all counter-clockwise seen from above.

    Triangles share their corners, for smooth shading. The normal at a corner is the area-weighted mean of
    their normals.
    """
    flat = ground.reshape(-1, 3).astype(np.float32)
    # The ground has one height at each (x, y), so corners are equal where x and y are.
    place = np.ascontiguousarray(flat[:, :2] + np.float32(0.0)).view(np.uint64).ravel()
    _, first, number = np.unique(place, return_index=True, return_inverse=True)
    faces = number.reshape(-1, 3)
    across = np.cross(ground[:, 1] - ground[:, 0], ground[:, 2] - ground[:, 0])
    down = across[:, 2] < 0.0
    faces[down], across[down] = faces[down][:, ::-1], -across[down]
    normals = np.stack(
        [np.bincount(faces.ravel(), np.repeat(across[:, i], 3), len(first)) for i in range(3)], axis=1
    )
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    return GroundMesh(flat[first], normals / np.where(size > 0.0, size, 1.0), faces.astype(np.uint32))


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
