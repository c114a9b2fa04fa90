"""Half-spaces that keep pieces of a curve away from the triangles of a surface, for convex programmes.

The method is greedy, for all pieces at once: it adds a plane between a piece and the nearest triangle that is
not behind a plane of the piece yet, and repeats.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.near import within
from shotc.geom.surface.tree import Pairs, Surface
from shotc.geom.surface.triangles import closest, cross, dot

MOST_PLANES = 32
"""Most planes of a piece; a piece that needs more is crowded."""
NEAREST_POINT_STEPS = 24
"""Steps towards the nearest point of a hull."""
CLOSE_SHARE = 1e-3
"""Relative difference of a gap and the distance at which the gap counts as optimal."""
TOUCHES_M = 1e-9
"""Distance from a triangle up to which a point is on it, metres."""
_TURN = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
WAYS_OUT = np.vstack([np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros(8)]), [[0.0, 0.0, 1.0]]])
"""Additional candidate normals, (9, 3)."""

Kept = Callable[[Array], Array]
"""The margin added to a clearance, >= 0, as a function of the slack over the clearance; metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Planes:
    """Half-spaces n . p >= offset for all points of pieces.

    piece    : shape (R,), index of the hull
    triangle : shape (R,), index of the plane's triangle among those that the surface was made of; -1 for
        ground
    normal   : shape (R, 3), unit vectors
    offset   : shape (R,), metres, with clearance and margin
    crowded  : shape (P,), whether near triangles of a piece are left without a plane
    """

    piece: IntArray
    triangle: IntArray
    normal: Array
    offset: Array
    crowded: Mask


def half_spaces(surface: Surface, hulls: Array, clearance: float, reach: float, margin: Kept) -> Planes:
    """Return half-spaces between pieces and the triangles that are nearer than clearance plus reach, metres.

    hulls : shape (P, m, 3), points whose hull contains each piece
    If all points of a piece keep its half-spaces, the piece keeps the clearance from these triangles, unless
    it is crowded. A piece that is already too near gets planes at the full clearance, which its points
    violate.
    """
    planes: list[Planes] = []
    none = np.zeros(len(hulls), dtype=bool)
    pairs, far = _candidates(surface, hulls, clearance + reach)
    for _ in range(MOST_PLANES):
        if not len(pairs):
            break
        piece, first = pairs.best(far)
        chosen = pairs.triangle[first]
        normal, gap = separate(surface.triangles[chosen], hulls[piece])
        behind = support(surface.triangles[chosen], normal) + margin(gap - clearance)
        near = gap < clearance + reach
        planes.append(
            Planes(piece[near], surface.source[chosen[near]], normal[near], behind[near] + clearance, none)
        )
        pairs, far = _still_before(surface, pairs, far, _Cuts(piece, normal, behind))
    crowded = none.copy()
    crowded[pairs.item] = True
    return _together(planes, crowded)


def _together(parts: list[Planes], crowded: Mask) -> Planes:
    """Return the union of planes; crowded : shape (P,)."""
    return Planes(
        np.concatenate([np.zeros(0, dtype=np.intp), *(f.piece for f in parts)]),
        np.concatenate([np.zeros(0, dtype=np.intp), *(f.triangle for f in parts)]),
        np.concatenate([np.zeros((0, 3)), *(f.normal for f in parts)]),
        np.concatenate([np.zeros(0), *(f.offset for f in parts)]),
        crowded,
    )


def _candidates(surface: Surface, hulls: Array, reach: float) -> tuple[Pairs, Array]:
    """Return the pairs that may be nearer than ``reach``, and their approximate distances, metres."""
    pairs = within(surface, hulls.min(axis=1), hulls.max(axis=1), reach)
    middle = hulls.mean(axis=1)
    size = np.sqrt(dot(hulls - middle[:, None], hulls - middle[:, None]).max(axis=1))
    far = closest(surface.triangles[pairs.triangle], middle[pairs.item]).distance
    near = far < reach + size[pairs.item]
    pairs, far = pairs.pick(near), far[near]
    for end in (0, -1):
        its = closest(surface.triangles[pairs.triangle], hulls[pairs.item, end]).distance
        far = np.minimum(far, its)
    return pairs, far


class _Cuts(NamedTuple):
    """New planes, one a piece: the pieces, ascending, the unit normals, and the offsets, metres."""

    piece: IntArray
    normal: Array
    offset: Array


def _still_before(surface: Surface, pairs: Pairs, far: Array, cuts: _Cuts) -> tuple[Pairs, Array]:
    """Return the pairs whose triangles are not behind the new planes."""
    which = np.searchsorted(cuts.piece, pairs.item)
    reaches = support(surface.triangles[pairs.triangle], cuts.normal[which])
    keep = reaches > cuts.offset[which] + TOUCHES_M
    return pairs.pick(keep), far[keep]


