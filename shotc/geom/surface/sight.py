"""What a surface hides of rectangles that stand in for targets: one packet of rays a frame.

Rays lead to the middles of n x n cells of a parallelogram, so that all that is linear in a ray is so in
the cell: three products a triangle serve all rays (watertight on common sides, as signs of one product are).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.tree import Pairs, Surface, search
from shotc.geom.surface.triangles import cross, dot

FRAMES_AT_ONCE = 256
"""Frames whose pairs with triangles fit the cache."""
PAIRS_AT_ONCE = 16_384
SHORT_OF = 1.0 - 1e-6
"""Share of the way to a cell at which rays end: what a target stands on, or touches, does not hide it."""
_NONE = 1e-300  # instead of a length that is none, so that what is divided by it is far beyond any share


@dataclass(frozen=True, slots=True, eq=False)
class Billboards:
    """A parallelogram a frame, and the eye that looks at it; all of shape (F, 3), metres of W.

    Its points are corner + a right + b up, 0 <= a, b <= 1.
    """

    eye: Array
    corner: Array
    right: Array
    up: Array

    def __len__(self) -> int:
        return len(self.eye)

    def part(self, which: slice) -> Billboards:
        """Return those of some frames."""
        return Billboards(self.eye[which], self.corner[which], self.right[which], self.up[which])


def billboards(eye: Array, centre: Array, width: Array | float, height: Array | float) -> Billboards:
    """Return the rectangles that face eyes (F, 3) about centres (F, 3), with level lower sides; metres.

    width, height : (F,) or one for all. Seen from straight above, the lower side faces South.
    """
    away = centre - eye
    level = np.column_stack([away[:, 1], -away[:, 0], np.zeros(len(away))])
    size = np.linalg.norm(level, axis=1)
    level[size <= 0.0] = [1.0, 0.0, 0.0]
    level /= np.linalg.norm(level, axis=1)[:, None]
    steep = cross(level, away)
    steep /= np.maximum(np.linalg.norm(steep, axis=1), _NONE)[:, None]
    right = level * np.broadcast_to(width, (len(eye),))[:, None]
    up = steep * np.broadcast_to(height, (len(eye),))[:, None]
    return Billboards(eye, centre - 0.5 * (right + up), right, up)


def facing_cylinders(eye: Array, centre: Array, radius: float, height: float) -> Billboards:
    """Return the least such rectangles that hold what upright cylinders at centres (F, 3) show from far."""
    away = centre - eye
    far = np.maximum(np.linalg.norm(away, axis=1), _NONE)
    upright = np.hypot(away[:, 0], away[:, 1]) / far
    shown = height * upright + 2.0 * radius * np.abs(away[:, 2]) / far
    return billboards(eye, centre, 2.0 * radius, shown)


def upright(eye: Array, centre: Array, radius: float, height: float) -> Billboards:
    """Return upright rectangles before upright cylinders about centres (F, 3), on the sides of eyes (F, 3).

    What is within a cylinder's radius is behind its rectangle, but for what stands over the cylinder.
    """
    level = (eye - centre) * [1.0, 1.0, 0.0]
    level /= np.maximum(np.linalg.norm(level, axis=1, keepdims=True), _NONE)
    right = 2.0 * radius * np.column_stack([-level[:, 1], level[:, 0], level[:, 2]])
    up = np.broadcast_to(np.array([0.0, 0.0, height]), eye.shape)
    return Billboards(eye, centre + radius * level - 0.5 * (right + up), right, up)


def hidden(surface: Surface, boards: Billboards, n: int = 8, reach: Array | None = None) -> Mask:
    """Tell which of n x n cells a surface hides: shape (F, n, n), along right and up.

    reach : share of the way to a cell at which its ray ends, (F, n, n); all of it if silent, and at most
    The mean over a frame is the share that is hidden.
    """
    ends = np.ones((len(boards), n * n)) if reach is None else np.minimum(reach, 1.0).reshape(-1, n * n)
    ends = SHORT_OF * ends
    out = np.zeros((len(boards), n * n), dtype=bool)
    for start in range(0, len(boards), FRAMES_AT_ONCE):
        which = slice(start, start + FRAMES_AT_ONCE)
        some, short = boards.part(which), ends[which]
        pairs = candidates(surface, some)
        for first in range(0, len(pairs), PAIRS_AT_ONCE):
            part = pairs.pick(slice(first, first + PAIRS_AT_ONCE))
            hits = _hits(surface.triangles[part.triangle], some, (part.item, short[part.item]))
            frame, begin = np.unique(part.item, return_index=True)
            out[which][frame] |= np.logical_or.reduceat(hits, begin, axis=0)
    return out.reshape(-1, n, n)


def lines_hidden(surface: Surface, eyes: Array, points: Array) -> Mask:
    """Tell of which lines of sight, from eyes (F, 3) to points (F, 3), a surface is in the way; (F,)."""
    return np.asarray(hidden(surface, billboards(eyes, points, 0.0, 0.0), 1)[:, 0, 0])


def candidates(surface: Surface, boards: Billboards, far: float = 1.0, about: float = 0.0) -> Pairs:
    """Return the triangles whose boxes meet the boxes that slide from the eye to the billboard, growing.

    far : share of the way to the billboard at which they stop; about : metres by which triangles are grown
    """
    on = boards.corner + 0.5 * (boards.right + boards.up) - boards.eye
    grown = 0.5 * (np.abs(boards.right) + np.abs(boards.up))
    # At share x of the way: x (on + grown) >= low - eye and x (grown - on) >= eye - high, axis by axis.
    speed = np.concatenate([on + grown, grown - on], axis=1).T
    speed = np.where(speed == 0.0, _NONE, speed)
    per, enters, eyes = 1.0 / speed, speed > 0.0, np.ascontiguousarray(boards.eye.T)

    def meets(frame: IntArray, low: Array, high: Array) -> Mask:
        eye = eyes[:, frame]
        share = np.concatenate([low.T - about - eye, eye - high.T - about]) * per[:, frame]
        entering = enters[:, frame]
        first = np.where(entering, share, 0.0).max(axis=0)
        last = np.where(entering, far, share).min(axis=0)
        return np.asarray(np.maximum(first, 0.0) <= np.minimum(last, far))

    return search(surface, len(boards), meets)


def _hits(triangles: Array, boards: Billboards, to: tuple[IntArray, Array]) -> Mask:
    """Tell which rays of frames their triangles (K, 3, 3) stop; shape (K, n * n).

    to : the frames, (K,), and the shares of the ways to their cells at which the rays end, (K, n * n)
    """
    frame, ends = to
    corners = triangles - boards.eye[frame][:, None]
    # A ray passes inside of a side where its product with the plane of eye and side is positive.
    planes = cross(corners, corners[:, [1, 2, 0]])
    volume = dot(corners[:, 0], planes[:, 1])
    planes *= np.sign(volume)[:, None, None]
    sides = np.stack([boards.corner - boards.eye, boards.right, boards.up], axis=1)[frame]
    products = np.einsum("ksd,kpd->skp", planes, sides) @ cells(round(sqrt(ends.shape[1])))
    inside = np.minimum(np.minimum(products[0], products[1]), products[2]) >= 0.0
    # The sum is the product with the triangle's own plane; the volume over it, the share of the way.
    whole = products[0] + products[1] + products[2]
    return np.asarray(inside & (whole * ends > np.abs(volume)[:, None]) & (volume != 0.0)[:, None])


def cells_of(boards: Billboards, n: int) -> Array:
    """Return the middles of all cells, (F n n, 3), metres of W."""
    sides = np.stack([boards.corner, boards.right, boards.up], axis=1)
    return np.asarray(cells(n).T @ sides).reshape(-1, 3)


def cells(n: int) -> Array:
    """Return 1, a and b of all cells' middles, shape (3, n * n)."""
    middle = (np.arange(n) + 0.5) / n
    a, b = np.meshgrid(middle, middle, indexing="ij")
    return np.stack([np.ones(n * n), a.ravel(), b.ravel()])
