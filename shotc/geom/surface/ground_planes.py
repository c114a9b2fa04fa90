"""One half-space above the ground a piece, for convex programmes, with the most vertical space for the piece.

Among all planes that are nowhere below the ground around a piece, the best one has the largest vertical
distance from the piece. In its two slopes this is a linear programme: over differences d of a point of the
piece and a point of the ground, the least height at which their hull meets the vertical through 0. A basis is
three differences around 0 in the plan. The difference that lies deepest below their plane enters the basis,
by the ratio test of the simplex method. For any slopes the plane is then put above the ground, so the result
is always valid; the slopes only determine how tight it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.surface.ground import Ground
from shotc.geom.surface.planes import Kept, Planes
from shotc.geom.surface.tree import Pairs, in_plan
from shotc.geom.surface.triangles import TINY_SQUARE, cross, dot

MOST_PIVOTS = 40
"""Most exchanges of a basis; about twelve suffice."""
DEEPER_M = 1e-6
"""Least depth of a difference below the plane of a basis to enter it, metres."""
FAR_M = 1e4
"""Distance in the plan and height of the first basis, metres."""
_NEXT = [1, 2, 0]


@dataclass(frozen=True, slots=True, eq=False)
class Corners:
    """Points of the ground around pieces: corners of its triangles, cut to the pieces' boxes.

    piece : shape (C,), in order; place : (C, 3), metres of W
    """

    piece: IntArray
    place: Array


def ground_planes(ground: Ground, hulls: Array, width: float, clearance: float, margin: Kept) -> Planes:
    """Return a half-space above the ground for every piece with ground around it.

    hulls : shape (P, m, 3), points whose hull contains each piece, metres
    width : distance beyond a piece's box, in the plan, up to which its plane is above the ground, metres
    A point inside that box that keeps the half-space has the vertical clearance above the ground.
    """
    low, high = hulls[..., :2].min(axis=1) - width, hulls[..., :2].max(axis=1) + width
    corners = _about(ground, low, high)
    none = np.zeros(len(hulls), dtype=bool)
    piece, begin = np.unique(corners.piece, return_index=True)
    if not len(piece):
        return Planes(piece, piece.copy(), np.zeros((0, 3)), np.zeros(0), none)
    some = hulls[piece]
    slope = _slopes(some, corners.place, begin)
    each = np.repeat(np.arange(len(piece)), np.diff(np.append(begin, len(corners.place))))
    level = np.maximum.reduceat(corners.place[:, 2] - dot(corners.place[:, :2], slope[each]), begin)
    slack = (some[..., 2] - np.einsum("pmd,pd->pm", some[..., :2], slope)).min(axis=1) - level - clearance
    normal = np.column_stack([-slope, np.ones(len(piece))])
    length = np.sqrt(dot(normal, normal))
    offset = (level + clearance + margin(slack)) / length
    return Planes(piece, np.full(len(piece), -1), normal / length[:, None], offset, none)


def _about(ground: Ground, low: Array, high: Array) -> Corners:
    """Return the corners of the triangles that meet boxes low-high (P, 2), cut to the boxes."""
    pairs = in_plan(ground.surface, low, high)
    triangles = ground.surface.triangles[pairs.triangle]
    its_low, its_high = low[pairs.item][:, None], high[pairs.item][:, None]
    inside = (triangles[..., :2] >= its_low) & (triangles[..., :2] <= its_high)
    whole = np.asarray(inside.all(axis=(1, 2)))
    cut = _cut(triangles[~whole], pairs.pick(~whole), low, high)
    piece = np.concatenate([np.repeat(pairs.item[whole], 3), cut.piece])
    place = np.concatenate([triangles[whole].reshape(-1, 3), cut.place])
    order = np.argsort(piece, kind="stable")
    return Corners(piece[order], place[order])


def _cut(triangles: Array, pairs: Pairs, low: Array, high: Array) -> Corners:
    """Return the corners of triangles (K, 3, 3) cut to boxes in the plan."""
    low, high = low[pairs.item], high[pairs.item]
    corner_sets = [triangles]
    sides = triangles[:, _NEXT] - triangles
    for axis, border in ((0, low), (0, high), (1, low), (1, high)):
        length = np.where(sides[..., axis] == 0.0, np.nan, sides[..., axis])
        share = (border[:, axis, None] - triangles[..., axis]) / length
        share[~((share > 0.0) & (share < 1.0))] = np.nan
        crossing = triangles + share[..., None] * sides
        crossing[..., axis] = np.where(np.isnan(share), np.nan, border[:, axis, None])
        corner_sets.append(crossing)
    corner_sets.append(_over(triangles, low, high))
    every = np.concatenate(corner_sets, axis=1)
    inside = ((every[..., :2] >= low[:, None]) & (every[..., :2] <= high[:, None])).all(axis=2)
    inside &= ~np.isnan(every[..., 2])
    return Corners(np.repeat(pairs.item, inside.sum(axis=1)), every[inside])


def _over(triangles: Array, low: Array, high: Array) -> Array:
    """Return box corners (K, 2) inside triangles at the triangles' height, (K, 4, 3); else NaN."""
    x = np.stack([low[:, 0], high[:, 0], high[:, 0], low[:, 0]], axis=1)
    y = np.stack([low[:, 1], low[:, 1], high[:, 1], high[:, 1]], axis=1)
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    turn = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    turn = np.where(np.abs(turn) > TINY_SQUARE, turn, np.nan)[:, None]
    dx, dy = x - triangles[:, 0, :1], y - triangles[:, 0, 1:2]
    u = (dx * other[:, 1:2] - dy * other[:, :1]) / turn
    v = (dy * one[:, :1] - dx * one[:, 1:2]) / turn
    z = triangles[:, 0, 2:] + u * one[:, 2:] + v * other[:, 2:]
    inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    return np.stack([x, y, np.where(inside, z, np.nan)], axis=-1)


