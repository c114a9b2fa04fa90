"""A few upright boxes and cylinders that contain upright prisms tightly. Plain Python.

A ring that fills its smallest rectangle badly, such as an L, is cut at its corners along the sides of that
rectangle. The smallest prisms are joined until there are few, and prisms that make one box are joined. Every
body contains its prisms, up to rounding.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import atan2, cos, hypot, pi, sin
from typing import NamedTuple

from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape
from shotc.geom.solids import convex_hull, edges, signed_area
from shotc.geom.vec import Vec2, Vec3

FILLED_SHARE = 0.8
"""Least share of its body's base that a ring fills; a ring with less is cut."""
GAIN_SHARE = 0.12
"""Least share of a base that a cut removes."""
ON_M = 1e-6
"""Distance from a cut up to which a corner is on it, metres."""
MOST_CUTS = 40  # cuts that are tried along one axis of a ring
MOST_TURNS = 90  # directions of sides that are tried for rectangles
MOST_PIECES = 6  # of one ring
SAME_VOLUME_RATIO = 1.02
"""Largest volume of a box around two bodies, over theirs, at which they are joined."""

Ring = tuple[Vec2, ...]


class UprightPrism(NamedTuple):
    """An upright prism over a simple ring, metres of W.

    name : of its part of a building
    """

    ring: Ring
    bottom: float
    top: float
    name: str = ""


class EnclosingShape(NamedTuple):
    """A shape about its centre, metres of W; name : of all prisms in it, empty if they differ."""

    centre: Vec3
    shape: BodyShape
    name: str = ""


class _Base(NamedTuple):
    """The base of a body: half its sides along its course and across it, or a radius."""

    middle: Vec2
    ahead: Vec2
    half: Vec2
    radius: float | None = None

    @property
    def area(self) -> float:
        return 4.0 * self.half[0] * self.half[1] if self.radius is None else pi * self.radius**2


class _Aligned(NamedTuple):
    """Prisms for one body, and their bounding box along common axes.

    low, high : its corners: along, across and up
    """

    blocks: tuple[UprightPrism, ...]
    low: Vec3
    high: Vec3

    @property
    def volume(self) -> float:
        a, b, c = (max(0.0, high - low) for low, high in zip(self.low, self.high, strict=True))
        return a * b * c


def bodies_about(blocks: Sequence[UprightPrism], most: int) -> tuple[EnclosingShape, ...]:
    """Return at most ``most`` bodies that together contain all prisms; there is at least one prism."""
    course = _base(tuple(p for block in blocks for p in block.ring)).ahead
    pieces = [b._replace(ring=ring) for b in blocks for ring in _cut(b.ring, MOST_PIECES)]
    return tuple(_body(body.blocks) for body in _few([_aligned(p, course) for p in pieces], most))


