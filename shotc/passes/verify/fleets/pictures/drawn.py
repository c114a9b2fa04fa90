"""Check that the lights of a standing picture draw its shape: on it, all over it, at its place, in its size.

Planning gives each of n drones an even part of the shape, of length ``part`` = s (in layers, the drones of
each layer). It puts a light in the middle of its part, and pushes lights apart where they need more ``room``
= g. That is the separation at which straight moves are safe: root two times that of the fleet, and more where
heights count less. From this follow the limits:

- A light in the middle of its part is off a curved shape by less than half a part. One that is pushed goes a
  quarter of g from the shape, a fifth more in the last round. So it is within 0.3 g + 0.5 s of a solid. The
  lights of a text are drawn back to its strokes, to 0.24 g and the gaps between the points drawn from them.
- No point of the shape is farther from a light than 1.5 times the larger of s and g.
- The middle of the lights is that of the shape to half a part. Along each axis their standard deviation is at
  most a fifth of s above that of the shape, and below it by what is within the parts (s^2 / 12 of the
  variance, doubled for uneven parts). Where g is more than 0.8 s, lights are pushed: both may change by the
  excess.
- Layers of a text lie behind one another, g apart at most.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.apart import straight_spacing, stretch
from shotc.geom.bernstein import Array
from shotc.ir.fleet import FrameTimes
from shotc.ir.show import Apart, Box, Display, Lettering, Picture, Sphere, Torus
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.lights import shining
from shotc.passes.verify.fleets.pictures.figure import Figure, turned
from shotc.passes.verify.fleets.pictures.solids import solid_figure
from shotc.passes.verify.fleets.pictures.texts import text_figure

OFF_ROOM, OFF_PART, OFF_HEIGHT = 0.3, 0.5, 0.02
"""Shares of the room, of a part, and (of texts) of the height of letters in the distance from the shape."""

BARE_RATIO = 1.5
"""Largest distance of the shape from a light, over the larger of a part and the room."""

WIDER_STROKES_SHARE = 0.3
"""The share of size of a text: each of its outlines has a whole number of lights, so parts are uneven."""

PUSHED_RATIO = 0.8
"""Room over the length of a part, above which lights may be pushed apart."""

ASIDE_PART, WIDER_PART, WITHIN = 0.5, 0.2, 2.0 / 12.0
"""Shares of a part in the error of place and of size, and of its square in the variance within parts."""


@dataclass(frozen=True, slots=True, eq=False)
class _Lit:
    """A standing picture: its lights (n, 3), their numbers, the shape, and the two lengths of the rules."""

    stand: FrameTimes
    picture: Picture
    lights: Array
    numbers: NDArray[np.intp]
    figure: Figure
    part: float
    room: float

    @property
    def pushed(self) -> float:
        """By how much lights may have been pushed out of the middle of their parts, metres."""
        return max(self.room - PUSHED_RATIO * self.part, 0.0)

    @property
    def deep(self) -> float:
        """Half of the depth of its layers, metres."""
        return 0.5 * (self.picture.layers - 1) * self.room


@dataclass(frozen=True, slots=True)
class _Measured:
    """A measured value of one picture, with its limit; light : index of the worst light, if it has one."""

    value: float
    limit: float
    of: _Lit
    light: int | None = None

    @property
    def used(self) -> float:
        """The share of the limit that is used."""
        return self.value / max(self.limit, 1e-9)


def drawn(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield claims that texts and solids are drawn, and on how many pictures are not judged.

    frames : of the display, each of a picture that it has
    """
    figures = [_figure(picture) for picture in display.pictures]
    judged = [lit for s in frames if (lit := _lit(flight, display, s, figures[s.picture])) is not None]
    for name, measure in (
        ("light off its picture", _off),
        ("picture without lights", _bare),
        ("picture off its place", _aside),
        ("picture off its size", _resized),
    ):
        if judged:
            worst = max((measure(one) for one in judged), key=lambda m: m.used)
            yield _claim(flight, display, name, worst)
    unjudged = sum(figure is None for figure in figures)
    if unjudged:
        limit = Limit("pictures of a file", float(len(display.pictures)), "", display.path, shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(float(unjudged), None, "exact"))


