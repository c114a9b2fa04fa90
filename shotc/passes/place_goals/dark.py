"""Where drones stand for which a picture has no room: dark, in a block behind the picture.

The block is a grid upright and square to the way the audience looks. Its places are as far apart as goals
have to be, and as far from the picture, so that straight moves between pictures keep the separation.
"""

from __future__ import annotations

from itertools import count
from math import floor, hypot

import numpy as np

from shotc.geom.bernstein import Array
from shotc.passes.place_goals.spaced import Setting

BEHIND = 1.001
"""Distance of dark drones from the picture and from each other, in spacings."""
LAYERS = 100
"""Layers of the block behind which no place is looked for."""
NORTH = np.array([0.0, 1.0, 0.0])


def dark_places(shown: Array, spare: int, setting: Setting) -> Array | None:
    """Return so many places behind goals (n, 3), shape (spare, 3), or None where there is no room."""
    away = _away(shown, setting)
    across = np.array([-away[1], away[0], 0.0])
    step = BEHIND * setting.least
    rise = step / setting.stretch
    depth = float(((shown - shown.mean(axis=0)) @ away).max())
    middle = shown.mean(axis=0)
    columns = _steps((shown - middle) @ across, step)
    rows = _steps(shown[:, 2] - middle[2], rise)
    sheet = middle + np.array([a * across + [0.0, 0.0, z] for z in rows for a in columns])
    found: list[Array] = []
    for layer in count(1):
        if spare <= 0 or layer > LAYERS:
            break
        places = sheet + (depth + layer * step) * away
        places = places[setting.room.lack(places) <= 0]
        chosen = np.unique(np.linspace(0, len(places) - 1, min(spare, len(places))).round().astype(np.intp))
        found.append(places[chosen])
        spare -= len(chosen)
    return None if spare > 0 else np.concatenate(found)


def _away(shown: Array, setting: Setting) -> Array:
    """Return the level direction in which the audience looks at the picture; North without an audience."""
    if setting.viewpoint is None:
        return NORTH
    east, north = (shown.mean(axis=0) - setting.viewpoint)[:2]
    length = hypot(east, north)
    return np.array([east / length, north / length, 0.0]) if length > 1e-6 else NORTH


def _steps(along: Array, step: float) -> Array:
    """Return the multiples of a step, about 0, that a picture spans along one axis."""
    most = floor(float(np.abs(along).max()) / step)
    return step * np.arange(-most, most + 1, dtype=np.float64)
