"""Enlarged pictures, and their sizes in the mission language. Plain Python."""

from __future__ import annotations

from collections.abc import Callable

from shotc.ir.show import Box, Model, Picture, RecordedFlight, Source, Sphere, Torus
from shotc.rounding import up
from shotc.show.geom.shape import balls, lowest

SPARE_M = 0.02
"""Metres that a picture is moved up beyond need: seen from below, its goals lie a little otherwise."""


def resized(source: Source, change: Callable[[float], float]) -> Source:
    """Return a picture with all its sizes in metres changed by a function; a model without a height is
    unchanged.
    """
    if isinstance(source, Sphere):
        return source._replace(radius=change(source.radius))
    if isinstance(source, Torus):
        return source._replace(radius=change(source.radius), tube=change(source.tube))
    if isinstance(source, Box):
        a, b, c = source.size
        return source._replace(size=(change(a), change(b), change(c)))
    if isinstance(source, RecordedFlight) or source.height is None:
        return source
    return source._replace(height=change(source.height))


def larger(source: Source, factor: float, tall: float = 0.0) -> Source:
    """Return a picture enlarged by a factor, with its written sizes rounded up.

    tall : present height of a model without a written one, metres
    """
    if isinstance(source, Model) and source.height is None:
        source = source._replace(height=tall)
    return resized(source, lambda metres: up(metres * factor, 1))


def raised(source: Source, floor: float) -> Source:
    """Return a picture raised to above a height, rounded up to a decimetre, if its centre is known."""
    lack = floor - lowest(balls(source)) if balls(source) else 0.0
    return source if lack <= 1e-6 else _higher(source, lack)


def size_words(before: Source, after: Source) -> str:
    """Return the text to write for an enlarged, and possibly raised, picture."""
    words = _sizes(after)
    if after.centre != before.centre and after.centre is not None:
        words += f", center: [{', '.join(f'{c:g}' for c in after.centre)}]"
    return words


def enlarged(picture: Picture, factor: float, floor: float, tall: float = 0.0) -> Picture:
    """Return an enlarged picture that stays above a height, metres."""
    return picture._replace(source=raised(larger(picture.source, factor, tall), floor))


def lifted(picture: Picture, metres: float) -> Picture:
    """Return a picture moved up by some metres, rounded up to a decimetre, if its centre is known; unchanged
    for none or less.
    """
    return picture if metres <= 0.0 else picture._replace(source=_higher(picture.source, metres + SPARE_M))


def _higher(source: Source, metres: float) -> Source:
    if source.centre is None:
        return source
    x, y, z = source.centre
    return source._replace(centre=(x, y, up(z + metres, 1)))


def _sizes(source: Source) -> str:
    if isinstance(source, Sphere):
        return f"radius: {source.radius:.1f}"
    if isinstance(source, Torus):
        return f"radius: {source.radius:.1f}, tube: {source.tube:.1f}"
    if isinstance(source, Box):
        return f"size: {source.size[0]:.1f}"
    return "" if isinstance(source, RecordedFlight) else f"height: {source.height:.1f}"
