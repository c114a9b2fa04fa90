"""Occlusion by a surface of rectangles that stand in for targets, with one packet of rays a frame.

Rays lead to the middles of n x n cells of a parallelogram, so a linear function of a ray is linear in the
cell. Three products a triangle serve all rays. The test is watertight at common sides, because both triangles
use the sign of the same product.
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
"""Frames that are processed together, so that their pairs with triangles fit the processor's cache."""
PAIRS_AT_ONCE = 16_384
GROUPED_FRAMES = 16
"""Consecutive frames that share one search of the tree, because they are nearly alike."""
ALIKE_RATIO = 0.5
"""Largest width of the common boxes of such frames, summed over axes, as a share of the way to a
billboard."""
RAY_SHARE = 1.0 - 1e-6
"""Share of the way to a cell at which rays end, so that the support of a target does not hide it."""
BESIDE_M = 1e-6
"""Distance at which all rays pass an omitted triangle, metres; far above rounding."""
_NO_LENGTH_M = 1e-300  # replaces a zero length; a quotient by it is far above any share


def hidden(surface: Surface, boards: Billboards, n: int = 8) -> Mask:
    """Return which of n x n cells a surface hides, shape (F, n, n), along right and up.

    The mean over a frame is its hidden share.
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
    """Return the pairs of frames and triangles that rays to the middles of n x n cells may meet.

    Triangles are omitted if all rays of a frame end in front of their plane, or if they are beside all rays.
    Over terrain these are nearly all triangles below a line of sight.
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
    """Return which rays the triangles of pairs block, shape (F, n, n).

    pairs : of frames and triangles, by ``in_the_way``
    reach : share of the way to a cell at which its ray ends, (F, n, n), at most 1
    """
    ends = RAY_SHARE * np.minimum(reach, 1.0).reshape(-1, reach.shape[1] * reach.shape[2])
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
    """Return which lines of sight, from eyes (F, 3) to points (F, 3), a surface blocks, (F,)."""
    return np.asarray(hidden(surface, billboards(eyes, points, 0.0, 0.0), 1)[:, 0, 0])


def candidates(surface: Surface, boards: Billboards, far: float = 1.0, about: float = 0.0) -> Pairs:
    """Return the triangles whose boxes meet a box that moves from the eye to the billboard and grows.

    far : share of the way to the billboard at which it stops; about : metres by which triangles are enlarged
    """
    on = boards.corner + 0.5 * (boards.right + boards.up) - boards.eye
    grown = 0.5 * (np.abs(boards.right) + np.abs(boards.up))
    each = _Sliding(boards.eye.T, boards.eye.T, np.concatenate([on + grown, grown - on], axis=1).T)
    starts = np.arange(0, len(boards), GROUPED_FRAMES)
    several = each.together(starts)
    if len(boards) <= GROUPED_FRAMES or not several.alike(on[starts].T):
        return search(surface, len(boards), each.meets(far, about))
    pairs = search(surface, len(starts), several.meets(far, about))
    ends = np.minimum(starts + GROUPED_FRAMES, len(boards))[pairs.item]
    frame = starts[pairs.item][:, None] + np.arange(GROUPED_FRAMES)
    inside = frame < ends[:, None]
    item, triangle = frame[inside], np.repeat(pairs.triangle, inside.sum(axis=1))
    corners = surface.triangles[triangle]
    keep = each.meets(far, about)(item, lowest(corners), highest(corners))
    item, triangle = item[keep], triangle[keep]
    order = np.argsort(item, kind="stable")
    return Pairs(item[order], triangle[order])


@dataclass(frozen=True, slots=True, eq=False)
class _Pyramids:
    """The pyramids that contain all rays of a frame, from its eye.

    ends : the outermost middles of cells, shape (F, 4, 3); sides : inner unit normals, (F, 4, 3), 0 for none
    """

    ends: Array
    sides: Array

    def may_meet(self, frame: IntArray, corners: Array, disc: float) -> Mask:
        """Return which triangles (K, 3, 3), seen from eyes of frames (K,), their rays may hit, (K,).

        disc : radius of triangles without size, metres
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
        """Return which triangles' planes the rays reach or approach within ``beside`` metres, (K,)."""
        normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.maximum(np.sqrt(dot(normal, normal)), _NO_LENGTH_M)[:, None]
        far = dot(normal, corners[:, 0])
        nearest = (np.einsum("kd,ked->ek", normal, self.ends[frame]) * np.sign(far)).max(axis=0)
        return np.asarray(np.abs(far) - nearest <= beside)


