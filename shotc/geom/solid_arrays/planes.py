"""Separating planes between convex solids and sets of points; each proves the distance of the whole hull."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import NO_AREA_M2, closest_points, distances, support
from shotc.geom.solid_arrays.segments import nearest_on_segments
from shotc.geom.solids import Solid

_TURN = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
_UP = np.array([0.0, 0.0, 1.0])

WAYS_OUT = np.vstack([np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros(8)]), _UP])
"""Candidate normals for points inside a solid, which have no direction from a closest point."""

TOUCHES_M = 1e-9
"""Distance from a solid up to which a point counts as inside."""

CLOSE_SHARE = 1e-3
"""Relative difference of a gap and the distance at which the gap counts as optimal."""


def separate(part: Solid, hulls: Array, rounds: int = 24) -> tuple[Array, Array]:
    """Return separating planes between point sets and a convex solid.

    hulls : shape (N, m, 3), each the hull of m points
    Returns unit normals (N, 3) that point away from the solid, and the gaps (N,): the least of
    n.p - support(n) over each set, metres. A positive gap proves the distance. It is within a few per cent of
    it for a set that is at most a few times as wide as it is far (alternating projections on the sets, the
    best normal is kept), and may be far less for a wider one. A negative gap proves nothing; for a set inside
    the solid it is minus its depth.
    """
    starts = np.concatenate([hulls.mean(axis=1, keepdims=True), hulls], axis=1)
    if hulls.shape[1] == 2:  # projections converge slowly along a chord, whose nearest point is known
        nearest = nearest_on_segments(part, hulls[:, 0], hulls[:, 1])
        starts = np.concatenate([starts, nearest[:, None]], axis=1)
    ways_out = np.broadcast_to(WAYS_OUT, (len(hulls), *WAYS_OUT.shape))
    towards, _ = _directions(part, starts)
    best, best_gap = _widest(part, hulls, np.concatenate([ways_out, towards], axis=1))
    at = np.take_along_axis(hulls, distances(part, hulls).argmin(axis=1)[:, None, None], axis=1)[:, 0]
    for _ in range(rounds):
        n, far = _directions(part, at)
        best, best_gap = _better(best, best_gap, n, gaps(part, hulls, n))
        # No gap exceeds the distance of two points. A point inside gives no new direction.
        if ((best_gap >= (1.0 - CLOSE_SHARE) * far) | (far <= TOUCHES_M)).all():
            break
        # Frank-Wolfe step: towards the point of the hull that lies deepest along the normal.
        deepest = np.einsum("nmd,nd->nm", hulls, n).argmin(axis=1)
        vertex = np.take_along_axis(hulls, deepest[:, None, None], axis=1)[:, 0]
        step = vertex - at
        length2 = np.maximum((step**2).sum(axis=1), NO_AREA_M2)
        x = np.clip(-far * (n * step).sum(axis=1) / length2, 0.0, 1.0)
        at = at + x[:, None] * step
    return best, best_gap


def gaps(part: Solid, hulls: Array, normals: Array) -> Array:
    """Return the least n.p - support(n) of each point set (N, m, 3) for unit normals (N, 3)."""
    return np.asarray(np.einsum("nmd,nd->nm", hulls, normals).min(axis=1) - support(part, normals))


def _directions(part: Solid, p: Array) -> tuple[Array, Array]:
    """Return unit directions (..., 3) from a solid to points (..., 3), up if inside, and distances (...)."""
    offset = p - closest_points(part, p)
    far = np.linalg.norm(offset, axis=-1)
    outside = (far > TOUCHES_M)[..., None]
    return np.where(outside, offset / np.maximum(far, TOUCHES_M)[..., None], _UP), far


def _widest(part: Solid, hulls: Array, normals: Array) -> tuple[Array, Array]:
    """Return the normal with the widest gap to each set among unit normals (N, K, 3), and that gap."""
    least = np.einsum("nmd,nkd->nkm", hulls, normals).min(axis=2) - support(part, normals)
    k = least.argmax(axis=1)
    each = np.arange(len(hulls))
    return normals[each, k], least[each, k]


def _better(best: Array, best_gap: Array, n: Array, gap: Array) -> tuple[Array, Array]:
    wins = gap > best_gap
    return np.where(wins[:, None], n, best), np.where(wins, gap, best_gap)
