"""Bounds that hold at every instant, by Bernstein hulls that are halved until the bounds are tight.

On a piece, a convex function of a polynomial is at most its largest value at the piece's control points. The
distance of a polynomial from a convex solid is at least that of its control points along any fixed direction.
The error of both bounds falls quadratically as pieces are halved. Only pieces that may contain the worst
value are halved (branch and bound).

Arithmetic is IEEE double. Control points are exact by definition. Their sums and differences lose at most a
few units in the last place: about 1e-13 of a flight's size, and 1e-7 for third derivatives of pieces of a
millisecond. Callers allow a tolerance of 1e-6, half of which is the gap here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.solid_arrays.points import FAR_M, heights, separation, signed_distance, support
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts, hull_and_pockets
from shotc.geom.taper import Taper

MOST_HALVINGS = 60
"""Most halvings of a piece; an interval of an hour is then shorter than a nanosecond."""

OPEN_PIECES_LIMIT = 200_000
"""Most pieces that are halved together; beyond it the bound stays proven but does not get tighter."""

Value = Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class ProvedExtreme:
    """The extreme of a function over all pieces.

    proven : no value of the function is beyond it (above a supremum, below an infimum)
    attained : a value that the function takes, at parameter ``at``
    """

    proven: float
    attained: float
    at: float


def sup_convex(pieces: Pieces, value: Value, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the supremum of a convex or quasi-convex function along polynomial pieces.

    value : (quasi-)convex, maps control points (..., D) to numbers (...)
    gap   : admissible difference of ``proven`` and ``attained``, as a function of the largest value found so
        far
    Without pieces both are -inf.
    """
    best, at, closed = -np.inf, 0.0, -np.inf
    rest = -np.inf
    for _ in range(MOST_HALVINGS):
        if not len(pieces):
            break
        values = value(pieces.ctrl)
        ends = values[:, [0, -1]]
        k = int(np.argmax(ends))
        if ends.flat[k] > best:
            best = float(ends.flat[k])
            at = float((pieces.low, pieces.high)[k % 2][k // 2])
        upper = values.max(axis=1)
        is_open = upper > best + gap(best)
        closed = max(closed, float(upper[~is_open].max(initial=-np.inf)))
        rest = float(upper[is_open].max(initial=-np.inf))
        if is_open.sum() > OPEN_PIECES_LIMIT:
            break
        pieces = pieces.pick(is_open).halves()
    return ProvedExtreme(max(closed, best, rest), best, at)


def sup_norm(pieces: Pieces, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the supremum of the Euclidean norm of all channels; arguments as in ``sup_convex``."""
    return sup_convex(pieces, norm, gap)


def inf_channel(pieces: Pieces, channel: int, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the infimum of one channel."""
    bound = sup_convex(pieces, lambda c: -c[..., channel], lambda worst: gap(-worst))
    return ProvedExtreme(-bound.proven, -bound.attained, bound.at)


def sup_channel(pieces: Pieces, channel: int, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the supremum of one channel."""
    return sup_convex(pieces, lambda c: np.asarray(c[..., channel]), gap)


def norm(vectors: Array) -> Array:
    """Return the Euclidean norm (...) of vectors (..., D); convex."""
    return np.asarray(np.sqrt(np.einsum("...d,...d->...", vectors, vectors)))


def inf_distance(pieces: Pieces, solid: Solid, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the infimum of the distance from a solid along pieces of shape (M, n + 1, 3), metres.

    If the curve enters the solid, the value is negative: minus the largest depth that was found. ``gap`` as
    in ``sup_convex``, as a function of the smallest distance found so far.
    """
    best = _least(pieces, _from_all(solid, _distances), gap)
    if best.attained > 0:
        return best
    deepest = _deepest(pieces, solid)
    return deepest if deepest.attained < 0 else best


def inf_tapered(pieces: Pieces, solid: Solid, taper: Taper, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the infimum of the distance from a solid with the allowance of a taper, metres.

    The value is the larger of the distance, and of the clearance plus the slack of the distance over the
    tapered need. It is below the clearance iff the distance is below the need. ``gap`` as in
    ``inf_distance``.
    """
    return _least(pieces, _from_all(solid, partial(_tapered, taper)), gap)


Nearness = Callable[[Pieces], tuple[Array, Array]]
"""Lower bounds of a value on every piece, (M,), and the value in its middle, (M,)."""


def _from_all(solid: Solid, of: Callable[[Pieces, Solid], tuple[Array, Array]]) -> Nearness:
    # All parts together: near one part the curve may be inside another.
    parts = convex_parts(solid)
    return lambda pieces: np.min([of(pieces, part) for part in parts], axis=0)


def _least(pieces: Pieces, near: Nearness, gap: Callable[[float], float]) -> ProvedExtreme:
    best, at, closed = np.inf, 0.0, np.inf
    rest = np.inf
    for _ in range(MOST_HALVINGS):
        if not len(pieces):
            break
        lower, distance = near(pieces)
        k = int(np.argmin(distance))
        if distance[k] < best:
            best, at = float(distance[k]), float(0.5 * (pieces.low[k] + pieces.high[k]))
        is_open = lower < best - gap(best)
        closed = min(closed, float(lower[~is_open].min(initial=np.inf)))
        rest = float(lower[is_open].min(initial=np.inf))
        if best <= 0.0 or is_open.sum() > OPEN_PIECES_LIMIT:
            break
        pieces = pieces.pick(is_open).halves()
    return ProvedExtreme(min(closed, best, rest), best, at)


def _distances(pieces: Pieces, part: Solid) -> tuple[Array, Array]:
    """Return lower bounds of each piece's distance from a convex solid, and its middle's, (M,)."""
    distance, normal = separation(part, _middle(pieces.ctrl))
    along = np.einsum("mkd,md->mk", pieces.ctrl, normal).min(axis=1) - support(part, normal)
    return np.maximum(np.where(distance > 0.0, along, 0.0), box_gap(pieces.ctrl, part)), distance


def _tapered(taper: Taper, pieces: Pieces, part: Solid) -> tuple[Array, Array]:
    """Return the same as ``_distances``, for distances with the allowance of a taper.

    On a piece the distance is at least that from a plane. Minus ``slope`` times the distance from an end,
    this is concave, so its minimum is at a control point.
    """
    middle = _middle(pieces.ctrl)
    distance, normal = separation(part, middle)
    along = np.einsum("mkd,md->mk", pieces.ctrl, normal) - support(part, normal)[:, None]
    along = np.where((distance > 0.0)[:, None], along, 0.0)
    lower, value = np.maximum(along.min(axis=1), box_gap(pieces.ctrl, part)), distance
    for end, its_gap in zip(taper.ends, taper.gaps, strict=True):
        given = taper.clearance - its_gap
        lower = np.maximum(lower, (along - taper.slope * norm(pieces.ctrl - end)).min(axis=1) + given)
        value = np.maximum(value, distance - taper.slope * norm(middle - end) + given)
    return lower, value


def _deepest(pieces: Pieces, solid: Solid) -> ProvedExtreme:
    # The curve enters the solid, so the proof is decided. The depth is sampled at some thousand places.
    for _ in range(12):
        if len(pieces) > 4096:
            break
        reach = _box_overlap(pieces.ctrl, solid)
        pieces = (pieces.pick(reach) if reach.any() else pieces).halves()
    depth = signed_distance(solid, _middle(pieces.ctrl))
    k = int(np.argmin(depth))
    worst = float(depth[k])
    return ProvedExtreme(worst, worst, float(0.5 * (pieces.low[k] + pieces.high[k])))


def sup_outside(
    pieces: Pieces, solid: Solid, gap: Callable[[float], float], *, floor: bool = True
) -> ProvedExtreme:
    """Bound the supremum of the curve's distance outside a solid, metres; negative is the margin inside.

    The value is the largest excess over any face (or over the wall of a cylinder), so a sphere of radius r
    stays inside iff it is at most -r. A non-convex footprint is its hull minus convex pockets; near a pocket
    the value is minus the distance from it. floor=False omits the bottom.
    """
    hull, pockets = (solid, ()) if isinstance(solid, Cylinder) else hull_and_pockets(solid)
    worst = sup_convex(pieces, _excess(hull, floor), gap)
    for pocket in pockets:
        nearest = inf_distance(pieces, pocket, lambda near: gap(-near))
        if -nearest.proven > worst.proven:
            worst = ProvedExtreme(-nearest.proven, -nearest.attained, nearest.at)
    return worst


def _excess(hull: Solid, floor: bool) -> Value:
    bottom, top = heights(hull)
    bottom = bottom if floor else -FAR_M
    if isinstance(hull, Cylinder):
        centre, radius = np.array(hull.centre), hull.radius

        def around(p: Array) -> Array:
            return norm(p[..., :2] - centre) - radius
    else:
        normals, offsets = half_planes(hull)

        def around(p: Array) -> Array:
            return np.asarray((p[..., :2] @ normals.T - offsets).max(axis=-1))

    def excess(p: Array) -> Array:
        return np.maximum(around(p), np.maximum(p[..., 2] - top, bottom - p[..., 2]))

    return excess


def half_planes(hull: Prism) -> tuple[Array, Array]:
    """Return outward unit normals (k, 2) and offsets (k,) of a convex footprint; inside, n.p <= offset."""
    points = np.array(hull.points)
    along = np.roll(points, -1, axis=0) - points
    lengths = norm(along)
    points, along = points[lengths > 0], along[lengths > 0] / lengths[lengths > 0, None]
    normals = np.stack([along[:, 1], -along[:, 0]], axis=-1)
    return normals, np.einsum("kd,kd->k", normals, points)


def _middle(ctrl: Array) -> Array:
    while ctrl.shape[1] > 1:
        ctrl = 0.5 * (ctrl[:, :-1] + ctrl[:, 1:])
    return ctrl[:, 0]


def box_gap(ctrl: Array, part: Solid) -> Array:
    """Return the distances (M,) of boxes around control points (M, n + 1, 3) from a solid's box."""
    low, high = bounds(part)
    apart = np.maximum(np.maximum(ctrl.min(axis=1) - high, low - ctrl.max(axis=1)), 0.0)
    return norm(apart)


def _box_overlap(ctrl: Array, solid: Solid) -> Mask:
    low, high = bounds(solid)
    return np.asarray(((ctrl.min(axis=1) <= high) & (ctrl.max(axis=1) >= low)).all(axis=1))


def bounds(solid: Solid) -> tuple[Array, Array]:
    """Return the lowest and the highest corner of the box round a solid, shape (3,) each."""
    if isinstance(solid, Cylinder):
        corners = np.array(solid.centre) + np.array([[-solid.radius], [solid.radius]])
    else:
        points = np.array(solid.points)
        corners = np.stack([points.min(axis=0), points.max(axis=0)])
    bottom, top = heights(solid)
    return np.array([*corners[0], bottom]), np.array([*corners[1], top])
