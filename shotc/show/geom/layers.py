"""Flat pictures in layers behind each other: lights that look nearer than the drones are.

Every layer is a lattice as dense as the separation d allows, and its places stand in the gaps of the others.
Of two layers of squares neighbours look d / sqrt 2 apart, of three of hexagons d / sqrt 3, of four d / 2;
each layer is so far behind the one before that neighbours are d apart in space. Drones that keep upright
cylinders free stand in squares, and their layers d apart.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.show.geom.lattice import MOST_BISECTIONS, MOST_POINTS, Mould, rows_of

MOST_LAYERS = 4
_SQUARE = {
    2: ((0.5, 0.5),),
    3: ((1 / 3, 1 / 3), (2 / 3, 2 / 3)),
    4: ((0.5, 0.5), (0.5, 0.0), (0.0, 0.5)),
}
_HEXAGON = {
    3: ((0.5, sqrt(3.0) / 6.0), (0.0, sqrt(3.0) / 3.0)),
    4: ((0.5, 0.0), (0.25, sqrt(3.0) / 4.0), (0.75, sqrt(3.0) / 4.0)),
}


class Layers(NamedTuple):
    """How layers stand: where each lattice is shifted to, in steps, and how far it is behind the one before.

    square : whether the lattice is of squares, else of hexagons; depth : in steps
    seen : how near two lights look, in steps
    """

    square: bool
    shifts: tuple[tuple[float, float], ...]
    depth: float
    seen: float


def layers_of(count: int, upright: bool) -> Layers:
    """Return how so many layers stand; upright : for drones that keep upright cylinders free."""
    square = upright or count == 2
    shifts = ((0.0, 0.0), *(_SQUARE if square else _HEXAGON)[count])
    low = rows_of(np.full(2, -2.0), np.full(2, 4.0), 1.0, square)
    places = np.concatenate([low + np.array(shift) for shift in shifts])
    away = np.linalg.norm(places - places[np.linalg.norm(places, axis=1).argmin()], axis=1)
    seen = float(away[away > 1e-9].min())
    return Layers(square, shifts, 1.0 if upright else sqrt(1.0 - seen**2), seen)


def layered(mould: Mould, layers: Layers, step: float) -> tuple[Array, Array]:
    """Return the places of all layers in a shape, (K, 2), and the number of each one's layer, (K,)."""
    points = np.asarray(mould.shape.data)
    low, high = points.min(axis=0) - mould.slack, points.max(axis=0) + mould.slack
    if np.prod(np.ceil((high - low) / step) + 1.0) > MOST_POINTS:
        return np.zeros((0, 2)), np.zeros(0, dtype=np.intp)
    each = [rows_of(low - step, high + step, step, layers.square) + step * np.array(s) for s in layers.shifts]
    places = np.concatenate(each)
    number = np.repeat(np.arange(len(each)), [len(part) for part in each])
    inside = np.isfinite(mould.shape.query(places, distance_upper_bound=mould.slack)[0])
    return places[inside], number[inside]


def widest_layers(mould: Mould, layers: Layers, number: int, least: float) -> tuple[Array, Array]:
    """Return places as ``layered`` in the widest lattice with so many, or in the densest where none has."""
    best = layered(mould, layers, least)
    if len(best[0]) < number:
        return best
    low, high = least, 1.1 * least * sqrt(len(best[0]) / number)
    for _ in range(MOST_BISECTIONS):
        middle = 0.5 * (low + high)
        found = layered(mould, layers, middle)
        if len(found[0]) >= number:
            low, best = middle, found
        else:
            high = middle
    kept = np.linspace(0, len(best[0]) - 1, number).round().astype(np.intp)
    return best[0][kept], best[1][kept]
