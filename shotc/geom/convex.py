"""Upright convex solids for many points at once: closest points, support, distances, separation.

The array counterpart of ``geom.solids``, for the planner's inner loops.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Prism, Solid

FAR = 1e5  # stands for an unbounded height, metres
BoolArray = NDArray[np.bool_]
_TURN = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
# Normals to try for points inside a solid, which have no closest point to be pushed away from.
WAYS_OUT = np.vstack([np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros(8)]), [[0.0, 0.0, 1.0]]])
_UP = np.array([0.0, 0.0, 1.0])
TOUCHES = 1e-9  # metres from a solid at which a point is in it
CLOSE = 1e-3  # share of a distance that a gap may fall short of it to be as wide as any
SETTLED = 1e-7  # of a segment's length, to which its nearest point is found
STEPS = 60  # at most; a dozen do
TINY = 1e-18  # m^2 instead of a slope that is none


def bounded(part: Solid) -> Solid:
    """Return the solid with infinite heights replaced by ones no mission reaches."""
    return part._replace(bottom=max(part.bottom, -FAR), top=min(part.top, FAR))


def closest_points(part: Solid, p: Array) -> Array:
    """Return the points of a convex solid closest to p, shape (..., 3); p itself where it is inside."""
    z = np.clip(p[..., 2:], part.bottom, part.top)
    if isinstance(part, Cylinder):
        centre = np.array(part.centre)
        away = p[..., :2] - centre
        distance = np.hypot(away[..., :1], away[..., 1:])
        scale = np.minimum(1.0, part.radius / np.maximum(distance, 1e-12))
        return np.concatenate([centre + away * scale, z], axis=-1)
    return np.concatenate([_closest_on_polygon(part, p[..., :2]), z], axis=-1)


def _closest_on_polygon(part: Prism, xy: Array) -> Array:
    corners = np.array(part.points, dtype=np.float64)
    sides = np.roll(corners, -1, axis=0) - corners
    offset = xy[..., None, :] - corners
    length2 = np.maximum((sides**2).sum(axis=1), 1e-18)
    along = np.clip((offset * sides).sum(axis=-1) / length2, 0.0, 1.0)
    feet = corners + along[..., None] * sides
    nearest = ((xy[..., None, :] - feet) ** 2).sum(axis=-1).argmin(axis=-1)
    foot = np.take_along_axis(feet, nearest[..., None, None], axis=-2)[..., 0, :]
    turn = sides[:, 0] * offset[..., 1] - sides[:, 1] * offset[..., 0]
    inside = turn.min(axis=-1, keepdims=True) >= 0
    return np.where(inside, xy, foot)


def support(part: Solid, n: Array) -> Array:
    """Return max of n.x over the solid for directions of shape (..., 3); shape (...)."""
    high = np.maximum(n[..., 2] * part.bottom, n[..., 2] * part.top)
    if isinstance(part, Cylinder):
        flat = n[..., :2] @ np.array(part.centre) + part.radius * np.linalg.norm(n[..., :2], axis=-1)
    else:
        flat = (n[..., :2] @ np.array(part.points).T).max(axis=-1)
    return np.asarray(flat + high)


def distances(part: Solid, p: Array) -> Array:
    """Return how far points of shape (..., 3) are from the solid, 0 inside, metres."""
    return np.asarray(np.linalg.norm(p - closest_points(part, p), axis=-1))


def segment_distances(part: Solid, a: Array, b: Array) -> Array:
    """Return the distance of segments a-b, shapes (N, 3), to the solid; shape (N,), metres.

    Good to the square of SETTLED of their length, and to SETTLED of it where they meet the solid.
    """
    near = distances(part, _nearest_on_segments(part, a, b))
    return np.asarray(np.minimum.reduce([near, distances(part, a), distances(part, b)]))


def _nearest_on_segments(part: Solid, a: Array, b: Array) -> Array:
    """Return the point of each segment, shapes (N, 3), that is nearest to the solid, or one that is in it.

    The squared distance to a convex set is convex and smooth, so that its slope rises along a segment; where
    that is 0 is found by false position, in which an end that stays twice counts half (Illinois).
    """
    side = b - a

    def slope(share: Array) -> Array:
        p = a + share[:, None] * side
        return np.asarray(np.einsum("nd,nd->n", p - closest_points(part, p), side))

    low, high = np.zeros(len(a)), np.ones(len(a))
    falls, rises = np.minimum(slope(low), 0.0), np.maximum(slope(high), 0.0)
    level = SETTLED**2 * np.einsum("nd,nd->n", side, side) + TINY
    before, at = np.zeros(len(a)), low
    for _ in range(STEPS):
        at = low - falls / np.maximum(rises - falls, TINY) * (high - low)
        now = slope(at)
        beyond = now >= 0.0
        low, high = np.where(beyond, low, at), np.where(beyond, at, high)
        falls = np.where(beyond, np.where(before > 0.0, 0.5 * falls, falls), now)
        rises = np.where(beyond, now, np.where(before < 0.0, 0.5 * rises, rises))
        before = np.where(beyond, 1.0, -1.0)
        if ((high - low <= SETTLED) | (np.abs(now) <= level)).all():
            break
    return np.asarray(a + at[:, None] * side)


def separate(part: Solid, hulls: Array, rounds: int = 24) -> tuple[Array, Array]:
    """Return planes between point sets and a solid.

    hulls : shape (N, m, 3), each the hull of m points
    Returns unit normals (N, 3) that point away from the solid, and the gaps (N,): the least of
    n.p - support(n) over each set, metres. A positive gap proves the distance; it is within a few
    per cent of the true distance (alternating projections on the sets, best normal kept). A negative
    one says how deep the set reaches in.
    """
    starts = np.concatenate([hulls.mean(axis=1, keepdims=True), hulls], axis=1)
    if hulls.shape[1] == 2:  # projections converge slowly along a chord; its nearest point is known
        nearest = _nearest_on_segments(part, hulls[:, 0], hulls[:, 1])
        starts = np.concatenate([starts, nearest[:, None]], axis=1)
    ways_out = np.broadcast_to(WAYS_OUT, (len(hulls), *WAYS_OUT.shape))
    towards, _ = _away(part, starts)
    best, best_gap = _widest(part, hulls, np.concatenate([ways_out, towards], axis=1))
    at = np.take_along_axis(hulls, distances(part, hulls).argmin(axis=1)[:, None, None], axis=1)[:, 0]
    for _ in range(rounds):
        n, far = _away(part, at)
        best, best_gap = _better(best, best_gap, n, gaps(part, hulls, n))
        # No plane has a wider gap than the distance of two points; from one inside no way leads on.
        if ((best_gap >= (1.0 - CLOSE) * far) | (far <= TOUCHES)).all():
            break
        # Frank-Wolfe step: towards the point of the hull that lies deepest along the normal.
        deepest = np.einsum("nmd,nd->nm", hulls, n).argmin(axis=1)
        vertex = np.take_along_axis(hulls, deepest[:, None, None], axis=1)[:, 0]
        step = vertex - at
        length2 = np.maximum((step**2).sum(axis=1), 1e-18)
        x = np.clip(-far * (n * step).sum(axis=1) / length2, 0.0, 1.0)
        at = at + x[:, None] * step
    return best, best_gap


def gaps(part: Solid, hulls: Array, normals: Array) -> Array:
    """Return the least n.p - support(n) of each point set (N, m, 3) for unit normals (N, 3)."""
    return np.asarray(np.einsum("nmd,nd->nm", hulls, normals).min(axis=1) - support(part, normals))


def _away(part: Solid, p: Array) -> tuple[Array, Array]:
    """Return unit directions from a solid to points (..., 3), upwards from inside, and how far; (...)."""
    away = p - closest_points(part, p)
    far = np.linalg.norm(away, axis=-1)
    outside = (far > TOUCHES)[..., None]
    return np.where(outside, away / np.maximum(far, TOUCHES)[..., None], _UP), far


def _widest(part: Solid, hulls: Array, normals: Array) -> tuple[Array, Array]:
    """Return, of several unit normals (N, K, 3), the one with the widest gap to each set, and that gap."""
    least = np.einsum("nmd,nkd->nkm", hulls, normals).min(axis=2) - support(part, normals)
    k = least.argmax(axis=1)
    each = np.arange(len(hulls))
    return normals[each, k], least[each, k]


def _better(best: Array, best_gap: Array, n: Array, gap: Array) -> tuple[Array, Array]:
    wins = gap > best_gap
    return np.where(wins[:, None], n, best), np.where(wins, gap, best_gap)
