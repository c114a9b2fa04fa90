"""The ground of a mission: how high it is below a place. Plain Python."""

from collections.abc import Callable

Ground = Callable[[float, float], float]
"""z of the ground, metres, at x and y of W, metres."""


def flat(x: float, y: float) -> float:
    """Return the height of ground that is the plane z = 0."""
    return 0.0
