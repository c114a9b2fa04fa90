"""Half-spaces that keep pieces of a curve away from the triangles of a surface, for convex programmes.

They grow greedily: a plane between a piece and the nearest triangle that no plane of the piece leaves behind
it yet, then the next, for all pieces at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.surface.near import within
from shotc.geom.surface.tree import Pairs, Surface
from shotc.geom.surface.triangles import closest, cross, dot

MOST = 32
"""Planes of a piece: one that needs more is crowded."""
STEPS = 24
"""Towards the nearest point of a hull."""
CLOSE = 1e-3
"""Share of a distance that a gap may fall short of it to be as wide as any."""
TOUCHES = 1e-9
"""Metres from a triangle at which a point is on it."""
_TURN = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
WAYS_OUT = np.vstack([np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros(8)]), [[0.0, 0.0, 1.0]]])
"""Normals that are tried beside others, (9, 3)."""

Kept = Callable[[Array], Array]
"""The margin that is kept beyond a clearance, >= 0, given how much more than it there is; metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Planes:
    """Half-spaces n . p >= offset for all points of pieces.

    piece    : shape (R,), of the hulls given
    triangle : shape (R,), of those that the surface was made of: what the plane was put before; -1 is ground
    normal   : shape (R, 3), units
    offset   : shape (R,), metres, clearance and margin included
    crowded  : shape (P,), pieces of the hulls given that are not kept from all that is near
    """

    piece: IntArray
    triangle: IntArray
    normal: Array
    offset: Array
    crowded: Mask


def half_spaces(surface: Surface, hulls: Array, clearance: float, reach: float, kept: Kept) -> Planes:
    """Put planes between pieces and the triangles that are nearer than clearance and reach, metres.

    hulls : shape (P, m, 3), points whose hull holds each piece
    A piece all of whose points keep its half-spaces keeps the clearance from those triangles, unless it
    is crowded. One that is itself too near gets planes at the full clearance, which its points do not meet.
    """
    found: list[Planes] = []
    none = np.zeros(len(hulls), dtype=bool)
    pairs, far = _candidates(surface, hulls, clearance + reach)
    for _ in range(MOST):
        if not len(pairs):
            break
        piece, first = pairs.best(far)
        chosen = pairs.triangle[first]
        normal, gap = separate(surface.triangles[chosen], hulls[piece])
        behind = support(surface.triangles[chosen], normal) + kept(gap - clearance)
        near = gap < clearance + reach
        found.append(
            Planes(piece[near], surface.source[chosen[near]], normal[near], behind[near] + clearance, none)
        )
        pairs, far = _still_before(surface, pairs, far, (piece, normal, behind))
    crowded = none.copy()
    crowded[pairs.item] = True
    return _together(found, crowded)


def _together(found: list[Planes], crowded: Mask) -> Planes:
    """Return all planes in one, of pieces some of which are crowded."""
    return Planes(
        np.concatenate([np.zeros(0, dtype=np.intp), *(f.piece for f in found)]),
        np.concatenate([np.zeros(0, dtype=np.intp), *(f.triangle for f in found)]),
        np.concatenate([np.zeros((0, 3)), *(f.normal for f in found)]),
        np.concatenate([np.zeros(0), *(f.offset for f in found)]),
        crowded,
    )


def _candidates(surface: Surface, hulls: Array, reach: float) -> tuple[Pairs, Array]:
    """Return the pairs that may be nearer than ``reach``, and about how far they are, metres."""
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


def _still_before(
    surface: Surface, pairs: Pairs, far: Array, planes: tuple[IntArray, Array, Array]
) -> tuple[Pairs, Array]:
    """Return the pairs whose triangles the new planes, one a piece, do not leave behind them."""
    piece, normal, behind = planes
    which = np.searchsorted(piece, pairs.item)
    reaches = support(surface.triangles[pairs.triangle], normal[which])
    keep = reaches > behind[which] + TOUCHES
    return pairs.pick(keep), far[keep]


def support(triangles: Array, normal: Array) -> Array:
    """Return the most of n . x over each triangle (K, 3, 3) for a normal (K, 3); shape (K,)."""
    return np.asarray(np.einsum("kvd,kd->kv", triangles, normal).max(axis=1))


