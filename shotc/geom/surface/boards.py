"""Parallelograms that stand in for targets, and their cells, which are the ends of rays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.surface.triangles import cross

_NO_LENGTH_M = 1e-300  # replaces a zero length


@dataclass(frozen=True, slots=True, eq=False)
class Billboards:
    """One parallelogram a frame, and the eye that looks at it; all of shape (F, 3), metres of W.

    Its points are corner + a right + b up, 0 <= a, b <= 1.
    """

    eye: Array
    corner: Array
    right: Array
    up: Array

    def __len__(self) -> int:
        return len(self.eye)

    def pick(self, which: Mask | slice) -> Billboards:
        """Return those of some frames, by a mask (F,) or a slice."""
        return Billboards(self.eye[which], self.corner[which], self.right[which], self.up[which])

    def mapped(self, put: Callable[[Array], Array]) -> Billboards:
        """Return the same with ``put``, a rigid motion of each frame, applied to all points (F, 3)."""
        corner = put(self.corner)
        right, up = (put(self.corner + side) - corner for side in (self.right, self.up))
        return Billboards(put(self.eye), corner, right, up)


def billboards(eye: Array, centre: Array, width: Array | float, height: Array | float) -> Billboards:
    """Return the rectangles at centres (F, 3) that face eyes (F, 3), with horizontal lower sides; metres.

    width, height : (F,) or one for all. From straight above, the lower side faces South.
    """
    offset = centre - eye
    level = np.column_stack([offset[:, 1], -offset[:, 0], np.zeros(len(offset))])
    size = np.linalg.norm(level, axis=1)
    level[size <= 0.0] = [1.0, 0.0, 0.0]
    level /= np.linalg.norm(level, axis=1)[:, None]
    steep = cross(level, offset)
    steep /= np.maximum(np.linalg.norm(steep, axis=1), _NO_LENGTH_M)[:, None]
    right = level * np.broadcast_to(width, (len(eye),))[:, None]
    up = steep * np.broadcast_to(height, (len(eye),))[:, None]
    return Billboards(eye, centre - 0.5 * (right + up), right, up)


def upright(eye: Array, centre: Array, radius: float, height: float) -> Billboards:
    """Return upright rectangles in front of upright cylinders at centres (F, 3), facing eyes (F, 3).

    Everything within a cylinder's radius is behind its rectangle, except above the cylinder.
    """
    level = (eye - centre) * [1.0, 1.0, 0.0]
    level /= np.maximum(np.linalg.norm(level, axis=1, keepdims=True), _NO_LENGTH_M)
    right = 2.0 * radius * np.column_stack([-level[:, 1], level[:, 0], level[:, 2]])
    up = np.broadcast_to(np.array([0.0, 0.0, height]), eye.shape)
    return Billboards(eye, centre + radius * level - 0.5 * (right + up), right, up)


def cells_of(boards: Billboards, n: int) -> Array:
    """Return the middles of all n x n cells, shape (F n n, 3), metres of W."""
    sides = np.stack([boards.corner, boards.right, boards.up], axis=1)
    return np.asarray(cells(n).T @ sides).reshape(-1, 3)


def cells(n: int) -> Array:
    """Return the rows 1, a and b for the middles of all cells, shape (3, n * n)."""
    middle = (np.arange(n) + 0.5) / n
    a, b = np.meshgrid(middle, middle, indexing="ij")
    return np.stack([np.ones(n * n), a.ravel(), b.ravel()])
