"""The ground as one mesh whose triangles share their corners, for smooth shading."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array


@dataclass(frozen=True, slots=True, eq=False)
class GroundMesh:
    """Corners (V, 3) in W, metres; their unit normals (V, 3); triangles as indices of corners, (T, 3)."""

    corners: NDArray[np.float32]
    normals: Array
    faces: NDArray[np.uint32]


def mesh_of(triangles: Array) -> GroundMesh:
    """Return triangles (T, 3, 3) as a mesh, all counter-clockwise seen from above.

    The normal at a corner is the area-weighted mean of the normals of its triangles.
    """
    flat = triangles.reshape(-1, 3).astype(np.float32)
    # The ground has one height at each (x, y), so corners are equal where x and y are.
    place = np.ascontiguousarray(flat[:, :2] + np.float32(0.0)).view(np.uint64).ravel()
    _, first, number = np.unique(place, return_index=True, return_inverse=True)
    faces = number.reshape(-1, 3)
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    down = across[:, 2] < 0.0
    faces[down], across[down] = faces[down][:, ::-1], -across[down]
    normals = np.stack(
        [np.bincount(faces.ravel(), np.repeat(across[:, i], 3), len(first)) for i in range(3)], axis=1
    )
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    return GroundMesh(flat[first], normals / np.where(size > 0.0, size, 1.0), faces.astype(np.uint32))
