"""Approximations of pictures that need no mesh or font: balls, and bounding boxes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import cos, dist, hypot, pi, sin
from typing import NamedTuple

from shotc.geom.solids import box, signed_distance
from shotc.ir.limits import Vec3
from shotc.ir.show import Box, Drawing, Lettering, Model, Picture, RecordedFlight, Source, Sphere, Torus

NARROW_SHARE = 0.3  # least width of a letter over the height of a capital
SMALL_LETTER_SHARE = 0.5  # least height of small letters over that of capitals
RING_BALLS = 24  # balls in a ring
ALONG_SHARES = (-1.0, -0.5, 0.0, 0.5, 1.0)


class Ball(NamedTuple):
    """A ball inside a shape."""

    centre: Vec3
    radius: float


def balls(source: Source) -> tuple[Ball, ...]:
    """Return balls, or points, that are inside a shape; none if its place is unknown.

    For a sphere they are all of it. For other shapes the lowest and the highest of them are as low and as
    high as the shape; the size of a text and a drawing is a lower bound.
    """
    if isinstance(source, Sphere):
        return (Ball(source.centre, source.radius),)
    if isinstance(source, Box):
        return tuple(_of_box(source))
    if isinstance(source, Torus):
        return tuple(_of_ring(source))
    if isinstance(source, Model):
        if source.centre is None or source.height is None:
            return ()
        return tuple(_upright(source.centre, source.height))
    if isinstance(source, Drawing):
        return tuple(_upright(source.centre, source.height))
    if isinstance(source, RecordedFlight):
        return ()
    return tuple(_of_text(source))


def bounds(source: Source) -> tuple[Vec3, Vec3] | None:
    """Return the corners of a shape's bounding box; None if it is unknown."""
    if not isinstance(source, Sphere | Box | Torus):
        return None
    c = source.centre
    if isinstance(source, Sphere):
        half = (source.radius,) * 3
    elif isinstance(source, Torus):
        half = _ring_reach(source)
    else:
        corners = box(c, source.size, source.heading).points
        half = (max(x for x, _ in corners) - c[0], max(y for _, y in corners) - c[1], source.size[2] / 2)
    low, high = ((c[0] + s * half[0], c[1] + s * half[1], c[2] + s * half[2]) for s in (-1, 1))
    return low, high


def lowest(shape: tuple[Ball, ...]) -> float:
    """Return the lowest z of balls."""
    return min(ball.centre[2] - ball.radius for ball in shape)


def highest(shape: tuple[Ball, ...]) -> float:
    """Return the highest z of balls."""
    return max(ball.centre[2] + ball.radius for ball in shape)


def depth_in(picture: Picture, p: Vec3, thick: float) -> float:
    """Return the depth of a point in a shape, metres; negative if it is outside or unknown.

    thick : metres before and behind a flat text that count as inside
    """
    source = picture.source
    if isinstance(source, Sphere):
        return source.radius - dist(source.centre, p)
    if isinstance(source, Box):
        return -signed_distance(box(source.centre, source.size, source.heading), p)
    if isinstance(source, Torus):
        return source.tube - _from_ring(source, p)
    if isinstance(source, Lettering):
        solid = box(source.centre, (_width(source), 2 * thick, _tall(source)), source.heading)
        return -signed_distance(solid, p)
    return -1.0


def _of_box(source: Box) -> Iterator[Ball]:
    """Yield points of a box, its corners included."""
    c, s = cos(source.heading), sin(source.heading)
    for i, j, k in product(ALONG_SHARES, repeat=3):
        x, y, z = (share * side / 2 for share, side in zip((i, j, k), source.size, strict=True))
        at = source.centre
        yield Ball((at[0] + x * c + y * s, at[1] - x * s + y * c, at[2] + z), 0.0)


def _axis(source: Torus) -> Vec3:
    """Return the direction of a ring's axis: up at tilt 0, along its heading at 90 degrees."""
    across = sin(source.tilt)
    return (across * sin(source.heading), across * cos(source.heading), cos(source.tilt))


def _of_ring(source: Torus) -> Iterator[Ball]:
    """Yield balls along the middle of a ring's tube, its lowest and highest place included."""
    level = (cos(source.heading), -sin(source.heading), 0.0)
    n = _axis(source)
    # level x n, the steepest direction in the ring's plane
    steep = (level[1] * n[2], -level[0] * n[2], level[0] * n[1] - level[1] * n[0])
    for i in range(RING_BALLS):
        a, b = source.radius * cos(2 * pi * i / RING_BALLS), source.radius * sin(2 * pi * i / RING_BALLS)
        x, y, z = (o + a * u + b * v for o, u, v in zip(source.centre, level, steep, strict=True))
        yield Ball((x, y, z), source.tube)


def _ring_reach(source: Torus) -> Vec3:
    """Return the reach of a ring from its centre along each axis of W."""
    east, north, up = (source.radius * max(0.0, 1 - n * n) ** 0.5 + source.tube for n in _axis(source))
    return (east, north, up)


def _from_ring(source: Torus, p: Vec3) -> float:
    """Return the distance of a point from the middle of the tube."""
    d = [a - b for a, b in zip(p, source.centre, strict=True)]
    n = _axis(source)
    along = sum(a * b for a, b in zip(d, n, strict=True))
    across = dist(d, [along * c for c in n])
    return hypot(across - source.radius, along)


def _upright(centre: Vec3, height: float) -> Iterator[Ball]:
    x, y, z = centre
    yield from (Ball((x, y, z + share * height / 2), 0.0) for share in ALONG_SHARES)


def _of_text(source: Lettering) -> Iterator[Ball]:
    """Yield points of the smallest extent of a text: narrow letters, as high as the lowest."""
    half, c, s = _width(source) / 2, cos(source.heading), sin(source.heading)
    x, y, z = source.centre
    for i, k in product(ALONG_SHARES, repeat=2):
        yield Ball((x + i * half * c, y - i * half * s, z + k * _tall(source) / 2), 0.0)


def _width(source: Lettering) -> float:
    return NARROW_SHARE * source.height * sum(not letter.isspace() for letter in source.text)


def _tall(source: Lettering) -> float:
    capitals = any(letter.isupper() or letter.isdigit() for letter in source.text)
    return source.height if capitals else SMALL_LETTER_SHARE * source.height