def support(triangles: Array, normal: Array) -> Array:
    """Return the maximum of n . x over each triangle (K, 3, 3) for normals (K, 3), shape (K,)."""
    return np.asarray(np.einsum("kvd,kd->kv", triangles, normal).max(axis=1))


def separate(triangles: Array, hulls: Array) -> tuple[Array, Array]:
    """Return separating planes between triangles (K, 3, 3) and the hulls of m points (K, m, 3).

    Returns unit normals (K, 3) that point away from the triangles, and the gaps (K,): the minimum of n . p
    over the hull minus the maximum of n . x over the triangle, metres. A positive gap proves the distance and
    is almost equal to it. A negative gap is minus the depth of the intersection. The nearest point of the
    hull is found by steps towards its deepest point (Frank and Wolfe 1956); the best normal is kept.
    """
    normal, gap = _first(triangles, hulls)
    each = np.arange(len(hulls))
    at = hulls[each, _distances(triangles, hulls).argmin(axis=1)]
    for _ in range(NEAREST_POINT_STEPS):
        n, far = _directions(triangles, at)
        its = _gaps(triangles, hulls, n[:, None])[:, 0]
        wins = its > gap
        normal[wins], gap[wins] = n[wins], its[wins]
        if ((gap >= (1.0 - CLOSE_SHARE) * far) | (far <= TOUCHES_M)).all():
            break
        step = hulls[each, np.einsum("kmd,kd->km", hulls, n).argmin(axis=1)] - at
        x = np.clip(-far * dot(n, step) / np.maximum(dot(step, step), 1e-18), 0.0, 1.0)
        at = at + x[:, None] * step
    return normal, gap


def _first(triangles: Array, hulls: Array) -> tuple[Array, Array]:
    """Return the best of the candidate normals, (K, 3), and its gap, (K,)."""
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    chord = hulls[:, -1] - hulls[:, 0]
    sides = np.stack([one, other, other - one], axis=1)
    level = cross(one, other)[:, None]
    across = cross(sides, chord[:, None])  # the shortest line between chord and side is normal to both
    outward = cross(sides, level)
    ends = np.stack([_directions(triangles, hulls[:, end])[0] for end in (0, -1)], axis=1)
    normals = np.concatenate([level, across, outward, _from_corners(triangles, hulls), ends], axis=1)
    normals = np.concatenate([normals, -normals], axis=1)
    length = np.sqrt(dot(normals, normals))[..., None]
    normals = np.where(length > 0.0, normals / np.maximum(length, 1e-300), WAYS_OUT[-1])
    normals = np.concatenate([normals, np.broadcast_to(WAYS_OUT, (len(hulls), *WAYS_OUT.shape))], axis=1)
    gaps = _gaps(triangles, hulls, normals)
    k, each = gaps.argmax(axis=1), np.arange(len(hulls))
    return normals[each, k], gaps[each, k]


def _from_corners(triangles: Array, hulls: Array) -> Array:
    """Return the vectors (K, 3, 3) from corners of triangles to the nearest points of the hulls' chords."""
    start, chord = hulls[:, :1], hulls[:, -1:] - hulls[:, :1]
    share = dot(triangles - start, chord) / np.maximum(dot(chord, chord), 1e-18)
    return np.asarray(start + np.clip(share, 0.0, 1.0)[..., None] * chord - triangles)


def _gaps(triangles: Array, hulls: Array, normals: Array) -> Array:
    """Return the gaps (K, W) between triangles and hulls along normals (K, W, 3)."""
    least = np.einsum("kmd,kwd->kwm", hulls, normals).min(axis=2)
    most = np.einsum("kvd,kwd->kwv", triangles, normals).max(axis=2)
    return np.asarray(least - most)


def _distances(triangles: Array, hulls: Array) -> Array:
    count = hulls.shape[1]
    closest_points = closest(np.repeat(triangles, count, axis=0), hulls.reshape(-1, 3))
    return closest_points.distance.reshape(-1, count)


def _directions(triangles: Array, p: Array) -> tuple[Array, Array]:
    """Return unit directions (K, 3) from triangles to points (K, 3) (up on them), and distances (K,)."""
    closest_points = closest(triangles, p)
    offset = p - closest_points.point
    outside = (closest_points.distance > TOUCHES_M)[:, None]
    return np.where(
        outside, offset / np.maximum(closest_points.distance, TOUCHES_M)[:, None], WAYS_OUT[-1]
    ), closest_points.distance