def _pyramids(boards: Billboards, n: int) -> _Pyramids:
    """Return the pyramids around the rays to the middles of n x n cells."""
    first = boards.corner + (0.5 / n) * (boards.right + boards.up) - boards.eye
    right, up = (1.0 - 1.0 / n) * boards.right, (1.0 - 1.0 / n) * boards.up
    ends = np.stack([first, first + right, first + up, first + right + up], axis=1)
    normals = np.stack(
        [cross(ends[:, k], edge) for k, edge in ((0, right), (2, right), (0, up), (1, up))], axis=1
    )
    inward = np.einsum("fsd,fsd->fs", normals, np.stack([up, -up, right, -right], axis=1))
    length = np.maximum(np.linalg.norm(normals, axis=2), _NO_LENGTH_M)
    return _Pyramids(ends, np.asarray(normals * (np.sign(inward) / length)[:, :, None]))


@dataclass(frozen=True, slots=True, eq=False)
class _Sliding:
    """Boxes that move from an eye to a billboard and grow; columns are frames, or groups of frames.

    low, high : at the eye, (3, F); speed : of the upper sides, and of the lower sides downwards, (6, F)
    """

    low: Array
    high: Array
    speed: Array

    def together(self, starts: IntArray) -> _Sliding:
        """Return the boxes around those of all frames from each start to the next."""
        low = np.minimum.reduceat(self.low, starts, axis=1)
        high, speed = (np.maximum.reduceat(rows, starts, axis=1) for rows in (self.high, self.speed))
        return _Sliding(low, high, speed)

    def alike(self, on: Array) -> bool:
        """Return whether the frames of a group have nearly the same view.

        on : vectors to their boards, (3, F)
        """
        wide = (self.high - self.low) + self.speed[:3] + self.speed[3:]
        return bool((wide.sum(axis=0) <= ALIKE_RATIO * np.abs(on).sum(axis=0)).all())

    def meets(self, far: float, about: float) -> Meets:
        """Return the test for ``search``: whether the boxes meet boxes of the tree."""
        # At share x of the way: x speed >= low - eye, and x speed >= eye - high, axis by axis.
        speed = np.where(self.speed == 0.0, _NO_LENGTH_M, self.speed)
        per, enters = 1.0 / speed, speed > 0.0
        first_eye, last_eye = np.ascontiguousarray(self.high), np.ascontiguousarray(self.low)

        def meet(frame: IntArray, low: Array, high: Array) -> Mask:
            offset = np.concatenate([low.T - first_eye[:, frame], last_eye[:, frame] - high.T])
            share, entering = (offset - about) * per[:, frame], enters[:, frame]
            first = np.where(entering, share, 0.0).max(axis=0)
            last = np.where(entering, far, share).min(axis=0)
            return np.asarray(np.maximum(first, 0.0) <= np.minimum(last, far))

        return meet


def _hits(triangles: Array, boards: Billboards, to: tuple[IntArray, Array]) -> Mask:
    """Return which rays of frames their triangles (K, 3, 3) block, shape (K, n * n).

    to : the frames, (K,), and the shares of the ways to their cells at which the rays end, (K, n * n)
    """
    frame, ends = to
    corners = triangles - boards.eye[frame][:, None]
    # A ray is inside a side if its product with the plane of eye and side is positive.
    planes = cross(corners, corners[:, [1, 2, 0]])
    volume = dot(corners[:, 0], planes[:, 1])
    planes *= np.sign(volume)[:, None, None]
    sides = np.stack([boards.corner - boards.eye, boards.right, boards.up], axis=1)[frame]
    products = np.einsum("ksd,kpd->skp", planes, sides) @ cells(round(sqrt(ends.shape[1])))
    inside = np.minimum(np.minimum(products[0], products[1]), products[2]) >= 0.0
    # The sum is the product with the triangle's own plane. The volume over it is the share of the way.
    whole = products[0] + products[1] + products[2]
    return np.asarray(inside & (whole * ends > np.abs(volume)[:, None]) & (volume != 0.0)[:, None])
