"""Ground of triangles: its height below points, and a proof that curves have ground below them.

Height is vertical: z - h(x, y). Outside of all triangles there is no ground; it is not extrapolated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array, bernstein_basis
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Pieces
from shotc.geom.surface.distance import SurfaceBound, inf_distance
from shotc.geom.surface.near import BATCH_ITEMS, nearest
from shotc.geom.surface.tree import Surface, surface_of, under_points
from shotc.geom.surface.triangles import TINY_SQUARE

EDGE_M = 1e-6
"""Least distance from the edge of the ground, metres; a nearer curve is not proved to stay above ground."""
SAMPLES_PER_PIECE = 9
"""Samples a piece for the distance by which a curve leaves the ground."""
_NEXT = [1, 2, 0]
_EDGE_WEIGHT = 1e-9
"""Tolerance of a point in a triangle, as a barycentric coordinate: points on edges are in both triangles."""


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """Ground.

    surface : its triangles
    edge    : the sides of one triangle only, at z = 0: the boundary of the ground, with that of holes
    """

    surface: Surface
    edge: Surface


@dataclass(frozen=True, slots=True)
class NoGround:
    """A curve that leaves the ground.

    at    : the parameter of the farthest sample outside
    place : (x, y) there, metres of W
    by    : its distance from the ground, metres; 0 if the curve comes too near to the edge, or crosses a gap
    """

    at: float
    place: tuple[float, float]
    by: float


def ground_of(corners: Array, faces: IntArray) -> Ground:
    """Return the ground of corners (V, 3), metres of W, and of triangles (T, 3) of their indices.

    Adjacent triangles share corners, and no triangle is above another. Vertical triangles are no ground;
    their neighbours are. Raise ValueError if a corner is not finite.
    """
    surface = surface_of(corners[faces].reshape(-1, 3, 3))
    ends = corners[_lone_sides(faces, len(corners))] * np.array([1.0, 1.0, 0.0])
    return Ground(surface, surface_of(ends[:, [0, 1, 1]]))


def _lone_sides(faces: IntArray, count: int) -> IntArray:
    """Return the sides of one triangle only, as pairs of corner indices (E, 2)."""
    low, high = np.minimum(faces, faces[:, _NEXT]), np.maximum(faces, faces[:, _NEXT])
    side, times = np.unique((low.astype(np.int64) * count + high).ravel(), return_counts=True)
    lone = side[times == 1]
    return np.stack([lone // count, lone % count], axis=1).astype(np.intp)


@dataclass(frozen=True, slots=True, eq=False)
class Under:
    """The ground below points.

    height   : (K,), metres of W; NaN without ground
    triangle : (K,), index in the surface; -1 without ground
    """

    height: Array
    triangle: IntArray


def height_at(ground: Ground, xy: Array) -> Array:
    """Return the heights (K,) of the ground at points (K, 2), metres of W; NaN without ground."""
    return under(ground.surface, xy).height


def under(surface: Surface, xy: Array) -> Under:
    """Return the highest of a surface at points (K, 2), metres of W; NaN and -1 where there is nothing."""
    out = Under(np.full(len(xy), np.nan), np.full(len(xy), -1))
    for start in range(0, len(xy), BATCH_ITEMS):
        part = slice(start, start + BATCH_ITEMS)
        _under(surface, xy[part], Under(out.height[part], out.triangle[part]))
    return out


def _under(surface: Surface, xy: Array, out: Under) -> None:
    pairs = under_points(surface, xy)
    height = heights(surface.triangles[pairs.triangle], xy[pairs.item])
    inside = ~np.isnan(height)
    pairs, height = pairs.pick(inside), height[inside]
    item, best = pairs.best(-height)
    out.height[item], out.triangle[item] = height[best], pairs.triangle[best]


def heights(triangles: Array, xy: Array) -> Array:
    """Return the heights (K,) of triangles (K, 3, 3) at points (K, 2), metres; NaN if a point is outside."""
    plan = triangles[..., :2]
    edges, offset = plan[:, _NEXT] - plan, xy[:, None] - plan
    areas = edges[..., 0] * offset[..., 1] - edges[..., 1] * offset[..., 0]
    weights = areas[:, _NEXT]
    total = weights[:, 0] + weights[:, 1] + weights[:, 2]
    share = weights / np.where(np.abs(total) > TINY_SQUARE, total, np.nan)[:, None]
    share[~(np.minimum(np.minimum(share[:, 0], share[:, 1]), share[:, 2]) >= -_EDGE_WEIGHT)] = np.nan
    share = np.clip(share, 0.0, 1.0)
    total = share[:, 0] + share[:, 1] + share[:, 2]
    return np.asarray(np.einsum("kv,kv->k", share, triangles[..., 2]) / total)


def leaves(ground: Ground, pieces: Pieces) -> NoGround | None:
    """Prove that curves have ground below them, at any height; return None, or where they leave the ground.

    pieces : shape (M, n + 1, 3), metres of W
    A piece that starts over ground and never comes to the edge of the ground stays over it.
    """
    if not len(pieces):
        return None
    is_start = np.ones(len(pieces), dtype=bool)  # a piece that continues another needs no test of its start
    is_start[1:] = (pieces.ctrl[1:, 0, :2] != pieces.ctrl[:-1, -1, :2]).any(axis=1)
    if np.isnan(height_at(ground, pieces.ctrl[is_start, 0, :2])).any():
        return _farthest_out(ground, pieces)
    flat = pieces.ctrl * np.array([1.0, 1.0, 0.0])
    bound = inf_distance(Pieces(pieces.low, pieces.high, flat), ground.edge, _apart_at_all)
    if bound.proven > 0.0:
        return None
    return _farthest_out(ground, pieces) or _touched(pieces, bound)


def _apart_at_all(distance: float) -> float:
    return max(0.5 * distance, EDGE_M)


def _touched(pieces: Pieces, bound: SurfaceBound) -> NoGround:
    i = bound.piece
    x = (bound.at - pieces.low[i]) / (pieces.high[i] - pieces.low[i])
    place = bernstein_basis(pieces.ctrl.shape[1] - 1, x) @ pieces.ctrl[i, :, :2]
    return NoGround(bound.at, (float(place[0]), float(place[1])), 0.0)


def _farthest_out(ground: Ground, pieces: Pieces) -> NoGround | None:
    x = np.linspace(0.0, 1.0, SAMPLES_PER_PIECE)
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
