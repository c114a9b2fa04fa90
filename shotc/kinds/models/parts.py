"""The parts of a mesh or a point cloud, in the coordinates of the file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray

Colors = NDArray[np.uint8]


class ModelFault(NamedTuple):
    """The fault of a model file, with help; line : of the file, from 1, if one line has the fault."""

    message: str
    help: str = "export it anew as binary PLY"
    line: int | None = None
    library: str = ""
    """The missing library for its format."""


@dataclass(frozen=True, slots=True, eq=False)
class NodePart:
    """The part at one node of a file.

    name      : of the node; empty if the file has none
    corners   : shape (V, 3), with all transforms of the file applied
    triangles : shape (T, 3), indices of corners; T = 0 for a point cloud
    colors    : shape (V, 3), or None
    """

    name: str
    corners: Array
    triangles: IntArray
    colors: Colors | None = None


def part(name: str, corners: Any, triangles: Any = None, colors: Colors | None = None) -> NodePart:
    """Return a part with arrays of our own types from a library's arrays."""
    faces = np.zeros((0, 3), np.intp) if triangles is None else np.asarray(triangles, np.intp).reshape(-1, 3)
    return NodePart(name, np.asarray(corners, dtype=np.float64).reshape(-1, 3), faces, colors)


def table(lines: list[str], columns: tuple[int, ...]) -> Array:
    """Return columns of lines of numbers, (N, C); raise ValueError if a line has no number there."""
    return np.loadtxt(lines, usecols=columns, comments=None, ndmin=2)


def fans(rows: Any) -> IntArray:
    """Return polygons, given as rows of corner indices, as triangles (T, 3) with a common first corner."""
    if isinstance(rows, np.ndarray) and rows.ndim == 2:
        count = rows.shape[1]
        if count < 3:
            return np.zeros((0, 3), np.intp)
        cut = [np.column_stack([rows[:, 0], rows[:, k], rows[:, k + 1]]) for k in range(1, count - 1)]
        return np.stack(cut, axis=1).reshape(-1, 3).astype(np.intp)
    triangles = [(row[0], row[k], row[k + 1]) for row in rows for k in range(1, len(row) - 1)]
    return np.array(triangles, dtype=np.intp).reshape(-1, 3)


def wrong_corners(parts: list[NodePart], farthest: float) -> ModelFault | None:
    """Return the fault of parts without corners, with an invalid corner, or with a face of missing corners.

    farthest : the largest valid coordinate
    """
    count = sum(len(p.corners) for p in parts)
    if not count:
        return ModelFault("it holds no points", "export a mesh or a point cloud that holds something")
    lost = sum(int((~(np.abs(p.corners) < farthest).all(axis=1)).sum()) for p in parts)
    if lost:
        return ModelFault(f"{lost} of its {count} points have no finite place")
    for p in parts:
        if len(p.triangles) and not (p.triangles.min() >= 0 and p.triangles.max() < len(p.corners)):
            return ModelFault("a face names a corner that is not there")
    return None
