"""Few upright boxes and cylinders that hold what stands, and little beside. Plain Python.

What stands is given as upright prisms. A ring that fills its smallest rectangle badly, as that of an L does,
is cut at its corners along the sides of that rectangle; prisms that make one box are joined, and so are the
smallest until there are few. Every body holds the prisms that it is made of, to rounding.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import atan2, cos, hypot, pi, sin
from typing import NamedTuple

from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape
from shotc.geom.solids import convex_hull, edges, signed_area
from shotc.geom.vec import Vec2, Vec3

FILLED = 0.8
"""Share of its body's base that a ring fills, at least; one that fills less is cut."""
GAIN = 0.12
"""Share of a base that a cut takes away, at least."""
ON_M = 1e-6
"""Metres from a cut within which a corner is on it."""
MOST_CUTS = 40  # that are tried along one side of a ring
MOST_TURNS = 90  # directions of sides that rectangles are tried along
MOST_PIECES = 6  # of one ring
SAME = 1.02
"""Volume of a box about two, over theirs, up to which they are one."""

Ring = tuple[Vec2, ...]


class UprightPrism(NamedTuple):
    """An upright prism over a ring that does not cross itself, metres of W.

    name : of the part of a building that it is
    """

    ring: Ring
    bottom: float
    top: float
    name: str = ""


class EnclosingShape(NamedTuple):
    """A shape about its centre, metres of W; name : that of all prisms in it, empty where they differ."""

    centre: Vec3
    shape: BodyShape
    name: str = ""


class _Base(NamedTuple):
    """The base of a body: half its sides along its course and across it, or a radius alone."""

    middle: Vec2
    ahead: Vec2
    half: Vec2
    radius: float | None = None

    @property
    def area(self) -> float:
        return 4.0 * self.half[0] * self.half[1] if self.radius is None else pi * self.radius**2


class _Aligned(NamedTuple):
    """Prisms that one body shall hold, and the box about them along common axes.

    low, high : its corners, along, across and up
    """

    blocks: tuple[UprightPrism, ...]
    low: Vec3
    high: Vec3

    @property
    def volume(self) -> float:
        a, b, c = (max(0.0, high - low) for low, high in zip(self.low, self.high, strict=True))
        return a * b * c


def bodies_about(blocks: Sequence[UprightPrism], most: int) -> tuple[EnclosingShape, ...]:
    """Return at most ``most`` bodies that hold all prisms together; there is one prism or more."""
    course = _base(tuple(p for block in blocks for p in block.ring)).ahead
    pieces = [b._replace(ring=ring) for b in blocks for ring in _cut(b.ring, MOST_PIECES)]
    return tuple(_body(found.blocks) for found in _few([_aligned((p,), course) for p in pieces], most))