def _claim(flight: FleetFlight, display: Display, name: str, worst: _Measured) -> Claim:
    limit = Limit(name, worst.limit, "m", worst.of.picture.path, shot=display.id)
    time, subject = worst.of.stand.start, flight.fleet.name
    if worst.light is None:
        return held(subject, limit, WorstValue(worst.value, time, "exact"))
    x, y, z = (float(c) for c in worst.of.lights[worst.light])
    drone = flight.names[int(worst.of.numbers[worst.light])]
    return held(subject, limit, WorstValue(worst.value, time, "exact", (x, y, z)), (drone,))


def _lit(flight: FleetFlight, display: Display, stand: FrameTimes, figure: Figure | None) -> _Lit | None:
    """Return a picture with its lights, if both are known."""
    picture = display.pictures[stand.picture]
    numbers = np.flatnonzero(shining(flight, stand))
    if figure is None or not len(numbers):
        return None
    lights = flight.at(stand.start)[numbers]
    part = figure.part(max(1, len(flight.pads) // picture.layers))
    return _Lit(stand, picture, lights, numbers, figure, part, _room(flight.fleet.apart))


def _figure(picture: Picture) -> Figure | None:
    """Return the shape of a picture; None where a file or a font of a machine has it."""
    source, fill = picture.source, picture.fill
    if isinstance(source, Lettering):
        return text_figure(source, outline=fill == "outline")
    if not isinstance(source, Sphere | Box | Torus) or fill == "legible":
        return None
    return solid_figure(source, fill)


def _room(apart: Apart) -> float:
    """Return the largest distance to which lights are pushed apart, metres."""
    return straight_spacing(apart) / min(1.0, stretch(apart))


def _off(lit: _Lit) -> _Measured:
    """Measure how far a light is from the shape."""
    source = lit.picture.source
    limit = OFF_ROOM * lit.room + OFF_PART * lit.part
    lights = lit.lights
    if isinstance(source, Lettering):
        limit = OFF_ROOM * lit.room + OFF_HEIGHT * source.height
        lights = _in_front(lit, source)
    off = lit.figure.off(lights)
    worst = int(off.argmax())
    return _Measured(float(off[worst]), limit, lit, worst)


def _in_front(lit: _Lit, source: Lettering) -> Array:
    """Return the lights of a text with layers moved into its plane, as far as layers may be deep."""
    ahead = turned(source.heading)[1]
    deep = (lit.lights - np.array(source.centre)) @ ahead
    return np.asarray(lit.lights - np.clip(deep, -lit.deep, lit.deep)[:, None] * ahead)


def _bare(lit: _Lit) -> _Measured:
    """Measure how far a point of the shape is from a light."""
    far = cKDTree(lit.lights).query(lit.figure.points)[0]
    return _Measured(float(far.max()), BARE_RATIO * max(lit.part, lit.room) + lit.deep, lit)


def _aside(lit: _Lit) -> _Measured:
    """Measure how far the middle of the lights is from that of the shape."""
    aside = float(np.linalg.norm(lit.lights.mean(axis=0) - lit.figure.middle))
    return _Measured(aside, ASIDE_PART * lit.part + lit.pushed + lit.deep, lit)


def _resized(lit: _Lit) -> _Measured:
    """Measure how much wider or narrower the lights are than the shape, along its worst principal axis."""
    lights = lit.lights
    variance, axes = np.linalg.eigh(lit.figure.spread)
    wide = np.sqrt(np.maximum(variance, 0.0))
    narrow = np.sqrt(np.maximum(variance - WITHIN * lit.part**2, 0.0))
    found = ((lights - lights.mean(axis=0)) @ axes).std(axis=0)
    excess = float(np.maximum(found - wide, narrow - found).max())
    wider = WIDER_STROKES_SHARE if isinstance(lit.picture.source, Lettering) else WIDER_PART
    return _Measured(max(excess, 0.0), wider * lit.part + lit.pushed + lit.deep, lit)
