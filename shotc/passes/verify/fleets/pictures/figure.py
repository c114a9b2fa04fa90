"""The shape that a picture is to show: points of it, and how far places are from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """A shape in W, metres.

    points : all over it, shape (M, 3); weights : of each, for the part of it that it stands for, (M,), sum 1
    off : from places (n, 3) to their distances from it, (n,)
    part : from a number of drones to the length of the part of the shape that each of them stands for
    """

    points: Array
    weights: Array
    off: Callable[[Array], Array]
    part: Callable[[int], float]

    @property
    def middle(self) -> Array:
        """Return the middle of the shape, (3,)."""
        return np.asarray(self.weights @ self.points)

    @property
    def spread(self) -> Array:
        """Return the covariance of the shape's points, (3, 3)."""
        about = self.points - self.middle
        return np.asarray((about * self.weights[:, None]).T @ about)


def evenly(number: int) -> Array:
    """Return the weights of evenly distributed points, shape (number,)."""
    return np.full(number, 1.0 / number)


def turned(heading: float) -> Array:
    """Return the rows right, ahead and up, (3, 3), of somebody who looks along a heading, rad."""
    right = (np.cos(heading), -np.sin(heading), 0.0)
    ahead = (np.sin(heading), np.cos(heading), 0.0)
    return np.array([right, ahead, (0.0, 0.0, 1.0)])
