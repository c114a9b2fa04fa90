"""Ground made of triangles: its height under points, and whether curves stay above it.

Height is vertical: z - h(x, y). Outside of all triangles there is no ground; nothing is continued beyond the
last one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array, bernstein_basis
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Pieces
from shotc.geom.surface.distance import SurfaceBound, inf_distance
from shotc.geom.surface.near import AT_ONCE, nearest
from shotc.geom.surface.tree import Surface, surface_of, under_points
from shotc.geom.surface.triangles import TINY

EDGE = 1e-6
"""Metres: a curve that comes as near as this to where the ground ends is not proved to stay above it."""
LOOKS = 9
"""Places a piece at which it is looked how far a curve leaves the ground."""
_NEXT = [1, 2, 0]
_WEIGHT = 1e-9
"""Share of a triangle by which a point may be outside and still be in it: points on edges are in both."""


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """Ground.

    surface : its triangles
    edge    : the sides that only one triangle has, at z = 0; where the ground ends, holes included
    """

    surface: Surface
    edge: Surface


@dataclass(frozen=True, slots=True)
class NoGround:
    """A curve leaves the ground.

    at    : the parameter at which it is farthest out, of the places that were looked at
    place : (x, y) there, metres of W
    by    : how far out, metres; 0 where it comes too near to the end of the ground, or crosses a gap
    """

    at: float
    place: tuple[float, float]
    by: float


def ground_of(corners: Array, faces: IntArray) -> Ground:
    """Make ground of corners (V, 3), metres of W, and of triangles of their numbers (T, 3).

    Neighbours share corners, and no triangle lies above another. Upright ones are no ground, for their
    neighbours are. ValueError where a corner is not finite.
    """
    surface = surface_of(corners[faces].reshape(-1, 3, 3))
    ends = corners[_lone_sides(faces, len(corners))] * np.array([1.0, 1.0, 0.0])
    return Ground(surface, surface_of(ends[:, [0, 1, 1]]))


def _lone_sides(faces: IntArray, count: int) -> IntArray:
    """Return the sides, as pairs of corners (E, 2), that one triangle has alone."""
    low, high = np.minimum(faces, faces[:, _NEXT]), np.maximum(faces, faces[:, _NEXT])
    side, times = np.unique((low.astype(np.int64) * count + high).ravel(), return_counts=True)
    lone = side[times == 1]
    return np.stack([lone // count, lone % count], axis=1).astype(np.intp)


@dataclass(frozen=True, slots=True, eq=False)
class Under:
    """What is under points.

    height   : (K,), metres of W; NaN where there is no ground
    triangle : (K,), in the order of the surface; -1 where there is no ground
    """

    height: Array
    triangle: IntArray


def height_at(ground: Ground, xy: Array) -> Array:
    """Return the height of the ground at points (K, 2), metres of W; NaN where there is none."""
    return under(ground, xy).height


def under(ground: Ground, xy: Array) -> Under:
    """Return the ground under points (K, 2), metres of W."""
    out = Under(np.full(len(xy), np.nan), np.full(len(xy), -1))
    for start in range(0, len(xy), AT_ONCE):
        part = slice(start, start + AT_ONCE)
        _under(ground.surface, xy[part], Under(out.height[part], out.triangle[part]))
    return out


def _under(surface: Surface, xy: Array, out: Under) -> None:
    pairs = under_points(surface, xy)
    height = heights(surface.triangles[pairs.triangle], xy[pairs.item])
    inside = ~np.isnan(height)
    pairs, height = pairs.pick(inside), height[inside]
    item, best = pairs.best(-height)
    out.height[item], out.triangle[item] = height[best], pairs.triangle[best]


def heights(triangles: Array, xy: Array) -> Array:
    """Return the height of each triangle (K, 3, 3) at a point (K, 2), NaN where it is not in it."""
    plan = triangles[..., :2]
    edges, offset = plan[:, _NEXT] - plan, xy[:, None] - plan
    areas = edges[..., 0] * offset[..., 1] - edges[..., 1] * offset[..., 0]
    weights = areas[:, _NEXT]
    total = weights[:, 0] + weights[:, 1] + weights[:, 2]
    share = weights / np.where(np.abs(total) > TINY, total, np.nan)[:, None]
    share[~(np.minimum(np.minimum(share[:, 0], share[:, 1]), share[:, 2]) >= -_WEIGHT)] = np.nan
    share = np.clip(share, 0.0, 1.0)
    total = share[:, 0] + share[:, 1] + share[:, 2]
    return np.asarray(np.einsum("kv,kv->k", share, triangles[..., 2]) / total)


def leaves(ground: Ground, pieces: Pieces) -> NoGround | None:
    """Prove that curves stay above ground, or return where they do not: in the plan, at any height.

    pieces : shape (M, n + 1, 3), metres of W
    A piece that begins above ground and never comes to where it ends is above it all the way.
    """
    if not len(pieces):
        return None
    begins = np.ones(len(pieces), dtype=bool)  # a piece that goes on where another ended is that one's heir
    begins[1:] = (pieces.ctrl[1:, 0, :2] != pieces.ctrl[:-1, -1, :2]).any(axis=1)
    if np.isnan(height_at(ground, pieces.ctrl[begins, 0, :2])).any():
        return _farthest_out(ground, pieces)
    flat = pieces.ctrl * np.array([1.0, 1.0, 0.0])
    found = inf_distance(Pieces(pieces.low, pieces.high, flat), ground.edge, _apart_at_all)
    if found.proven > 0.0:
        return None
    return _farthest_out(ground, pieces) or _touched(pieces, found)


def _apart_at_all(distance: float) -> float:
    return max(0.5 * distance, EDGE)


def _touched(pieces: Pieces, found: SurfaceBound) -> NoGround:
    i = found.piece
    x = (found.at - pieces.low[i]) / (pieces.high[i] - pieces.low[i])
    place = bernstein_basis(pieces.ctrl.shape[1] - 1, x) @ pieces.ctrl[i, :, :2]
    return NoGround(found.at, (float(place[0]), float(place[1])), 0.0)


def _farthest_out(ground: Ground, pieces: Pieces) -> NoGround | None:
    x = np.linspace(0.0, 1.0, LOOKS)
    basis = bernstein_basis(pieces.ctrl.shape[1] - 1, x)
    places = np.einsum("xk,mkd->mxd", basis, pieces.ctrl[..., :2]).reshape(-1, 2)
    times = (pieces.low[:, None] + x * (pieces.high - pieces.low)[:, None]).ravel()
    out = np.isnan(height_at(ground, places))
    if not out.any():
        return None
    places, times = places[out], times[out]
    by = nearest(ground.edge, np.column_stack([places, np.zeros(len(places))])).distance
    k = int(np.argmax(by))
    return NoGround(float(times[k]), (float(places[k, 0]), float(places[k, 1])), float(by[k]))