def _slopes(hulls: Array, places: Array, begin: IntArray) -> Array:
    """Return the slopes (P, 2) of the planes with the most space below hulls (P, m, 3)."""
    count = len(hulls)
    turn = 2 * np.pi * np.arange(3) / 3
    start = FAR_M * np.column_stack([np.cos(turn), np.sin(turn), np.ones(3)])
    basis = np.tile(start, (count, 1, 1))
    slope, active = np.zeros((count, 2)), np.arange(count)
    ends = np.append(begin, len(places))
    owner = np.repeat(np.arange(count), np.diff(ends))
    for _ in range(MOST_PIVOTS):
        slope[active], height = _plane(basis[active])
        above = places[:, 2] - dot(places[:, :2], slope[owner])
        enters, depth = _deepest(hulls, places, slope, above, begin)
        deeper = depth[active] < height - DEEPER_M
        active = active[deeper]
        if not len(active):
            break
        basis[active] = _exchanged(basis[active], enters[active])
    return slope


def _deepest(hulls: Array, places: Array, slope: Array, above: Array, begin: IntArray) -> tuple[Array, Array]:
    """Return the deepest differences (P, 3) for slopes (P, 2), and their heights, (P,).

    above : heights of the places above the planes through the origin, (K,); begin : first place of each hull
    """
    under = hulls[..., 2] - np.einsum("pmd,pd->pm", hulls[..., :2], slope)
    point = hulls[np.arange(len(hulls)), under.argmin(axis=1)]
    highest = np.maximum.reduceat(above, begin)
    owner = np.repeat(np.arange(len(begin)), np.diff(np.append(begin, len(places))))
    at = np.flatnonzero(above == highest[owner])
    first = at[np.searchsorted(owner[at], np.arange(len(begin)))]
    return point - places[first], under.min(axis=1) - highest


def _plane(basis: Array) -> tuple[Array, Array]:
    """Return the slopes (K, 2) of the planes through three differences (K, 3, 3), and their heights at 0."""
    normal = cross(basis[:, 1] - basis[:, 0], basis[:, 2] - basis[:, 0])
    up = np.where(np.abs(normal[:, 2]) > 1e-12, normal[:, 2], np.inf)
    slope = -normal[:, :2] / up[:, None]
    return slope, basis[:, 0, 2] - dot(basis[:, 0, :2], slope)


def _exchanged(basis: Array, enters: Array) -> Array:
    """Return the bases (K, 3, 3) with one difference exchanged; they still surround 0."""
    shares, its = _weights(basis, np.zeros((len(basis), 2))), _weights(basis, enters[:, :2])
    ratio = np.where(its > 1e-12, np.maximum(shares, 0.0) / np.maximum(its, 1e-12), np.inf)
    basis = basis.copy()
    basis[np.arange(len(basis)), ratio.argmin(axis=1)] = enters
    return basis


def _weights(basis: Array, p: Array) -> Array:
    """Return the barycentric coordinates (K, 3) of points (K, 2) in the corners of bases, in the plan."""
    plan = basis[..., :2]
    sides, offset = plan[:, _NEXT] - plan, p[:, None] - plan
    areas = (sides[..., 0] * offset[..., 1] - sides[..., 1] * offset[..., 0])[:, _NEXT]
    total = areas.sum(axis=1, keepdims=True)
    return areas / np.where(np.abs(total) > TINY_SQUARE, total, np.inf)
