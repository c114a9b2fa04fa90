"""The covered share of a target's outline, by n x n rays a frame.

Rays lead to the middles of the cells of a rectangle. It is the smallest one, perpendicular to the line of
sight to the target's centre, that contains the outline in perspective. The rays that meet the target
represent equal parts of its outline. Each ray ends where it enters the target, so nothing inside or behind
the target covers it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.shapes import TargetShape, bodies_of
from shotc.geom.silhouette import shape_contour
from shotc.geom.solid_arrays.points import signed_distance, support
from shotc.geom.solid_arrays.segments import blocks, within
from shotc.geom.solids import Cylinder, Solid
from shotc.geom.surface.boards import Billboards, billboards, cells_of
from shotc.geom.surface.occlusion import stopped
from shotc.geom.surface.tree import Pairs, Surface
from shotc.geom.surface.triangles import cross
from shotc.geom.vec import Vec3

CELLS_PER_SIDE = 12
"""Cells on a side; the mean error of a partly covered share is 0.01."""
RIM_POINTS = 12
"""Points on each rim of a cylinder for the rectangle around its outline."""
LEAST_DEPTH_SHARE = 0.05
"""Least depth in the projection of an outline, as a share of the distance to the target's centre."""
NO_LENGTH_M = 1e-9
CLOSE_M = 1e-6
"""Distance from the side of a pyramid of rays up to which a solid may still meet them."""


@dataclass(frozen=True, slots=True, eq=False)
class OutlineRays:
    """Rays from cameras to the outline of a body, n x n a frame.

    boards : the rectangles of cells; own : whether a ray meets the body, shape (F, n, n)
    reach  : share of the way to a cell at which the ray enters the body, shape (F, n, n); 0 if it does not
    """

    boards: Billboards
    own: Mask
    reach: Array

    def __len__(self) -> int:
        return len(self.own)

    def mapped(self, put: Callable[[Array], Array]) -> OutlineRays:
        """Return the same rays with ``put``, a rigid motion of each frame, applied to all points (F, 3)."""
        return OutlineRays(self.boards.mapped(put), self.own, self.reach)

    def segments(self, which: Mask) -> tuple[Array, Array]:
        """Return the start and end points, (K, 3) each, metres, of the K rays of a mask (F, n, n)."""
        frame, i, j = np.nonzero(which)
        board, n = self.boards, self.own.shape[1]
        eyes, a, b = board.eye[frame], (i + 0.5) / n, (j + 0.5) / n
        cells = board.corner[frame] + a[:, None] * board.right[frame] + b[:, None] * board.up[frame]
        return eyes, eyes + self.reach[which][:, None] * (cells - eyes)


@dataclass(frozen=True, slots=True, eq=False)
class OutlineBoards:
    """The rectangles that contain the outline of a body.

    through : share of the way to the body's centre, above 1, that is certainly beyond the body, shape (F,)
    """

    boards: Billboards
    through: Array

    def pick(self, which: Mask) -> OutlineBoards:
        """Return those of some frames, by a mask (F,)."""
        return OutlineBoards(self.boards.pick(which), self.through[which])


def outline_boards(shape: TargetShape, centre: Vec3, eyes: Array) -> OutlineBoards:
    """Return the rectangles around the outlines, from eyes (F, 3), of a shape at a centre, metres."""
    bodies, middle = bodies_of(shape), np.array(centre)
    contour = np.concatenate(
        [shape_contour(middle + np.array(body.offset) - eyes, body.shape, RIM_POINTS) for body in bodies],
        axis=1,
    )
    # Cells lie in the plane of the centre. This distance is certainly beyond the target.
    size = np.linalg.norm(contour - (middle - eyes)[:, None], axis=2).max(axis=1)
    through = 1.0 + 2.0 * size / np.maximum(np.linalg.norm(middle - eyes, axis=1), NO_LENGTH_M)
    return OutlineBoards(_holding(eyes, middle, contour), through)


def outline_rays(shape: TargetShape, centre: Vec3, on: OutlineBoards) -> OutlineRays:
    """Return the rays to the outline of a shape at a centre, metres; on : the rectangles around it."""
    boards, n = on.boards, CELLS_PER_SIDE
    eyes = np.repeat(boards.eye, n * n, axis=0)
    beyond = np.repeat(on.through, n * n)
    reach = entering(shape, centre, eyes, beyond[:, None] * (cells_of(boards, n) - eyes))
    own = np.isfinite(reach).reshape(-1, n, n)
    return OutlineRays(boards, own, np.where(own, (reach * beyond).reshape(-1, n, n), 0.0))


def entering(shape: TargetShape, centre: Vec3, eyes: Array, along: Array) -> Array:
    """Return the shares (M,) of segments at which they enter a shape at a centre; inf if they do not.

    eyes : their starts, along : from start to end, (M, 3), metres
    """
    share = np.full(len(eyes), np.inf)
    for body in bodies_of(shape):
        x, y, z = (np.array(centre) + np.array(body.offset)).tolist()
        enter, leave = within(body.shape.solid((x, y, z)), eyes, along)
        share = np.where(leave > enter, np.minimum(share, enter), share)
    return share


