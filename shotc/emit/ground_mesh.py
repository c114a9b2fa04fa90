"""Ground as one mesh whose triangles share their corners, so that it is shaded smoothly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array


@dataclass(frozen=True, slots=True, eq=False)
class GroundMesh:
    """Corners (V, 3) and their unit normals (V, 3), W; triangles as three numbers of corners, (T, 3)."""

    corners: NDArray[np.float32]
    normals: Array
    faces: NDArray[np.uint32]


def mesh_of(triangles: Array) -> GroundMesh:
    """Return triangles (T, 3, 3) as a mesh; a normal is the mean of those about its corner, by area.

    All triangles lie counter-clockwise after this, seen from above.
    """
    flat = triangles.reshape(-1, 3).astype(np.float32)
    # Ground has one height at a place: corners are the same where x and y are.
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
