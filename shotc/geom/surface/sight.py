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
from shotc.geom.surface.boards import Billboards, billboards, cells
from shotc.geom.surface.discs import stopped_by_discs
from shotc.geom.surface.tree import Meets, Pairs, Surface, search
from shotc.geom.surface.triangles import cross, dot, highest, lowest, without_size

FRAMES_AT_ONCE = 256
"""Frames whose pairs with triangles fit the cache."""
PAIRS_AT_ONCE = 16_384
TOGETHER = 16
"""Frames that follow one another are nearly alike: the tree is searched for them together."""
ALIKE_RATIO = 0.5
"""Of the way to a billboard: how wide the boxes of frames together are at most, all axes summed."""
SHORT_OF = 1.0 - 1e-6
"""Share of the way to a cell at which rays end: what a target stands on, or touches, does not hide it."""
BESIDE_M = 1e-6
"""How far all rays pass a triangle that is left out: far more than what rounding moves."""
_NONE = 1e-300  # instead of a length that is none, so that what is divided by it is far beyond any share


def hidden(surface: Surface, boards: Billboards, n: int = 8) -> Mask:
    """Tell which of n x n cells a surface hides: shape (F, n, n), along right and up.

    The mean over a frame is the share that is hidden.
    """
    out = np.zeros((len(boards), n, n), dtype=bool)
    for start in range(0, len(boards), FRAMES_AT_ONCE):
        some = boards.pick(slice(start, start + FRAMES_AT_ONCE))
        reach = np.ones((len(some), n, n))
        out[start : start + len(some)] = stopped(
            surface, some, candidates(surface, some, about=surface.disc), reach
        )
    return out


def in_the_way(surface: Surface, boards: Billboards, n: int) -> Pairs:
    """Return the frames and triangles of which rays to the middles of n x n cells may meet.

    Left out are triangles in front of whose plane all rays of a frame are, and those wholly beside all
    rays: over terrain that is nearly all that is below a line of sight.
    """
    items, triangles = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    for start in range(0, len(boards), FRAMES_AT_ONCE):
        some = boards.pick(slice(start, start + FRAMES_AT_ONCE))
        pairs = candidates(surface, some, about=surface.disc)
        corners = surface.triangles[pairs.triangle] - some.eye[pairs.item][:, None]
        pairs = pairs.pick(_pyramids(some, n).may_meet(pairs.item, corners, surface.disc))
        items.append(pairs.item + start)
        triangles.append(pairs.triangle)
    return Pairs(np.concatenate(items), np.concatenate(triangles))


def stopped(surface: Surface, boards: Billboards, pairs: Pairs, reach: Array) -> Mask:
    """Tell which rays the triangles of some pairs stop, shape (F, n, n).

    pairs : of a frame and a triangle, as ``in_the_way`` returns them
    reach : share of the way to a cell at which its ray ends, (F, n, n), at most 1
    """
    ends = SHORT_OF * np.minimum(reach, 1.0).reshape(-1, reach.shape[1] * reach.shape[2])
    out = np.zeros(ends.shape, dtype=bool)
    for first in range(0, len(pairs), PAIRS_AT_ONCE):
        part = pairs.pick(slice(first, first + PAIRS_AT_ONCE))
        triangles = surface.triangles[part.triangle]
        if surface.disc > 0.0:
            loose = without_size(triangles)
            of, to = (triangles[loose, 0], part.item[loose]), ends.reshape(reach.shape)
            out[stopped_by_discs(of, boards, to, surface.disc)] = True
            part, triangles = part.pick(~loose), triangles[~loose]
        if len(part):
            hits = _hits(triangles, boards, (part.item, ends[part.item]))
            frame, begin = np.unique(part.item, return_index=True)
            out[frame] |= np.logical_or.reduceat(hits, begin, axis=0)
    return out.reshape(reach.shape)


def lines_hidden(surface: Surface, eyes: Array, points: Array) -> Mask:
    """Tell of which lines of sight, from eyes (F, 3) to points (F, 3), a surface is in the way; (F,)."""
    return np.asarray(hidden(surface, billboards(eyes, points, 0.0, 0.0), 1)[:, 0, 0])


def candidates(surface: Surface, boards: Billboards, far: float = 1.0, about: float = 0.0) -> Pairs:
    """Return the triangles whose boxes meet the boxes that slide from the eye to the billboard, growing.

    far : share of the way to the billboard at which they stop; about : metres by which triangles are grown
    """
    on = boards.corner + 0.5 * (boards.right + boards.up) - boards.eye
    grown = 0.5 * (np.abs(boards.right) + np.abs(boards.up))
    each = _Sliding(boards.eye.T, boards.eye.T, np.concatenate([on + grown, grown - on], axis=1).T)
    starts = np.arange(0, len(boards), TOGETHER)
    several = each.together(starts)
    if len(boards) <= TOGETHER or not several.alike(on[starts].T):
        return search(surface, len(boards), each.meets(far, about))
    found = search(surface, len(starts), several.meets(far, about))
    lasts = np.minimum(starts + TOGETHER, len(boards))[found.item]
    frame = starts[found.item][:, None] + np.arange(TOGETHER)
    inside = frame < lasts[:, None]
    item, triangle = frame[inside], np.repeat(found.triangle, inside.sum(axis=1))
    corners = surface.triangles[triangle]
    keep = each.meets(far, about)(item, lowest(corners), highest(corners))
    item, triangle = item[keep], triangle[keep]
    order = np.argsort(item, kind="stable")
    return Pairs(item[order], triangle[order])


