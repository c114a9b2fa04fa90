"""Light effects as a plan stores them: with positions and times, so that colours are a function of both.

A plan stores these records and no samples; ``ir.light_colors`` evaluates them. World frame W, metres;
seconds of mission time.
"""

from __future__ import annotations

from typing import NamedTuple

from shotc.ir.effects import Blend, Color
from shotc.ir.limits import Vec3


class Axis(NamedTuple):
    """A coordinate along a unit vector: 0 where ``direction . p`` is ``low``, 1 where it is ``high``."""

    direction: Vec3
    low: float
    high: float


class Radius(NamedTuple):
    """A coordinate: 0 at a centre, 1 at ``reach`` metres from it.

    inward : 1 at the centre, 0 at ``reach``
    """

    centre: Vec3
    reach: float
    inward: bool


class Order(NamedTuple):
    """A coordinate by drone number: 0 for the first of ``drones``, 1 for the last."""

    drones: int


Along = Axis | Radius | Order


class Tint(NamedTuple):
    """One colour."""

    color: Color


class Gradient(NamedTuple):
    """Colours at coordinates from 0 to 1, linear between them and constant beyond.

    The coordinate of a light is that of ``along`` (0 for None) minus ``rate`` (1/s) times the time since
    ``origin``.
    cyclic : whether coordinates repeat with period 1
    """

    colors: tuple[Color, ...]
    at: tuple[float, ...]
    along: Along | None
    rate: float
    origin: float
    cyclic: bool


class Band(NamedTuple):
    """A band of one colour: behind its head the weight rises to 1 over a quarter of its length, then falls to
    0.

    The head is at coordinate 0 at time ``origin``, moves at ``rate`` (1/s), and restarts at 0 from 1.
    """

    color: Color
    along: Along
    rate: float
    origin: float
    length: float


class Glints(NamedTuple):
    """A colour that flashes on a random share of the lights, drawn again for each light every period, s."""

    color: Color
    share: float
    period: float
    seed: int


class Screen(NamedTuple):
    """The position of an image as seen from an eye with three unit axes; sizes are tangents of angles.

    left, bottom, width, height : of the image, in the plane at distance 1 along ``forward``
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
    """An image, or a repeated sequence of images, on a screen.

    rgba : bytes of shape (frames, rows, columns, 4), compressed by zlib, in base64
    ends : end of each frame, seconds after ``origin``, at which the first one begins
    """

    rgba: str
    rows: int
    columns: int
    ends: tuple[float, ...]
    origin: float
    screen: Screen


Painted = Tint | Gradient | Band | Glints | Footage


class FadeTimes(NamedTuple):
    """When a layer fades in and out, seconds: its weight rises from 0 at ``starts`` to 1 at ``full``, and
    falls from 1 at ``falls`` to 0 at ``ends``; it is 0 before and after.
    """

    starts: float
    full: float
    falls: float
    ends: float


class Layer(NamedTuple):
    """One effect of a stack; its weight is that of its paint, times its opacity, times that of its span."""

    paint: Painted
    blend: Blend
    opacity: float
    span: FadeTimes


class Look(NamedTuple):
    """The effects over the colours of a picture; spare : indices of drones that it leaves dark, from 0."""

    layers: tuple[Layer, ...]
    spare: tuple[int, ...]
