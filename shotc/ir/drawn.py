"""Paths that a mission draws by points, and how far a flight may leave them. Plain Python.

The points of a `follow-path` are the way itself. A drone that does not stop at a corner cannot fly it
exactly, so each leg has a half-width. It allows a tenth of the leg, which is what an arc through points
needs up to turns of 45 deg, and no more than that of the legs beside it, so that a short leg keeps its side.
"""

from collections.abc import Sequence
from itertools import pairwise
from math import dist

from shotc.geom.vec import Vec3
from shotc.ir.mission import Shot

KIND = "follow-path"
WIDTH_SHARE = 0.1
"""Half-width of a leg as a share of the shortest one of itself and the legs beside it."""
LEAST_WIDTH_M, MOST_WIDTH_M = 0.5, 5.0
"""Bounds of the half-width, metres."""
NO_LEG_M = 1e-3
"""Length of a leg that is none, metres: its ends are one place."""


def is_drawn(shot: Shot) -> bool:
    """Return whether the keyframes of a shot are a path that its author draws."""
    return shot.kind == KIND and shot.ideal is None


def half_widths(points: Sequence[Vec3]) -> list[float]:
    """Return how far the flight may be from each leg between two points, metres."""
    lengths = [dist(a, b) for a, b in pairwise(points)]
    flown = [k for k, length in enumerate(lengths) if length >= NO_LEG_M]
    near: dict[int, float] = {}
    for i, k in enumerate(flown):
        beside = min(lengths[n] for n in flown[max(i - 1, 0) : i + 2])
        near[k] = min(MOST_WIDTH_M, max(LEAST_WIDTH_M, WIDTH_SHARE * beside))
    return [near.get(k, LEAST_WIDTH_M) for k in range(len(lengths))]
