"""The shape of a picture after its source is read: something from which points can be drawn."""

from __future__ import annotations

from typing import Literal, NamedTuple, Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors

Fill = Literal["volume", "surface", "outline"]


class PlacedShape(Protocol):
    """A shape at its place in W, metres."""

    def draw(self, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
        """Return points drawn uniformly from its inside, surface or edges, shape (count, 3); None if it has
        none.

        A point cloud gives its own points, at most ``count`` of them.
        """
        ...

    def encloses(self, place: Array) -> bool:
        """Return whether a place (3,) is inside."""
        ...

    def colors(self, places: Array) -> Colors | None:
        """Return its own colours at places (n, 3), shape (n, 3); None if it has none."""
        ...


class SourceFault(NamedTuple):
    """The reason why a source cannot be drawn.

    key : faulty key of the source
    """

    code: str
    key: str
    message: str
    notes: tuple[str, ...] = ()
    help: str = ""


def upright_axes(heading: float) -> Array:
    """Return the axes (right, ahead, up), one a row, of a viewer who looks along a compass heading, rad."""
    c, s = np.cos(heading), np.sin(heading)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