def _base(points: Ring) -> _Base:
    """Return the smallest rectangle about points, or the circle about its middle where that is smaller."""
    hull = convex_hull(points)
    turns = [atan2(b[1] - a[1], b[0] - a[0]) for a, b in edges(hull)]
    boxes = [_rectangle(hull, turn) for turn in turns[:: max(1, len(turns) // MOST_TURNS)]]
    box = min(boxes, key=lambda found: found.area)
    round_ = box._replace(radius=max(hypot(x - box.middle[0], y - box.middle[1]) for x, y in hull))
    return min(box, round_, key=lambda found: found.area)


def _rectangle(hull: Ring, turn: float) -> _Base:
    """Return the rectangle about points whose sides lie at an angle, its length first."""
    c, s = cos(turn), sin(turn)
    (low_a, high_a), (low_b, high_b) = _reach(hull, (c, s)), _reach(hull, (-s, c))
    a, b = (low_a + high_a) / 2, (low_b + high_b) / 2
    half = ((high_a - low_a) / 2, (high_b - low_b) / 2)
    middle = (a * c - b * s, a * s + b * c)
    return _Base(middle, (c, s), half) if half[0] >= half[1] else _Base(middle, (-s, c), half[::-1])


def _reach(points: Sequence[Vec2], axis: Vec2) -> Vec2:
    """Return from where to where points reach along an axis."""
    along = [x * axis[0] + y * axis[1] for x, y in points]
    return min(along), max(along)


def _cut(ring: Ring, most: int) -> list[Ring]:
    """Return pieces of a ring that fill their bases, or that no cut makes fill them better."""
    base = _base(ring)
    if most < 2 or abs(signed_area(ring)) >= FILLED * base.area:
        return [ring]
    axes = (base.ahead, (-base.ahead[1], base.ahead[0]))
    halves = min(_halved(ring, axes), key=lambda two: sum(_extent(half, axes) for half in two), default=None)
    if halves is None or sum(_extent(half, axes) for half in halves) > (1.0 - GAIN) * base.area:
        return [ring]
    a, b = halves
    first = _cut(a, most - 1)
    return [*first, *_cut(b, most - len(first))]


def _halved(ring: Ring, axes: tuple[Vec2, Vec2]) -> Iterator[tuple[Ring, Ring]]:
    """Yield both sides of a ring, cut through its corners along an axis."""
    for axis in axes:
        along = (x * axis[0] + y * axis[1] for x, y in ring)
        places = sorted({round(at, 2): at for at in along}.values())[1:-1]
        for at in places[:: max(1, len(places) // MOST_CUTS)]:
            a, b = _clipped(ring, axis, at), _clipped(ring, (-axis[0], -axis[1]), -at)
            if len(a) > 2 and len(b) > 2:
                yield a, b


def _clipped(ring: Ring, axis: Vec2, at: float) -> Ring:
    """Return what of a ring lies below a place along an axis (Sutherland and Hodgman).

    A corner at the place counts where a side of it leads below.
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
    """Return the area of the rectangle about points along two axes."""
    (a, b), (c, d) = (_reach(points, axis) for axis in axes)
    return (b - a) * (d - c)


def _aligned(blocks: tuple[UprightPrism, ...], course: Vec2) -> _Aligned:
    points = [p for block in blocks for p in block.ring]
    (a, b), (c, d) = _reach(points, course), _reach(points, (-course[1], course[0]))
    low, high = min(block.bottom for block in blocks), max(block.top for block in blocks)
    return _Aligned(blocks, (a, c, low), (b, d, high))


def _few(found: list[_Aligned], most: int) -> list[_Aligned]:
    """Join the smallest with what grows least by it, until there are few; then all that make one box."""
    while len(found) > most:
        smallest = min(range(len(found)), key=lambda i: found[i].volume)
        one = found.pop(smallest)
        other = min(range(len(found)), key=lambda i: _joined(one, found[i]).volume - found[i].volume)
        found[other] = _joined(one, found[other])
    while pair := next(_one_box(found), None):
        i, j = pair
        found[i] = _joined(found[i], found.pop(j))
    return found


def _one_box(found: list[_Aligned]) -> Iterator[tuple[int, int]]:
    """Yield pairs, the lower number first, that a box about both holds without much beside."""
    for j in range(len(found)):
        for i in range(j):
            both = found[i].volume + found[j].volume - _common(found[i], found[j])
            if _joined(found[i], found[j]).volume <= SAME * both:
                yield i, j


def _common(a: _Aligned, b: _Aligned) -> float:
    """Return the volume that two boxes have in common."""
    low = (max(a.low[0], b.low[0]), max(a.low[1], b.low[1]), max(a.low[2], b.low[2]))
    high = (min(a.high[0], b.high[0]), min(a.high[1], b.high[1]), min(a.high[2], b.high[2]))
    return _Aligned((), low, high).volume


def _joined(a: _Aligned, b: _Aligned) -> _Aligned:
    low = (min(a.low[0], b.low[0]), min(a.low[1], b.low[1]), min(a.low[2], b.low[2]))
    high = (max(a.high[0], b.high[0]), max(a.high[1], b.high[1]), max(a.high[2], b.high[2]))
    return _Aligned((*a.blocks, *b.blocks), low, high)


def _body(blocks: tuple[UprightPrism, ...]) -> EnclosingShape:
    """Return the body about prisms."""
    base = _base(tuple(p for block in blocks for p in block.ring))
    low, high = min(block.bottom for block in blocks), max(block.top for block in blocks)
    shape: BodyShape = CylinderShape(base.radius or 0.0, high - low)
    if base.radius is None:
        shape = BoxShape(2.0 * base.half[0], 2.0 * base.half[1], high - low, base.ahead)
    names = {block.name for block in blocks}
    return EnclosingShape((*base.middle, (low + high) / 2), shape, names.pop() if len(names) == 1 else "")
