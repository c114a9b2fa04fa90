"""What a mesh or a point cloud holds, part by part, in the coordinates of its file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray

Colors = NDArray[np.uint8]


class ModelFault(NamedTuple):
    """Why a file is no model, and what helps; line : of the file, from 1, where one is to blame."""

    message: str
    help: str = "export it anew as binary PLY"
    line: int | None = None
    library: str = ""
    """The library that its format takes and that is not installed."""


@dataclass(frozen=True, slots=True, eq=False)
class NodePart:
    """What stands at one node of a file.

    name      : of the node; empty where the file has none
    corners   : shape (V, 3), with all transforms of the file applied
    triangles : shape (T, 3), numbers of corners; none of a point cloud
    colors    : shape (V, 3), or None
    """

    name: str
    corners: Array
    triangles: IntArray
    colors: Colors | None = None


def part(name: str, corners: Any, triangles: Any = None, colors: Colors | None = None) -> NodePart:
    """Return a part of whatever a library gives, as arrays of our own."""
    faces = np.zeros((0, 3), np.intp) if triangles is None else np.asarray(triangles, np.intp).reshape(-1, 3)
    return NodePart(name, np.asarray(corners, dtype=np.float64).reshape(-1, 3), faces, colors)


def table(lines: list[str], columns: tuple[int, ...]) -> Array:
    """Return columns of lines of numbers, (N, C); ValueError where a line has none there."""
    return np.loadtxt(lines, usecols=columns, comments=None, ndmin=2)


def fans(rows: Any) -> IntArray:
    """Return polygons, rows of numbers of corners, as triangles (T, 3) that meet in the first corner."""
    if isinstance(rows, np.ndarray) and rows.ndim == 2:
        count = rows.shape[1]
        if count < 3:
            return np.zeros((0, 3), np.intp)
        cut = [np.column_stack([rows[:, 0], rows[:, k], rows[:, k + 1]]) for k in range(1, count - 1)]
        return np.stack(cut, axis=1).reshape(-1, 3).astype(np.intp)
    found = [(row[0], row[k], row[k + 1]) for row in rows for k in range(1, len(row) - 1)]
    return np.array(found, dtype=np.intp).reshape(-1, 3)


def wrong_corners(parts: list[NodePart], farthest: float) -> ModelFault | None:
    """Return the fault of a file without corners, with one that is nowhere, or a face without one.

    farthest : the largest coordinate that is one
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