@dataclass(frozen=True, slots=True, eq=False)
class _Pyramids:
    """What holds all rays of a frame, from its eye.

    ends : the outermost middles of cells, shape (F, 4, 3); sides : inner unit normals, (F, 4, 3), 0 for none
    """

    ends: Array
    sides: Array

    def may_meet(self, frame: IntArray, corners: Array, disc: float) -> Mask:
        """Tell which triangles (K, 3, 3), from the eyes of frames (K,), are not parted from their rays.

        disc : radius of those without size, metres
        """
        beside = max(BESIDE_M, disc)
        if disc > 0.0 and without_size(corners).all():
            may, corners = np.ones(len(frame), dtype=bool), corners[:, :1]
        else:
            may = self._reach_planes(frame, corners, beside)
        inside = np.einsum("ksd,kvd->vsk", self.sides[frame[may]], corners[may])
        may[may] = inside.max(axis=0).min(axis=0) >= -beside
        return np.asarray(may)

    def _reach_planes(self, frame: IntArray, corners: Array, beside: float) -> Mask:
        """Tell the planes of which triangles rays come to, or as near as that, metres."""
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(np.sqrt(dot(normal, normal)), _NONE)[:, None]
        far = dot(normal, corners[:, 0])
        nearest = (np.einsum("kd,ked->ek", normal, self.ends[frame]) * np.sign(far)).max(axis=0)
        return np.asarray(np.abs(far) - nearest <= beside)


def _pyramids(boards: Billboards, n: int) -> _Pyramids:
    """Return what holds the rays to the middles of n x n cells."""
    first = boards.corner + (0.5 / n) * (boards.right + boards.up) - boards.eye
    right, up = (1.0 - 1.0 / n) * boards.right, (1.0 - 1.0 / n) * boards.up
    ends = np.stack([first, first + right, first + up, first + right + up], axis=1)
    normals = np.stack(
        [cross(ends[:, k], way) for k, way in ((0, right), (2, right), (0, up), (1, up))], axis=1
    )
    inward = np.einsum("fsd,fsd->fs", normals, np.stack([up, -up, right, -right], axis=1))
    length = np.maximum(np.linalg.norm(normals, axis=2), _NONE)
    return _Pyramids(ends, np.asarray(normals * (np.sign(inward) / length)[:, :, None]))


@dataclass(frozen=True, slots=True, eq=False)
class _Sliding:
    """Boxes that slide from about an eye, and grow: columns are frames, or several frames together.

    low, high : of the eye, (3, F); speed : of the upper sides, and of the lower ones downwards, (6, F)
    """

    low: Array
    high: Array
    speed: Array

    def together(self, starts: IntArray) -> _Sliding:
        """Return the boxes that hold those of all frames from each start to the next."""
        low = np.minimum.reduceat(self.low, starts, axis=1)
        high, speed = (np.maximum.reduceat(rows, starts, axis=1) for rows in (self.high, self.speed))
        return _Sliding(low, high, speed)

    def alike(self, on: Array) -> bool:
        """Tell whether frames that are together look nearly the same way; on : to their boards, (3, F)."""
        wide = (self.high - self.low) + self.speed[:3] + self.speed[3:]
        return bool((wide.sum(axis=0) <= ALIKE_RATIO * np.abs(on).sum(axis=0)).all())

    def meets(self, far: float, about: float) -> Meets:
        """Return what tells whether boxes of the tree are met, as ``search`` asks."""
        # At share x of the way: x speed >= low - eye, and x speed >= eye - high, axis by axis.
        speed = np.where(self.speed == 0.0, _NONE, self.speed)
        per, enters = 1.0 / speed, speed > 0.0
        first_eye, last_eye = np.ascontiguousarray(self.high), np.ascontiguousarray(self.low)

        def meet(frame: IntArray, low: Array, high: Array) -> Mask:
            away = np.concatenate([low.T - first_eye[:, frame], last_eye[:, frame] - high.T])
            share, entering = (away - about) * per[:, frame], enters[:, frame]
            first = np.where(entering, share, 0.0).max(axis=0)
            last = np.where(entering, far, share).min(axis=0)
            return np.asarray(np.maximum(first, 0.0) <= np.minimum(last, far))

        return meet


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
