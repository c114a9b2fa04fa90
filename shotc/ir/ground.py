"""The height of the ground, and the reference of heights. Plain Python."""

from collections.abc import Callable
from typing import Literal

from shotc.ir.limits import Vec2

GroundHeight = Callable[[float, float], float]
"""z of the ground, metres, at x and y of W, metres."""

Above = Literal["target", "ground", "origin"]
"""Reference of a camera's height: the target's foot at that time, the ground below it, or the plane z = 0."""


def flat(x: float, y: float) -> float:
    """Return z of flat ground: 0."""
    return 0.0


def counted_from(above: Above, ground: GroundHeight, place: Vec2, foot: float) -> float:
    """Return z of the reference of heights at a place, metres; foot : z of the target's foot at that time."""
    if above == "origin":
        return 0.0
    return ground(*place) if above == "ground" else foot
