"""The first intersections of rays with a surface, with one packet of rays a frame as in ``sight``.

A ray meets a triangle if it passes all its sides on the same side; this is watertight at common sides. Points
(triangles without size) are met as discs that face the ray.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.surface.boards import Billboards, cells
from shotc.geom.surface.occlusion import PAIRS_AT_ONCE, candidates
from shotc.geom.surface.tree import Surface
from shotc.geom.surface.triangles import cross, dot, without_size

FRAMES_AT_ONCE = 64
"""Frames that are processed together, so that pairs of triangles with unbounded rays fit the memory."""
NOTHING = -1


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """The first intersections of rays; shapes (F, n, n), along right and up of the billboards.

    share    : of the way from the eye to the billboard, which may exceed 1; inf without an intersection
    triangle : index in the surface, NOTHING without an intersection
    """

    share: Array
    triangle: IntArray


def first_hits(surface: Surface, boards: Billboards, n: int, disc: float = 0.0) -> Hits:
    """Return the first hits (F, n, n) of unbounded rays from eyes through n x n billboard cells.

    disc : radius of the discs that stand for points, metres; with 0 no ray meets a point
    """
    share = np.full((len(boards), n * n), np.inf)
    triangle = np.full((len(boards), n * n), NOTHING, dtype=np.intp)
    points = without_size(surface.triangles) if disc > 0.0 else None
    for start in range(0, len(boards), FRAMES_AT_ONCE):
        which = slice(start, start + FRAMES_AT_ONCE)
        some = boards.pick(which)
        pairs = candidates(surface, some, np.inf, disc)
        for first in range(0, len(pairs), PAIRS_AT_ONCE):
            part = pairs.pick(slice(first, first + PAIRS_AT_ONCE))
            met = _shares(surface.triangles[part.triangle], some, part.item, n)
            if points is not None and (loose := points[part.triangle]).any():
                corner = surface.triangles[part.triangle[loose], 0]
                met[loose] = _disc_shares(corner, some, part.item[loose], (n, disc))
            frame, begin = np.unique(part.item, return_index=True)
            least = np.minimum.reduceat(met, begin, axis=0)
            each = np.repeat(least, np.diff([*begin, len(part)]), axis=0)
            number = np.where(met <= each, part.triangle[:, None], NOTHING)
            nearest = np.maximum.reduceat(number, begin, axis=0)
            frame = frame + start
            closer = least < share[frame]
            share[frame] = np.where(closer, least, share[frame])
            triangle[frame] = np.where(closer, nearest, triangle[frame])
    return Hits(share.reshape(-1, n, n), triangle.reshape(-1, n, n))


def _shares(triangles: Array, boards: Billboards, frame: IntArray, n: int) -> Array:
    """Return the shares (K, n * n) at which rays of frames (K,) meet triangles (K, 3, 3)."""
    corners = triangles - boards.eye[frame][:, None]
    planes = cross(corners, corners[:, [1, 2, 0]])
    volume = dot(corners[:, 0], planes[:, 1])
    planes *= np.sign(volume)[:, None, None]
    products = np.einsum("ksd,kpd->skp", planes, _ray_basis(boards)[frame]) @ cells(n)
    inside = np.minimum(np.minimum(products[0], products[1]), products[2]) >= 0.0
    whole = products[0] + products[1] + products[2]
    met = inside & (whole > 0.0) & (volume != 0.0)[:, None]
    return np.where(met, np.abs(volume)[:, None] / np.where(met, whole, 1.0), np.inf)


def _disc_shares(points: Array, boards: Billboards, frame: IntArray, disc: tuple[int, float]) -> Array:
    """Return the shares (K, n * n) at which rays meet discs at points (K, 3); disc : n, and their radius."""
    n, radius = disc
    rays = np.einsum("fpd,pc->fcd", _ray_basis(boards), cells(n))
    offset = points - boards.eye[frame]
    along = np.einsum("kcd,kd->kc", rays[frame], offset)
    square = dot(rays, rays)[frame]
    off = dot(offset, offset)[:, None] - along**2 / square
    return np.where((along > 0.0) & (off <= radius**2), along / square, np.inf)


def _ray_basis(boards: Billboards) -> Array:
    """Return the vectors from the eyes to the corner, and the sides, of the billboards, (F, 3, 3)."""
    return np.stack([boards.corner - boards.eye, boards.right, boards.up], axis=1)
