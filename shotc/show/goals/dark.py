"""Places of drones for which a picture has no room: dark, in a block behind the picture.

The block is a vertical grid perpendicular to the audience's viewing direction. Its places are as far apart,
and as far from the picture, as goals have to be, so that straight moves between pictures keep the separation.
If an obstacle is behind the picture, the block has one layer in front of it and continues behind the
obstacle.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, hypot

import numpy as np

from shotc.geom.bernstein import Array
from shotc.show.goals.spaced import SpacingTask

BEHIND_SPACINGS = 1.001
"""Distance of dark drones from the picture and from each other, in spacings."""
MOST_LAYERS = 100
"""Most layers of the block."""
NORTH = np.array([0.0, 1.0, 0.0])


def dark_places(goals: Array, spare: int, setting: SpacingTask, facing: Array = NORTH) -> Array | None:
    """Return ``spare`` places behind goals (n, 3), shape (spare, 3); None if there is no room.

    facing : (3,), horizontal viewing direction for a picture without an audience
    """
    chosen_places: list[Array] = []
    for places in _layers(goals, setting, _viewing_direction(goals, setting, facing)):
        chosen = np.unique(np.linspace(0, len(places) - 1, min(spare, len(places))).round().astype(np.intp))
        chosen_places.append(places[chosen])
        spare -= len(chosen)
        if not spare:
            return np.concatenate(chosen_places)
    return None


def _layers(goals: Array, setting: SpacingTask, direction: Array) -> Iterator[Array]:
    """Yield the free places of one layer after another, in the order of use."""
    across = np.array([-direction[1], direction[0], 0.0])
    step = BEHIND_SPACINGS * setting.least
    middle = goals.mean(axis=0)
    columns = _steps((goals - middle) @ across, step)
    rows = _steps(goals[:, 2] - middle[2], step / setting.stretch)
    sheet = middle + np.array([a * across + [0.0, 0.0, z] for z in rows for a in columns])

    def free(layer: int, side: Array) -> Array:
        depth = float(((goals - middle) @ side).max())
        places = sheet + (depth + layer * step) * side
        return np.asarray(places[setting.surroundings.lack(places) <= 0])

    blocked = False
    for layer in range(1, MOST_LAYERS + 1):
        behind = free(layer, direction)
        if not len(behind) and not blocked:
            blocked = True
            yield free(1, -direction)
        yield behind


def _viewing_direction(goals: Array, setting: SpacingTask, facing: Array) -> Array:
    """Return the horizontal viewing direction of the picture, (3,)."""
    if setting.viewpoint is None:
        return facing
    east, north = (goals.mean(axis=0) - setting.viewpoint)[:2]
    length = hypot(east, north)
    return np.array([east / length, north / length, 0.0]) if length > 1e-6 else facing


def _steps(along: Array, step: float) -> Array:
    """Return the multiples of a step around 0 that a picture spans along one axis."""
    most = floor(float(np.abs(along).max()) / step)
    return step * np.arange(-most, most + 1, dtype=np.float64)
