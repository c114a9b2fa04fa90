"""Reads the meshes and point clouds of displays from PLY, OBJ, STL and GLB files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors
from shotc.kinds.models.mesh_file import read_mesh
from shotc.kinds.models.parts import ModelFault, NodePart, wrong_corners
from shotc.show.geom.columns import Numbers

Axis = Literal["x", "y", "z"]
UP: dict[str, Axis] = {"ply": "z", "obj": "y", "stl": "z", "glb": "y"}
"""The upward axis of each format, by the convention of modelling tools."""
TURNED: dict[Axis, list[int]] = {"x": [1, 2, 0], "y": [0, 2, 1], "z": [0, 1, 2]}
"""The file's axes that become East, North and Up; if y is up, North is reversed."""
LARGEST_COORDINATE = 1e9
"""A file with larger coordinates is broken, whatever its unit."""


@dataclass(frozen=True, slots=True, eq=False)
class ModelMesh:
    """Vertices (V, 3), triangles (T, 3) of their indices, none for a point cloud; colours (V, 3) or None."""

    corners: Array
    triangles: Numbers
    colors: Colors | None


@dataclass(frozen=True, slots=True)
class UnreadableModel:
    """Why a file is not a model, and what helps."""

    note: str
    help: str = "export it anew as binary PLY"


def read_model(name: str, data: bytes, up: Axis | None = None) -> ModelMesh | UnreadableModel:
    """Return a file's content in its own units, z up, with coinciding vertices merged.

    up : the upward axis of the file, None for that of its format
    """
    kind = name.rsplit(".", 1)[-1].lower()
    if kind not in UP:
        return UnreadableModel(
            f"`.{kind[:20]}` is no format that is read", "export it as .glb, .ply, .obj or .stl"
        )
    parts = read_mesh(kind, data)
    if isinstance(parts, list):
        wrong = wrong_corners(parts, LARGEST_COORDINATE)
        return _checked(_upright(_together(parts), up or UP[kind])) if wrong is None else _unreadable(wrong)
    return _unreadable(parts)


def _unreadable(fault: ModelFault) -> UnreadableModel:
    return UnreadableModel(fault.message, fault.help)


def _together(parts: list[NodePart]) -> ModelMesh:
    """Join the parts of a file; parts without colours are white if others have colours."""
    corners = np.concatenate([np.zeros((0, 3)), *(p.corners for p in parts)])
    offsets = np.cumsum([0, *(len(p.corners) for p in parts)])
    triangles = [p.triangles + offset for p, offset in zip(parts, offsets[:-1], strict=True)]
    colors = None
    if any(p.colors is not None for p in parts):
        white = [np.full((len(p.corners), 3), 255, np.uint8) if p.colors is None else p.colors for p in parts]
        colors = np.concatenate(white)
    return ModelMesh(corners, np.concatenate([np.zeros((0, 3), np.intp), *triangles]), colors)


def _upright(mesh: ModelMesh, up: Axis) -> ModelMesh:
    """Turn a file's coordinates so that z is up; triangles stay counter-clockwise as seen from outside."""
    corners = mesh.corners[:, TURNED[up]]
    if up == "y":
        corners = corners * np.array([1.0, -1.0, 1.0])
    return ModelMesh(corners, mesh.triangles, mesh.colors)


def _checked(mesh: ModelMesh) -> ModelMesh | UnreadableModel:
    if not np.ptp(mesh.corners, axis=0).max() > 0:
        return UnreadableModel("all of its points are at one place", "export a mesh that has a size")
    return _welded(mesh)


def _welded(mesh: ModelMesh) -> ModelMesh:
    """Merge vertices at the same place, because each face of an STL has its own; drop faces without area."""
    if not len(mesh.triangles):
        return mesh
    grain = 1e-8 * float(np.ptp(mesh.corners, axis=0).max())
    cells = np.round(mesh.corners / grain).astype(np.int64)
    _, first, number = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    triangles = number.reshape(-1)[mesh.triangles]
    a, b, c = triangles.T
    whole = triangles[(a != b) & (b != c) & (a != c)]
    colors = None if mesh.colors is None else mesh.colors[first]
    return ModelMesh(mesh.corners[first], whole, colors)
