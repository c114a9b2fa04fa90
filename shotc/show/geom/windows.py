"""The stops of a fleet, and the stretches in between, each of which is a spline of its own.

A fleet stops at a break where the three control points that count there are equal, for every drone. Neither
side depends on the other: the derivatives' control points across the stop are zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE


@dataclass(frozen=True, slots=True)
class Window:
    """The pieces from break ``first`` to break ``last``, between two stops."""

    first: int
    last: int

    @property
    def points(self) -> slice:
        """Return the range of its control points."""
        return slice(self.first, self.last + DEGREE)

    @property
    def pieces(self) -> slice:
        """Return the range of its pieces."""
        return slice(self.first, self.last)

    def breaks(self, breaks: Array) -> Array:
        """Return its own of all breaks (P + 1,), shape (pieces + 1,)."""
        return breaks[self.first : self.last + 1]


def at_rest(coef: Array) -> NDArray[np.intp]:
    """Return the breaks at which all drones stop.

    coef : shape (n, P + 3, 3)
    """
    still = (np.diff(coef, axis=1) == 0.0).all(axis=(0, 2))
    return np.flatnonzero(still[:-1] & still[1:])


def windows(coef: Array) -> list[Window]:
    """Return the stretches in which a drone moves.

    coef : shape (n, P + 3, 3)
    """
    return [Window(int(a), int(b)) for a, b in pairwise(at_rest(coef)) if b - a > 1]


def stops(coef: Array) -> list[int]:
    """Return the breaks at which a fleet stops, the first of each hold; coef : (n, P + 3, 3)."""
    at = at_rest(coef)
    return [int(b) for k, b in enumerate(at) if k == 0 or b - at[k - 1] > 1]
