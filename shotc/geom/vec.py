"""Vectors of floats in the plan and in space, and angles. Plain Python, so that `check` can use it. Functions
of angles take numpy arrays as well.
"""

from math import pi
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:  # `check` loads this without numpy
    from shotc.geom.bernstein import Array


Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]


def plus(a: Vec3, b: Vec3) -> Vec3:
    """Return the sum of two vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a: Vec3, b: Vec3) -> Vec3:
    """Return the vector from b to a."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


A = TypeVar("A", float, "Array")

TURN_RAD = 2 * pi


def wrapped(angle: A) -> A:
    """Return the equivalent angle in [-pi, pi), rad; half a turn becomes -pi."""
    return (angle + pi) % TURN_RAD - pi


def direction(angle: float) -> float:
    """Return the equivalent angle in (-pi, pi], rad, the range of yaws."""
    least = wrapped(angle)
    return pi if least == -pi else least
