"""Targets that are more than one upright cylinder (boxes, several bodies), in numbers and CasADi symbols.

Along a unit vector n, a body reaches from its centre as far as an upright cylinder plus a horizontal
parallelogram: h / 2 |n.up| + r sqrt(1 - (n.up)^2) + |n.a| + |n.b|. A cylinder has no sides a and b, a box has
no radius. Between the two, where one target hands over to another, a body has both.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from shotc.plugin_api.refiner import (
    Array,
    BodyShape,
    BoxShape,
    CylinderShape,
    TargetShape,
    UnitVector,
    View,
    bodies_of,
)

EXTENT_PARAMETERS = 9
"""Numbers of a body: its centre relative to the target's (3), radius, height, half-sides (2 x 2)."""
ROUNDED_SHARE = 1e-4  # of a length: smaller parts are rounded off
TINY_M2 = 1e-16  # m^2 added to a square so that it is not zero


class Extent(NamedTuple):
    """A body, in numbers, arrays or symbols.

    offset : of its centre from the target's centre, W, metres
    radius, height : metres
    along, across : half-sides, (x, y) of W, metres
    """

    offset: Any
    radius: Any
    height: Any
    along: Any
    across: Any

    @staticmethod
    def of(row: Any) -> Extent:
        """Return the body of EXTENT_PARAMETERS numbers; the first axis of an array."""
        return Extent(row[:3], row[3], row[4], row[5:7], row[7:9])

    def reach(self, camera: View, n: UnitVector) -> Any:
        """Return how far the body reaches from its centre along a unit vector of C, m; exact, for arrays."""
        far = self.height / 2 * abs(n.up) + self.radius * abs(1.0 - n.up * n.up) ** 0.5
        for side in (self.along, self.across):
            right, down, forward = camera.to_camera((side[0], side[1], 0.0 * side[0]))
            far = far + abs(n.right * right + n.down * down + n.forward * forward)
        return far


def is_round(shape: TargetShape) -> bool:
    """Return whether a target is one upright cylinder, which needs no extents."""
    return isinstance(shape, CylinderShape)


def count_of(shapes: Sequence[TargetShape]) -> int:
    """Return how many extents a programme with targets of these shapes has; 0 if all are cylinders."""
    return 0 if all(map(is_round, shapes)) else max(len(bodies_of(shape)) for shape in shapes)


def extents_of(shape: TargetShape, count: int, times: int) -> Array:
    """Return a target's bodies, shape (times, count, EXTENT_PARAMETERS); copies of the first fill the rest.

    shape : may have one course for each of the times
    """
    rows = np.zeros((times, count, EXTENT_PARAMETERS))
    if count:
        parts = bodies_of(shape)
        for k in range(count):
            part = parts[k] if k < len(parts) else parts[0]
            rows[:, k, :3] = part.offset
            rows[:, k, 3:] = _body(part.shape, times)
    return rows


def _body(shape: BodyShape, times: int) -> Array:
    row = np.zeros((times, EXTENT_PARAMETERS - 3))
    row[:, 1] = shape.height
    if isinstance(shape, BoxShape):
        c, s = shape.ahead
        half, wide = shape.length / 2, shape.width / 2
        for k, value in enumerate((half * c, half * s, -wide * s, wide * c), start=2):
            row[:, k] = value
    else:
        row[:, 0] = shape.radius
    return row


def rounded(part: Any, squared: Any) -> Any:
    """Return the magnitude of a vector's component along a direction, smooth where it is zero.

    part : that component
    squared : the squared length of the vector
    """
    return ca.sqrt(part**2 + ROUNDED_SHARE**2 * squared + TINY_M2)


def between(first: Array, second: Array, share: Array) -> Array:
    """Return bodies between those of one target and those of another; share : of the way, (M, 1).

    Sides that point the opposite way are turned: they describe the same body.

    first, second : (1, K, EXTENT_PARAMETERS)
    """
    turned = second.copy()
    for pair in (slice(5, 7), slice(7, 9)):
        against = (first[..., pair] * second[..., pair]).sum(axis=-1, keepdims=True) < 0
        turned[..., pair] = np.where(against, -second[..., pair], second[..., pair])
    return np.asarray((1 - share[:, :, None]) * first + share[:, :, None] * turned)
