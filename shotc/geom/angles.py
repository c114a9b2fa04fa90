"""Angles by whole turns. Plain arithmetic, so that it takes floats and numpy arrays alike."""

from math import pi
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:  # `check` loads this without numpy
    from shotc.geom.bernstein import Array

A = TypeVar("A", float, "Array")

TURN = 2 * pi


def wrapped(angle: A) -> A:
    """Return an angle in [-pi, pi), rad: the shorter turn, half a turn to the right."""
    return (angle + pi) % TURN - pi


def direction(angle: float) -> float:
    """Return an angle in (-pi, pi], rad, as yaws are written."""
    least = wrapped(angle)
    return pi if least == -pi else least