def near(boards: Billboards, centres: Array, radius: float) -> Mask:
    """Return in which frames a ray may meet balls at centres, (3,) or (F, 3); shape (F,)."""
    along = boards.corner + 0.5 * (boards.right + boards.up) - boards.eye
    offset = centres - boards.eye
    square = np.maximum(np.einsum("fd,fd->f", along, along), NO_LENGTH_M**2)
    share = np.clip(np.einsum("fd,fd->f", offset, along) / square, 0.0, 1.0)
    wide = 0.5 * (np.linalg.norm(boards.right, axis=1) + np.linalg.norm(boards.up, axis=1))
    return np.asarray(np.linalg.norm(offset - share[:, None] * along, axis=1) <= radius + wide)


def near_solid(boards: Billboards, solid: Solid) -> Mask:
    """Return in which frames a ray may meet a solid, shape (F,): it is near and not beside all rays."""
    may = near(boards, *_ball_about(solid))
    may[may] = ~_beside(boards.pick(may), solid)
    return may


def _beside(boards: Billboards, solid: Solid) -> Mask:
    """Return in which frames a solid is beyond one of the four sides of the pyramid of rays, shape (F,)."""
    first = boards.corner - boards.eye
    corners = (first, first + boards.right, first + boards.right + boards.up, first + boards.up)
    middle = corners[0] + corners[2]
    beside = np.zeros(len(boards), dtype=bool)
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        inward = cross(a, b)
        inward *= np.where(np.einsum("fd,fd->f", inward, middle) < 0.0, -1.0, 1.0)[:, None]
        inward /= np.maximum(np.linalg.norm(inward, axis=1), NO_LENGTH_M**2)[:, None]
        with np.errstate(invalid="ignore"):  # an unbounded solid at a vertical side
            reach = support(solid, inward) - np.einsum("fd,fd->f", inward, boards.eye)
        beside |= reach < -CLOSE_M
    return beside


def covered_by_solid(rays: OutlineRays, solid: Solid) -> Mask:
    """Return which rays a solid blocks, (F, n, n); a solid that contains the eye blocks none."""
    out, may = np.zeros_like(rays.own), near_solid(rays.boards, solid)
    may[may] = signed_distance(solid, rays.boards.eye[may]) > 0.0
    if may.any():
        which = may[:, None, None] & rays.own
        out[which] = blocks(solid, *rays.segments(which))
    return out


def covered_by_ball(rays: OutlineRays, centres: Array, radius: float) -> Mask:
    """Return which rays balls at centres (F, 3) block, (F, n, n).

    A ball that contains the eye blocks none.
    """
    out, may = np.zeros_like(rays.own), near(rays.boards, centres, radius)
    may &= np.linalg.norm(centres - rays.boards.eye, axis=1) >= radius
    if may.any():
        which = may[:, None, None] & rays.own
        eyes, ends = rays.segments(which)
        along, offset = ends - eyes, centres[np.nonzero(which)[0]] - eyes
        square = np.maximum(np.einsum("md,md->m", along, along), NO_LENGTH_M**2)
        share = np.clip(np.einsum("md,md->m", offset, along) / square, 0.0, 1.0)
        out[which] = np.linalg.norm(offset - share[:, None] * along, axis=1) < radius
    return out


def covered_by_surface(rays: OutlineRays, surface: Surface, pairs: Pairs) -> Mask:
    """Return which rays a surface blocks, shape (F, n, n); pairs : of frames and its triangles."""
    return np.asarray(stopped(surface, rays.boards, pairs, rays.reach) & rays.own)


def share_of(rays: OutlineRays, which: Mask) -> Array:
    """Return the share (F,) of the outline in the rays of a mask (F, n, n); 0 without an outline."""
    count = rays.own.sum(axis=(1, 2))
    return np.asarray((which & rays.own).sum(axis=(1, 2)) / np.maximum(count, 1))


def _ball_about(solid: Solid) -> tuple[Array, float]:
    """Return the centre, (3,), and the radius of a bounding ball of a solid, metres."""
    tall = 0.5 * (solid.top - solid.bottom)
    if isinstance(solid, Cylinder):
        x, y, radius = *solid.centre, solid.radius
    else:
        low, high = np.min(solid.points, axis=0), np.max(solid.points, axis=0)
        (x, y), radius = 0.5 * (low + high), 0.5 * float(np.hypot(*(high - low)))
    return np.array([x, y, solid.bottom + tall]), float(np.hypot(radius, tall))


def _holding(eyes: Array, middle: Array, contour: Array) -> Billboards:
    """Return the rectangles across the lines of sight around points (F, K, 3), given minus the eyes."""
    frame = billboards(eyes, np.broadcast_to(middle, eyes.shape), 1.0, 1.0)
    offset = middle - eyes
    far = np.maximum(np.linalg.norm(offset, axis=1), NO_LENGTH_M)
    depth = np.einsum("fkd,fd->fk", contour, offset / far[:, None])
    scale = far[:, None] / np.maximum(depth, LEAST_DEPTH_SHARE * far[:, None])
    corner, sides = middle, []
    for side in (frame.right, frame.up):
        at = np.einsum("fkd,fd->fk", contour, side) * scale
        low, high = at.min(axis=1), at.max(axis=1)
        corner = corner + low[:, None] * side
        sides.append((high - low)[:, None] * side)
    return Billboards(eyes, np.asarray(corner), *sides)
