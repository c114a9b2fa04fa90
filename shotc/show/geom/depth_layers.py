"""Flat pictures in layers one behind another, whose lights appear nearer to each other than the drones are.

Every layer is a lattice as dense as the separation d allows, and the layers are shifted into each other's
gaps. With two square layers, neighbours appear d / sqrt 2 apart; with three hexagonal ones d / sqrt 3; with
four d / 2. The depth between layers is such that neighbours are d apart in space. Drones that keep vertical
cylinders free stand in squares, with layers d apart.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.show.geom.lattice import MOST_BISECTIONS, MOST_POINTS, Mould, rows_of

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
    """The arrangement of layers.

    square : whether the lattice is square, else hexagonal
    shifts : shift of each layer, in steps
    depth : distance of consecutive layers, in steps
    seen : apparent distance of two lights, in steps
    """

    square: bool
    shifts: tuple[tuple[float, float], ...]
    depth: float
    seen: float


def layers_of(count: int, upright: bool) -> Layers:
    """Return the arrangement of ``count`` layers.

    upright : whether drones keep vertical cylinders free
    """
    square = upright or count == 2
    shifts = ((0.0, 0.0), *(_SQUARE if square else _HEXAGON)[count])
    low = rows_of(np.full(2, -2.0), np.full(2, 4.0), 1.0, square)
    places = np.concatenate([low + np.array(shift) for shift in shifts])
    distances = np.linalg.norm(places - places[np.linalg.norm(places, axis=1).argmin()], axis=1)
    seen = float(distances[distances > 1e-9].min())
    return Layers(square, shifts, 1.0 if upright else sqrt(1.0 - seen**2), seen)


def layered(mould: Mould, layers: Layers, step: float) -> tuple[Array, Array]:
    """Return the places of all layers in a shape, (K, 2), and the layer of each, (K,)."""
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
    """Return places (K, 2) and their layers (K,), as ``layered``, of the widest lattice with ``number``
    places, or else of the densest one.
    """
    best = layered(mould, layers, least)
    if len(best[0]) < number:
        return best
    low, high = least, 1.1 * least * sqrt(len(best[0]) / number)
    for _ in range(MOST_BISECTIONS):
        middle = 0.5 * (low + high)
        sheets = layered(mould, layers, middle)
        if len(sheets[0]) >= number:
            low, best = middle, sheets
        else:
            high = middle
    chosen = np.linspace(0, len(best[0]) - 1, number).round().astype(np.intp)
    return best[0][chosen], best[1][chosen]