def _base(points: Ring) -> _Base:
    """Return the smallest rectangle around points, or the circle about its middle if that is smaller."""
    hull = convex_hull(points)
    turns = [atan2(b[1] - a[1], b[0] - a[0]) for a, b in edges(hull)]
    boxes = [_rectangle(hull, turn) for turn in turns[:: max(1, len(turns) // MOST_TURNS)]]
    box = min(boxes, key=lambda body: body.area)
    round_ = box._replace(radius=max(hypot(x - box.middle[0], y - box.middle[1]) for x, y in hull))
    return min(box, round_, key=lambda body: body.area)


def _rectangle(hull: Ring, turn: float) -> _Base:
    """Return the rectangle around points with sides at an angle, rad; its longer side is its length."""
    c, s = cos(turn), sin(turn)
    (low_a, high_a), (low_b, high_b) = _reach(hull, (c, s)), _reach(hull, (-s, c))
    a, b = (low_a + high_a) / 2, (low_b + high_b) / 2
    half = ((high_a - low_a) / 2, (high_b - low_b) / 2)
    middle = (a * c - b * s, a * s + b * c)
    return _Base(middle, (c, s), half) if half[0] >= half[1] else _Base(middle, (-s, c), half[::-1])


def _reach(points: Sequence[Vec2], axis: Vec2) -> Vec2:
    """Return the extent of points along an axis: minimum and maximum."""
    along = [x * axis[0] + y * axis[1] for x, y in points]
    return min(along), max(along)


def _cut(ring: Ring, most: int) -> list[Ring]:
    """Return pieces of a ring that fill their bases, or that no cut improves."""
    base = _base(ring)
    if most < 2 or abs(signed_area(ring)) >= FILLED_SHARE * base.area:
        return [ring]
    axes = (base.ahead, (-base.ahead[1], base.ahead[0]))
    halves = min(_halved(ring, axes), key=lambda two: sum(_extent(half, axes) for half in two), default=None)
    if halves is None or sum(_extent(half, axes) for half in halves) > (1.0 - GAIN_SHARE) * base.area:
        return [ring]
    a, b = halves
    first = _cut(a, most - 1)
    return [*first, *_cut(b, most - len(first))]


def _halved(ring: Ring, axes: tuple[Vec2, Vec2]) -> Iterator[tuple[Ring, Ring]]:
    """Yield both parts of a ring for each cut through its corners perpendicular to an axis."""
    for axis in axes:
        along = (x * axis[0] + y * axis[1] for x, y in ring)
        places = sorted({round(at, 2): at for at in along}.values())[1:-1]
        for at in places[:: max(1, len(places) // MOST_CUTS)]:
            a, b = _clipped(ring, axis, at), _clipped(ring, (-axis[0], -axis[1]), -at)
            if len(a) > 2 and len(b) > 2:
                yield a, b


def _clipped(ring: Ring, axis: Vec2, at: float) -> Ring:
    """Return the part of a ring below a place along an axis (Sutherland and Hodgman).

    A corner at the place counts if one of its sides leads below.
    """
    over = [x * axis[0] + y * axis[1] - at for x, y in ring]
    out: list[Vec2] = []
    for i, (a, b) in enumerate(edges(ring)):
        u, v = over[i], over[(i + 1) % len(ring)]
        if u < -ON_M or (u <= ON_M and min(over[i - 1], v) < -ON_M):
            out.append(a)
        if min(u, v) < -ON_M and max(u, v) > ON_M:
            share = u / (u - v)
            out.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return tuple(out)


def _extent(points: Ring, axes: tuple[Vec2, Vec2]) -> float:
    """Return the area of the rectangle around points along two axes."""
    (a, b), (c, d) = (_reach(points, axis) for axis in axes)
    return (b - a) * (d - c)


def _aligned(block: UprightPrism, course: Vec2) -> _Aligned:
    (a, b), (c, d) = _reach(block.ring, course), _reach(block.ring, (-course[1], course[0]))
    return _Aligned((block,), (a, c, block.bottom), (b, d, block.top))


def _few(bodies: list[_Aligned], most: int) -> list[_Aligned]:
    """Join the smallest body with the one that grows least, until there are few.

    Then join those of one box.
    """
    while len(bodies) > most:
        smallest = min(range(len(bodies)), key=lambda i: bodies[i].volume)
        one = bodies.pop(smallest)
        other = min(range(len(bodies)), key=lambda i: _joined(one, bodies[i]).volume - bodies[i].volume)
        bodies[other] = _joined(one, bodies[other])
    while pair := next(_one_box(bodies), None):
        i, j = pair
        bodies[i] = _joined(bodies[i], bodies.pop(j))
    return bodies


def _one_box(bodies: list[_Aligned]) -> Iterator[tuple[int, int]]:
    """Yield pairs, the lower index first, whose common box is hardly larger than they are."""
    for j in range(len(bodies)):
        for i in range(j):
            both = bodies[i].volume + bodies[j].volume - _common(bodies[i], bodies[j])
            if _joined(bodies[i], bodies[j]).volume <= SAME_VOLUME_RATIO * both:
                yield i, j


def _common(a: _Aligned, b: _Aligned) -> float:
    """Return the volume of the intersection of two boxes."""
    low = (max(a.low[0], b.low[0]), max(a.low[1], b.low[1]), max(a.low[2], b.low[2]))
    high = (min(a.high[0], b.high[0]), min(a.high[1], b.high[1]), min(a.high[2], b.high[2]))
    return _Aligned((), low, high).volume


def _joined(a: _Aligned, b: _Aligned) -> _Aligned:
    low = (min(a.low[0], b.low[0]), min(a.low[1], b.low[1]), min(a.low[2], b.low[2]))
    high = (max(a.high[0], b.high[0]), max(a.high[1], b.high[1]), max(a.high[2], b.high[2]))
    return _Aligned((*a.blocks, *b.blocks), low, high)


def _body(blocks: tuple[UprightPrism, ...]) -> EnclosingShape:
    """Return the smallest body around prisms."""
    base = _base(tuple(p for block in blocks for p in block.ring))
    low, high = min(block.bottom for block in blocks), max(block.top for block in blocks)
    shape: BodyShape = CylinderShape(base.radius or 0.0, high - low)
    if base.radius is None:
        shape = BoxShape(2.0 * base.half[0], 2.0 * base.half[1], high - low, base.ahead)
    names = {block.name for block in blocks}
    return EnclosingShape((*base.middle, (low + high) / 2), shape, names.pop() if len(names) == 1 else "")