def separate(triangles: Array, hulls: Array) -> tuple[Array, Array]:
    """Return planes between triangles (K, 3, 3) and the hulls of m points (K, m, 3).

    Returns unit normals (K, 3) that point away from the triangles, and the gaps (K,): the least of n . p
    less the most of n . x, metres. A positive gap proves the distance and is all but as wide; a negative
    one says how deep the hull reaches in. The nearest point of the hull is sought by steps towards the
    point of it that lies deepest (Frank and Wolfe 1956), the best normal kept.
    """
    normal, gap = _first(triangles, hulls)
    each = np.arange(len(hulls))
    at = hulls[each, _distances(triangles, hulls).argmin(axis=1)]
    for _ in range(STEPS):
        n, far = _away(triangles, at)
        its = _gaps(triangles, hulls, n[:, None])[:, 0]
        wins = its > gap
        normal[wins], gap[wins] = n[wins], its[wins]
        if ((gap >= (1.0 - CLOSE) * far) | (far <= TOUCHES)).all():
            break
        step = hulls[each, np.einsum("kmd,kd->km", hulls, n).argmin(axis=1)] - at
        x = np.clip(-far * dot(n, step) / np.maximum(dot(step, step), 1e-18), 0.0, 1.0)
        at = at + x[:, None] * step
    return normal, gap


def _first(triangles: Array, hulls: Array) -> tuple[Array, Array]:
    """Return the best of the normals that are tried at once, and its gap."""
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    chord = hulls[:, -1] - hulls[:, 0]
    sides = np.stack([one, other, other - one], axis=1)
    level = cross(one, other)[:, None]
    across = cross(sides, chord[:, None])  # where the chord passes a side, the nearest way is across both
    outward = cross(sides, level)
    ends = np.stack([_away(triangles, hulls[:, end])[0] for end in (0, -1)], axis=1)
    ways = np.concatenate([level, across, outward, _from_corners(triangles, hulls), ends], axis=1)
    ways = np.concatenate([ways, -ways], axis=1)
    length = np.sqrt(dot(ways, ways))[..., None]
    ways = np.where(length > 0.0, ways / np.maximum(length, 1e-300), WAYS_OUT[-1])
    ways = np.concatenate([ways, np.broadcast_to(WAYS_OUT, (len(hulls), *WAYS_OUT.shape))], axis=1)
    gaps = _gaps(triangles, hulls, ways)
    k, each = gaps.argmax(axis=1), np.arange(len(hulls))
    return ways[each, k], gaps[each, k]


def _from_corners(triangles: Array, hulls: Array) -> Array:
    """Return the ways (K, 3, 3) from corners of triangles to the nearest points of the hulls' chords."""
    start, chord = hulls[:, :1], hulls[:, -1:] - hulls[:, :1]
    share = dot(triangles - start, chord) / np.maximum(dot(chord, chord), 1e-18)
    return np.asarray(start + np.clip(share, 0.0, 1.0)[..., None] * chord - triangles)


def _gaps(triangles: Array, hulls: Array, normals: Array) -> Array:
    """Return the gaps (K, W) that normals (K, W, 3) leave between triangles and hulls."""
    least = np.einsum("kmd,kwd->kwm", hulls, normals).min(axis=2)
    most = np.einsum("kvd,kwd->kwv", triangles, normals).max(axis=2)
    return np.asarray(least - most)


def _distances(triangles: Array, hulls: Array) -> Array:
    count = hulls.shape[1]
    found = closest(np.repeat(triangles, count, axis=0), hulls.reshape(-1, 3))
    return found.distance.reshape(-1, count)


def _away(triangles: Array, p: Array) -> tuple[Array, Array]:
    """Return unit directions from triangles to points (K, 3), upwards from points on them, and how far."""
    found = closest(triangles, p)
    away = p - found.point
    outside = (found.distance > TOUCHES)[:, None]
    return np.where(
        outside, away / np.maximum(found.distance, TOUCHES)[:, None], WAYS_OUT[-1]
    ), found.distance
