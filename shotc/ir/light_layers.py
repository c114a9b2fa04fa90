"""Effects of lights as a plan holds them: put into space and time, so that colours are a function of both.

Plain values: a plan's lights are evaluated where they are wanted (``ir.light_colors``), never stored moment
by moment. World frame W, metres; seconds of mission time.
"""

from __future__ import annotations

from typing import NamedTuple

from shotc.ir.effects import Blend, Color
from shotc.ir.limits import Vec3


class Axis(NamedTuple):
    """From 0 to 1 along a direction, of length 1: where ``direction . p`` is low, and where it is high."""

    direction: Vec3
    low: float
    high: float


class Radius(NamedTuple):
    """From 0 at a centre to 1 at a distance of ``reach`` metres from it; inward : the other way round."""

    centre: Vec3
    reach: float
    inward: bool


class Order(NamedTuple):
    """From 0 for the first drone of ``drones`` to 1 for the last."""

    drones: int


Along = Axis | Radius | Order


class Tint(NamedTuple):
    """One colour."""

    color: Color


class Gradient(NamedTuple):
    """Colours at places from 0 to 1, linear between them and constant beyond.

    A light's place is where it is ``along``, 0 for None, less ``rate`` (1/s) times the time since ``origin``
    cyclic : whether 1 is 0 again
    """

    colors: tuple[Color, ...]
    at: tuple[float, ...]
    along: Along | None
    rate: float
    origin: float
    cyclic: bool


class Band(NamedTuple):
    """A colour whose weight rises from the head of a band to 1 over a quarter of its length, and falls to 0.

    The head is at 0 at ``origin``, goes at ``rate`` (1/s), and begins anew at 1.
    """

    color: Color
    along: Along
    rate: float
    origin: float
    length: float


class Glints(NamedTuple):
    """A colour on a share of the lights, drawn anew for each light every period, s; it rises and falls."""

    color: Color
    share: float
    period: float
    seed: int


class Screen(NamedTuple):
    """Where an image is: seen from an eye, by three axes of length 1, as tangents of angles.

    left, bottom, width, height : of the image, of those that are seen along ``forward``
    """

    eye: Vec3
    right: Vec3
    up: Vec3
    forward: Vec3
    left: float
    bottom: float
    width: float
    height: float


class Footage(NamedTuple):
    """An image, or several that follow each other and begin anew, on a screen.

    rgba : bytes of shape (frames, rows, columns, 4), compressed by zlib, in base64
    ends : when each frame ends, seconds after the first began at ``origin``
    """

    rgba: str
    rows: int
    columns: int
    ends: tuple[float, ...]
    origin: float
    screen: Screen


Painted = Tint | Gradient | Band | Glints | Footage


class Layer(NamedTuple):
    """One effect of a stack; its weight is its paint's times opacity times that of the time.

    span : four times; the weight rises from 0 at the first to 1 at the second, and falls from the third on
    to 0 at the last; it is 0 before and after
    """

    paint: Painted
    blend: Blend
    opacity: float
    span: tuple[float, float, float, float]


class Look(NamedTuple):
    """What is laid over the colours of a picture; spare : numbers of drones that it leaves dark, from 0."""

    layers: tuple[Layer, ...]
    spare: tuple[int, ...]
