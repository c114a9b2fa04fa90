"""Steps from rest to rest: the minimum-jerk step 10 x^3 - 15 x^4 + 6 x^5, and steps of lower peak speed."""

from __future__ import annotations

from math import ceil, inf
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from shotc.geom.bernstein import Array

PEAK_SPEED_RATIO = 15.0 / 8.0
"""Peak speed of the minimum-jerk step over its mean speed."""

MOST_PARTS = 40
"""Most parts of the time; the first one is the shortest admissible acceleration, the last one the braking."""

_Share = TypeVar("_Share", float, "Array")


def minimum_jerk(x: _Share) -> _Share:
    """Return the share of the way, of the shape of x, after the share x in [0, 1] of the time.

    Source: Flash and Hogan, The Coordination of Arm Movements, 1985. Its first two derivatives end at zero.
    """
    return x**3 * (10.0 + x * (6.0 * x - 15.0))


def parts_of(speed_ratio: float) -> int | None:
    """Return the number n of equal time parts of a step that keeps a speed limit; None if it cannot.

    speed_ratio : the limit over the mean speed of the step
    The speed rises in the first part, falls in the last, and is constant between: n / (n - 1) of the mean.
    One part means the minimum-jerk step.
    """
    if speed_ratio >= PEAK_SPEED_RATIO:
        return 1
    parts = ceil(speed_ratio / (speed_ratio - 1.0)) if speed_ratio > 1.0 else inf
    return int(parts) if parts <= MOST_PARTS else None


class StepPiece(NamedTuple):
    """A piece of a step: start and end as shares of the time, and 6 control points in Bernstein form."""

    start: float
    end: float
    points: list[float]


def control(parts: int) -> list[StepPiece]:
    """Return the pieces of a step. The speed in a ramp is 3 y^2 - 2 y^3 of the constant one."""
    if parts == 1:
        return [StepPiece(0.0, 1.0, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])]
    ramp = 1.0 / parts
    speed = parts / (parts - 1.0)
    rise = [speed * ramp * y for y in (0.0, 0.0, 0.0, 0.1, 0.3, 0.5)]
    even = [rise[-1] + k / 5.0 * (1.0 - 2.0 * rise[-1]) for k in range(6)]
    return [
        StepPiece(0.0, ramp, rise),
        StepPiece(ramp, 1.0 - ramp, even),
        StepPiece(1.0 - ramp, 1.0, [1.0 - y for y in reversed(rise)]),
    ]
