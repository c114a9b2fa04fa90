"""Steps from rest to rest: the one of least jerk, 10 x^3 - 15 x^4 + 6 x^5, and slower ones."""

from __future__ import annotations

from math import ceil, inf
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from shotc.geom.bernstein import Array

PEAK = 15.0 / 8.0
"""Greatest speed of the step of least jerk over its mean."""

MOST_PARTS = 40
"""Of the time, the first and the last of which may be all there is for speeding up and slowing down."""

_Share = TypeVar("_Share", float, "Array")


def minimum_jerk(x: _Share) -> _Share:
    """Return the share of the way, of the shape of x, after the share x in [0, 1] of the time.

    Source: Flash and Hogan, The Coordination of Arm Movements, 1985. Its first two derivatives end at zero.
    """
    return x**3 * (10.0 + x * (6.0 * x - 15.0))


def parts_of(room: float) -> int | None:
    """Return into how many equal parts of its time a step is cut to keep a speed, or None where it cannot.

    room : that speed over the mean speed of the step
    In the first part the speed rises, in the last it falls, and it is even between: n / (n - 1) of the mean.
    One part stands for the step of least jerk.
    """
    if room >= PEAK:
        return 1
    parts = ceil(room / (room - 1.0)) if room > 1.0 else inf
    return int(parts) if parts <= MOST_PARTS else None


def control(parts: int) -> list[tuple[float, float, list[float]]]:
    """Return the pieces of a step of some parts: from and to which share of the time, and control points.

    Those are of the fifth degree in Bernstein form. The speed of a ramp is 3 y^2 - 2 y^3 of the even one.
    """
    if parts == 1:
        return [(0.0, 1.0, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])]
    ramp = 1.0 / parts
    speed = parts / (parts - 1.0)
    rise = [speed * ramp * y for y in (0.0, 0.0, 0.0, 0.1, 0.3, 0.5)]
    even = [rise[-1] + k / 5.0 * (1.0 - 2.0 * rise[-1]) for k in range(6)]
    return [
        (0.0, ramp, rise),
        (ramp, 1.0 - ramp, even),
        (1.0 - ramp, 1.0, [1.0 - y for y in reversed(rise)]),
    ]
