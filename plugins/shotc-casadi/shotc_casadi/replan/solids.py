"""Distances from standing obstacles, in symbols; the solids' dimensions are parameters.

The distance from a convex solid is a convex function: where its linearisation is >= 0, so is the distance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import (
    Clearance,
    Cylinder,
    Prism,
    Solid,
    convex_parts,
    edges,
    hull_and_pockets,
)

FAR_M = 1e6
"""Infinite solids end here, metres."""
SHARP_M = 0.5
"""Radius of the curve around a corner, metres: a straight step between two stages cuts it."""
TINY_M = 1e-9
HALF_SPACE, PILLAR, SHAFT = 0, 1, 2
"""Shapes with a fixed number of parameters; the shape of a prism is its number of corners."""


class SolidConstraint(NamedTuple):
    """A convex part that a drone keeps clear of, or a space that it stays inside of.

    shape : HALF_SPACE (normal, offset); PILLAR, an upright cylinder, (x, y, radius, bottom, top); SHAFT, the
        inside of an infinite one, (x, y, radius); or a number of corners (bottom, top, their x and y)
    metres : clearance from it
    radius : of curvature of the surface at that clearance, infinite for a plane
    """

    shape: int
    sizes: tuple[float, ...]
    metres: float
    radius: float

    @property
    def disc(self) -> tuple[float, float, float]:
        """A disc that contains it with its clearance, (x, y, radius); infinite for an infinite solid."""
        if self.shape in (HALF_SPACE, SHAFT):
            return (0.0, 0.0, np.inf)
        if self.shape == PILLAR:
            return (self.sizes[0], self.sizes[1], self.sizes[2] + self.metres)
        corners = np.reshape(self.sizes[2:], (-1, 2))
        x, y = corners.mean(axis=0)
        return (x, y, float(np.hypot(*(corners - (x, y)).T).max()) + self.metres)

    @property
    def parameters(self) -> tuple[float, ...]:
        """Its clearance, its curvature, and its sizes.

        A straight step of length l between two stages cuts off at most l^2 / 8 times the curvature.
        """
        return (self.metres, 1.0 / self.radius, *self.sizes)


def count(shape: int) -> int:
    """Return the number of parameters of a solid of a shape."""
    return 2 + {HALF_SPACE: 4, PILLAR: 5, SHAFT: 3}.get(shape, 2 + 2 * shape)


def half_space(normal: Sequence[float], offset: float) -> SolidConstraint:
    """Return the constraint normal . p >= offset; normal : a unit vector."""
    return SolidConstraint(HALF_SPACE, (*normal, offset), 0.0, np.inf)


def rooms(zone: Clearance, margin: float) -> Iterator[SolidConstraint]:
    """Yield the constraints of one clearance."""
    metres = zone.metres + margin
    if not zone.inside:
        yield from (_outside(part, metres) for part in convex_parts(zone.solid))
        return
    solid = zone.solid
    if np.isfinite(solid.bottom):
        yield half_space((0.0, 0.0, 1.0), solid.bottom + metres)
    if np.isfinite(solid.top):
        yield half_space((0.0, 0.0, -1.0), metres - solid.top)
    if isinstance(solid, Cylinder):
        yield SolidConstraint(SHAFT, (*solid.centre, solid.radius), metres, np.inf)
        return
    hull, pockets = hull_and_pockets(solid)
    for a, b in edges(hull.points):
        x, y = a[1] - b[1], b[0] - a[0]  # inwards: the polygon runs counter-clockwise
        length = float(np.hypot(x, y))
        yield half_space((x / length, y / length, 0.0), (x * a[0] + y * a[1]) / length + metres)
    yield from (_outside(pocket, metres) for pocket in pockets)


def free_at(shape: int, p: Any, sizes: Any) -> Any:
    """Return the slack at a position in symbols, metres; sizes : the parameters of a ``SolidConstraint``."""
    metres, s = sizes[0], sizes[2:]
    if shape == HALF_SPACE:
        return ca.dot(s[:3], p) - s[3] - metres
    if shape in (PILLAR, SHAFT):
        # The offset keeps it differentiable on the axis.
        across = ca.norm_2(p[:2] - s[:2] + ca.SX([TINY_M, 0.0])) - s[2]
        return -across - metres if shape == SHAFT else _upright(across, p, s[3], s[4]) - metres
    return _upright(_polygon(p, ca.reshape(s[2:], 2, shape)), p, s[0], s[1]) - metres


def _outside(part: Solid, metres: float) -> SolidConstraint:
    low, high = max(part.bottom, -FAR_M), min(part.top, FAR_M)
    if isinstance(part, Cylinder):
        sizes = (*part.centre, part.radius, low, high)
        return SolidConstraint(PILLAR, sizes, metres, max(part.radius + metres, SHARP_M))
    assert isinstance(part, Prism)
    corners = [c for point in part.points for c in point]
    return SolidConstraint(len(part.points), (low, high, *corners), metres, max(metres, SHARP_M))


def _polygon(p: Any, corners: Any) -> Any:
    """Return the signed horizontal distance from a convex polygon, corners (2, k) counter-clockwise."""
    k = corners.size2()
    faces, squares = [], []
    for i in range(k):
        start, side = corners[:, i], corners[:, (i + 1) % k] - corners[:, i]
        offset, square = p[:2] - start, ca.sumsqr(side)
        faces.append((side[1] * offset[0] - side[0] * offset[1]) / ca.sqrt(square))
        along = ca.fmin(ca.fmax(ca.dot(offset, side) / square, 0), 1)
        squares.append(ca.sumsqr(offset - along * side))
    inside = _folded(ca.fmax, faces)
    return ca.if_else(inside > 0, ca.sqrt(_folded(ca.fmin, squares) + TINY_M**2), inside)


def _upright(across: Any, p: Any, bottom: Any, top: Any) -> Any:
    """Return the signed distance from an upright solid, given the horizontal one."""
    up = ca.fmax(bottom - p[2], p[2] - top)
    corner = ca.sqrt(ca.fmax(across, 0) ** 2 + ca.fmax(up, 0) ** 2 + TINY_M**2)
    return ca.if_else(ca.fmin(across, up) > 0, corner, ca.fmax(across, up))


def _folded(by: Any, values: list[Any]) -> Any:
    first, *rest = values
    for value in rest:
        first = by(first, value)
    return first
