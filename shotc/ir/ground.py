"""The ground of a mission, and what heights count from. Plain Python."""

from collections.abc import Callable
from typing import Literal

from shotc.ir.limits import Vec2

GroundHeight = Callable[[float, float], float]
"""z of the ground, metres, at x and y of W, metres."""

Above = Literal["target", "ground", "origin"]
"""What a camera's height counts from: the target's foot then, the ground below it, or the plane z = 0."""


def flat(x: float, y: float) -> float:
    """Return the height of ground that is the plane z = 0."""
    return 0.0


def counted_from(above: Above, ground: GroundHeight, place: Vec2, foot: float) -> float:
    """Return z of what heights count from at a place, metres; foot : z of the target's foot then."""
    if above == "origin":
        return 0.0
    return ground(*place) if above == "ground" else foot
