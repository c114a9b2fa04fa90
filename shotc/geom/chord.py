"""The distance of points and curves from a straight segment."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import cut
from shotc.geom.proof import ProvedExtreme, norm, sup_convex


def off_chord(points: Array, first: Array, last: Array) -> Array:
    """Return the distance of points (..., 3) from the segment between two points (3,), shape (...), metres.

    It is convex in the point, because a segment is a convex set.
    """
    along = last - first
    share = np.clip((points - first) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
    return norm(points - first - share[..., None] * along)


def sup_off_chord(
    curve: Piecewise, span: tuple[float, float], ends: tuple[Array, Array], gap: Callable[[float], float]
) -> ProvedExtreme:
    """Bound the supremum of the distance of a curve from a segment, metres.

    curve : channels x, y, z
    span : the parameters between which the curve is compared; ends : of the segment, (3,)
    gap : as in ``proof.sup_convex``
    """
    return sup_convex(cut(curve, *span), lambda points: off_chord(points, *ends), gap)
