"""Checks of the effects of a fleet's lights in a plan file beyond their types."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from shotc.ir.fleet import Lights
from shotc.ir.light_layers import Axis, Band, Footage, Glints, Gradient, Layer, Radius, Tint
from shotc.ir.light_paints import pixels

Fault = tuple[str, str]

MOST_PIXELS = 16_000_000
"""Most pixels of all frames of an image together."""


def light_faults(lights: Lights, path: str) -> Iterator[Fault]:
    """Yield (path, fault) for everything that prevents the evaluation of the effects."""
    if len(lights.of) != (len(lights.times) if lights.looks else 0):
        yield f"{path}.of", "does not say for every time which look holds"
    if any(not -1 <= look < len(lights.looks) for look in lights.of):
        yield f"{path}.of", "names a look that there is not"
    for i, look in enumerate(lights.looks):
        if any(not 0 <= drone < len(lights.colors) for drone in look.spare):
            yield f"{path}.looks[{i}].spare", "names a drone that there is not"
        for k, layer in enumerate(look.layers):
            yield from _layer(layer, f"{path}.looks[{i}].layers[{k}]")
    for k, layer in enumerate(lights.over):
        yield from _layer(layer, f"{path}.over[{k}]")


def _layer(layer: Layer, path: str) -> Iterator[Fault]:
    if not 0.0 <= layer.opacity <= 1.0:
        yield f"{path}.opacity", f"{layer.opacity:g} is not between 0 and 1"
    if isinstance(layer.paint, Footage):
        yield from _footage(layer.paint, f"{path}.paint")
    else:
        yield from _paint(layer.paint, f"{path}.paint")


def _paint(paint: Tint | Gradient | Band | Glints, path: str) -> Iterator[Fault]:
    colors = paint.colors if isinstance(paint, Gradient) else (paint.color,)
    if any(not 0 <= part <= 255 for color in colors for part in color):
        yield path, "a part of a colour is not between 0 and 255"
    if isinstance(paint, Gradient) and (
        not paint.at or len(paint.at) != len(paint.colors) or any(b < a for a, b in pairwise(paint.at))
    ):
        yield f"{path}.at", "does not rise, or does not have a place for every colour"
    if isinstance(paint, Glints) and paint.period <= 0:
        yield f"{path}.period", f"{paint.period:g} is not positive"
    if isinstance(paint, Glints) and not 0 <= paint.seed < 2**32:
        yield f"{path}.seed", "is not between 0 and 2^32"
    if isinstance(paint, Band) and not 0.0 < paint.length <= 1.0:
        yield f"{path}.length", f"{paint.length:g} is not between 0 and 1"
    along = paint.along if isinstance(paint, Band | Gradient) else None
    if isinstance(along, Axis) and not along.high > along.low:
        yield f"{path}.along", "has no length"
    if isinstance(along, Radius) and not along.reach > 0:
        yield f"{path}.along.reach", f"{along.reach:g} is not positive"


def _footage(paint: Footage, path: str) -> Iterator[Fault]:
    if not paint.ends or paint.ends[0] <= 0 or any(b < a for a, b in pairwise(paint.ends)):
        yield f"{path}.ends", "do not rise"
        return
    if min(paint.screen.width, paint.screen.height) <= 0:
        yield f"{path}.screen", "has no size"
    if min(paint.rows, paint.columns) <= 0 or paint.rows * paint.columns * len(paint.ends) > MOST_PIXELS:
        yield path, f"{len(paint.ends)} frames of {paint.columns} x {paint.rows} pixels are not read"
        return
    try:
        pixels(paint)
    except ValueError as fault:
        yield f"{path}.rgba", f"is no image: {fault}"
