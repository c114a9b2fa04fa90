"""A curve near its polyline: breaks that are dense at corners, and bounds on the Bernstein points.

The control points of a piece lie in balls about points of its leg. The distance from a leg is convex, so the
piece is then within the half-width of the leg throughout. A curve that turns within a half-width needs pieces
of about that length, so the breaks grow from there by a factor of two with the distance from a corner.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import DEGREE, hull_rows, subdivide
from shotc.solvers.spline_problem import Cones

GROWTH_RATIO = 2.0
PLANNED_SHARE = 0.9  # share of a half-width that is used; refiners need the rest


def breaks_of(s: Array, widths: Array, parts: int, finer: int) -> Array:
    """Return breaks for legs between path parameters ``s``, (M,), metres.

    widths : half-width of each leg, (M - 1,), metres; inf where it is free
    parts : equal pieces of a leg; finer : factor on the number of all pieces
    """
    inner: list[Array] = []
    for low, high, width in zip(s[:-1], s[1:], widths, strict=True):
        reach = (high - low) / (2.0 * parts)
        steps = width * GROWTH_RATIO ** np.arange(64.0)
        near = steps[steps < reach]
        even = np.linspace(low, high, parts + 1)[:-1]
        inner.append(np.sort(np.concatenate([even, low + near, high - near])))
    return subdivide(np.append(np.concatenate(inner), s[-1]), finer)


def near_legs(breaks: Array, s: Array, corners: Array, widths: Array) -> Cones:
    """Return the bounds that hold every piece within the half-width of its leg.

    breaks : shape (P + 1,); s, corners : of the polyline, (M,), (M, 3); widths : as in ``breaks_of``
    """
    rows = hull_rows(breaks, 0)
    own = np.arange(len(breaks) - 1).repeat(DEGREE + 1)
    share = np.tile(np.arange(DEGREE + 1) / DEGREE, len(breaks) - 1)
    first = np.concatenate([[True], np.arange(1, len(own)) % (DEGREE + 1) > 0])
    own, share = own[first], share[first]
    at = breaks[own] + share * np.diff(breaks)[own]
    leg = np.clip(np.searchsorted(s, 0.5 * (breaks[:-1] + breaks[1:])) - 1, 0, len(widths) - 1)[own]
    centre = np.column_stack([np.interp(at, s, corners[:, axis]) for axis in range(3)])
    held = np.isfinite(widths[leg])
    ends = np.append(leg[1:] != leg[:-1], False)  # a corner has the smaller half-width; it is passed anyway
    bound = np.where(ends, np.minimum(widths[leg], widths[np.minimum(leg + 1, len(widths) - 1)]), widths[leg])
    owner = np.zeros(int(held.sum()), dtype=np.intp)
    rows = type(rows)(rows.piece[held], rows.weight[held])
    return Cones(rows, (0, 1, 2), centre[held], PLANNED_SHARE * bound[held], None, owner)
