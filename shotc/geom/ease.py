"""The step of least jerk from rest to rest: 10 x^3 - 15 x^4 + 6 x^5."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from shotc.geom.bernstein import Array

_Share = TypeVar("_Share", float, "Array")


def minimum_jerk(x: _Share) -> _Share:
    """Return the share of the way, of the shape of x, after the share x in [0, 1] of the time.

    Source: Flash and Hogan, The Coordination of Arm Movements, 1985. Its first two derivatives end at zero.
    """
    return x**3 * (10.0 + x * (6.0 * x - 15.0))
