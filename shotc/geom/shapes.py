"""The shapes of targets for cameras: upright cylinders, upright boxes, and groups of them. Plain Python.

A shape has no position. It is about its centre, and functions take the offset of the centre from the camera.
They use plain arithmetic only, as ``geom.camera`` does, so radius, height and course may be arrays with one
value for each camera (``S`` is either). Every shape implements ``geom.camera.VisibleShape``.
"""

from functools import reduce
from math import hypot
from typing import Any, NamedTuple, Self

from shotc.geom.camera import Offset, ScreenBox, UnitVector, View
from shotc.geom.solids import Cylinder, Prism
from shotc.geom.vec import Vec2, Vec3

S = Any  # float or NDArray[float64]; arithmetic is the same for both

NORTH = (0.0, 1.0)
TOUCH_M = 1e-6  # metres, tolerance of touching for rounding
_CORNERS = tuple((a, b, c) for a in (-0.5, 0.5) for b in (-0.5, 0.5) for c in (-0.5, 0.5))


class CylinderShape(NamedTuple):
    """An upright cylinder: radius and height, metres."""

    radius: float
    height: float

    @property
    def turns(self) -> bool:
        """Whether its appearance changes with its heading."""
        return False

    def facing(self, _ahead: tuple[S, S]) -> Self:
        """Return the shape with another course, a horizontal unit vector of W."""
        return self

    def reach(self, _camera: View, n: UnitVector) -> S:
        """Return its extent from its centre along a unit vector of C, metres."""
        return self.height / 2 * abs(n.up) + self.radius * abs(1.0 - n.up * n.up) ** 0.5

    def half_width(self, across: tuple[S, S]) -> S:
        """Return its extent along a horizontal unit vector of W, metres."""
        del across
        return self.radius

    def nearest_depth(self, camera: View, offset: Offset) -> S:
        """Return the depth of its point nearest to the image plane, metres."""
        forward = camera.to_camera(offset)[2]
        return forward - self.height / 2 * abs(camera.sin_pitch) - self.radius * abs(camera.cos_pitch)

    def bounds(self, camera: View, offset: Offset) -> ScreenBox:
        """Return the screen box of its outline, the hull of its two rims."""
        low = _rim_bounds(camera, (offset[0], offset[1], offset[2] - self.height / 2), self.radius)
        high = _rim_bounds(camera, (offset[0], offset[1], offset[2] + self.height / 2), self.radius)
        return _union(low, high)

    def gap(self, offset: Vec3) -> float:
        """Return its distance from a point at ``offset`` from its centre, metres, 0 inside."""
        across = max(0.0, hypot(offset[0], offset[1]) - self.radius)
        return hypot(across, max(0.0, abs(offset[2]) - self.height / 2))

    def solid(self, centre: Vec3) -> Cylinder:
        """Return it as a solid at a centre."""
        x, y, z = centre
        return Cylinder((x, y), self.radius, z - self.height / 2, z + self.height / 2)


class BoxShape(NamedTuple):
    """An upright box: its sides along its course, across it and up, metres.

    ahead : its course, a horizontal unit vector (x, y) of W
    """

    length: float
    width: float
    height: float
    ahead: Vec2 = NORTH

    @property
    def turns(self) -> bool:
        """Whether its appearance changes with its heading."""
        return True

    @property
    def radius(self) -> float:
        """The radius of its upright bounding cylinder, metres."""
        return hypot(self.length, self.width) / 2

    def facing(self, ahead: tuple[S, S]) -> Self:
        """Return the shape with another course, a horizontal unit vector of W."""
        return self._replace(ahead=ahead)

    def reach(self, camera: View, n: UnitVector) -> S:
        """Return its extent from its centre along a unit vector of C, metres."""
        c, s = self.ahead
        along, across = (_dot(n, camera.to_camera(axis)) for axis in ((c, s, 0.0), (-s, c, 0.0)))
        return self.length / 2 * abs(along) + self.width / 2 * abs(across) + self.height / 2 * abs(n.up)

    def half_width(self, across: tuple[S, S]) -> S:
        """Return its extent along a horizontal unit vector of W, metres."""
        c, s = self.ahead
        along, lateral = across[0] * c + across[1] * s, across[1] * c - across[0] * s
        return self.length / 2 * abs(along) + self.width / 2 * abs(lateral)

    def nearest_depth(self, camera: View, offset: Offset) -> S:
        """Return the depth of its point nearest to the image plane, metres."""
        forward = camera.to_camera(offset)[2]
        return forward - self.reach(camera, UnitVector(0.0, 0.0, 1.0, camera.sin_pitch))

    def bounds(self, camera: View, offset: Offset) -> ScreenBox:
        """Return the screen box of its outline, the hull of its eight corners."""
        return reduce(_union, [_point_bounds(camera, corner) for corner in self.corners(offset)])

    def wider(self, by: float) -> Self:
        """Return the shape with each vertical side moved outwards by some metres."""
        return self._replace(length=self.length + 2 * by, width=self.width + 2 * by)

    def corners(self, centre: Offset) -> list[Offset]:
        """Return its eight corners about a centre."""
        c, s = self.ahead
        x, y, z = centre
        sides = [(a * self.length, b * self.width, h * self.height) for a, b, h in _CORNERS]
        return [(x + a * c - b * s, y + a * s + b * c, z + h) for a, b, h in sides]

    def gap(self, offset: Vec3) -> float:
        """Return its distance from a point at ``offset`` from its centre, metres, 0 inside."""
        c, s = self.ahead
        along, across = offset[0] * c + offset[1] * s, offset[1] * c - offset[0] * s
        level = hypot(max(0.0, abs(along) - self.length / 2), max(0.0, abs(across) - self.width / 2))
        return hypot(level, max(0.0, abs(offset[2]) - self.height / 2))

    def solid(self, centre: Vec3) -> Prism:
        """Return it as a solid at a centre."""
        c, s = self.ahead
        x, y, z = centre
        level = [(a * self.length / 2, b * self.width / 2) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        points = tuple((x + a * c - b * s, y + a * s + b * c) for a, b in level)
        return Prism(points, z - self.height / 2, z + self.height / 2)


BodyShape = CylinderShape | BoxShape
POINT = CylinderShape(0.0, 0.0)


class Part(NamedTuple):
    """A part of a group: the offset of its centre from the group's, W, metres, and its shape."""

    offset: Vec3
    shape: BodyShape


class GroupShape(NamedTuple):
    """A group of shapes in one picture; its outline is the union of theirs."""

    parts: tuple[Part, ...]

    @property
    def turns(self) -> bool:
        """Whether its appearance changes with its heading: False, because a group does not turn."""
        return False

    @property
    def radius(self) -> float:
        """The radius of its upright bounding cylinder about its centre, metres."""
        return max(hypot(p.offset[0], p.offset[1]) + p.shape.radius for p in self.parts)

    @property
    def height(self) -> float:
        """The height of that cylinder, metres."""
        return max(2.0 * abs(p.offset[2]) + p.shape.height for p in self.parts)

    def facing(self, _ahead: tuple[S, S]) -> Self:
        """Return the shape with another course, a horizontal unit vector of W."""
        return self

    def reach(self, camera: View, n: UnitVector) -> S:
        """Return its extent from its centre along a unit vector of C, metres."""
        reaches = [p.shape.reach(camera, n) + _dot(n, camera.to_camera(p.offset)) for p in self.parts]
        return -reduce(_smaller, [-reach for reach in reaches])

    def half_width(self, across: tuple[S, S]) -> S:
        """Return its extent along a horizontal unit vector of W, or against it, metres."""
        x, y = across
        widths = [p.shape.half_width(across) + abs(p.offset[0] * x + p.offset[1] * y) for p in self.parts]
        return -reduce(_smaller, [-width for width in widths])

    def nearest_depth(self, camera: View, offset: Offset) -> S:
        """Return the depth of its point nearest to the image plane, metres."""
        return reduce(_smaller, [p.shape.nearest_depth(camera, _sum(offset, p.offset)) for p in self.parts])

    def bounds(self, camera: View, offset: Offset) -> ScreenBox:
        """Return the screen box of all outlines."""
        return reduce(_union, [p.shape.bounds(camera, _sum(offset, p.offset)) for p in self.parts])

    def gap(self, offset: Vec3) -> float:
        """Return its distance from a point at ``offset`` from its centre, metres, 0 inside."""
        x, y, z = offset
        return min(p.shape.gap((x - p.offset[0], y - p.offset[1], z - p.offset[2])) for p in self.parts)


TargetShape = CylinderShape | BoxShape | GroupShape


def bodies_of(shape: TargetShape) -> tuple[Part, ...]:
    """Return the bodies of a shape, each with its offset from the centre."""
    return shape.parts if isinstance(shape, GroupShape) else (Part((0.0, 0.0, 0.0), shape),)


def touch(a: BodyShape, b: BodyShape, offset: tuple[S, S, S]) -> S:
    """Return whether two upright shapes overlap or touch, so that they are parts of one thing.

    offset : from the centre of b to that of a, metres
    """
    x, y, z = offset
    return _level_touch(a, b, (x, y)) & (abs(z) <= 0.5 * (a.height + b.height) + TOUCH_M)


def _level_touch(a: BodyShape, b: BodyShape, offset: tuple[S, S]) -> S:
    """Return whether two shapes overlap or touch in the plan."""
    x, y = offset
    if isinstance(a, CylinderShape):
        if isinstance(b, CylinderShape):
            return x * x + y * y <= (a.radius + b.radius + TOUCH_M) ** 2
        return _level_touch(b, a, (-x, -y))
    c, s = a.ahead
    if isinstance(b, CylinderShape):
        along = _positive(abs(x * c + y * s) - a.length / 2)
        lateral = _positive(abs(y * c - x * s) - a.width / 2)
        return along * along + lateral * lateral <= (b.radius + TOUCH_M) ** 2
    # Two rectangles meet unless an axis along a side separates them.
    meets: S = True
    for p, q in (a.ahead, b.ahead):
        for axis in ((p, q), (-q, p)):
            apart = abs(x * axis[0] + y * axis[1])
            meets = meets & (apart <= a.half_width(axis) + b.half_width(axis) + TOUCH_M)
    return meets


def _positive(a: S) -> S:
    return 0.5 * (a + abs(a))


def _sum(a: Offset, b: Vec3) -> Offset:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _dot(n: UnitVector, axis: tuple[S, S, S]) -> S:
    return n.right * axis[0] + n.down * axis[1] + n.forward * axis[2]


def _point_bounds(camera: View, offset: Offset) -> ScreenBox:
    u, v, _ = camera.project(offset)
    return ScreenBox(u, u, v, v)


def _union(a: ScreenBox, b: ScreenBox) -> ScreenBox:
    return ScreenBox(
        _smaller(a.u_min, b.u_min),
        -_smaller(-a.u_max, -b.u_max),
        _smaller(a.v_min, b.v_min),
        -_smaller(-a.v_max, -b.v_max),
    )


def _rim_bounds(camera: View, centre: Offset, radius: S) -> ScreenBox:
    # Rim in C: (x + r sin, y + r sin(pitch) cos, z + r cos(pitch) cos). The extremes m of x/z and
    # y/z satisfy (x - m z)^2 = sum of squares of the harmonic terms, a quadratic in m.
    x, y, z = camera.to_camera(centre)
    lean_y, lean_z = radius * camera.sin_pitch, radius * camera.cos_pitch
    a = z * z - lean_z * lean_z
    b = x * z
    root = abs(b * b - a * (x * x - radius * radius)) ** 0.5
    c = y * z - lean_y * lean_z
    fall = abs(c * c - a * (y * y - lean_y * lean_y)) ** 0.5
    width, tall = a * camera.half_width, a * camera.half_height
    return ScreenBox((b - root) / width, (b + root) / width, -(c + fall) / tall, -(c - fall) / tall)


def _smaller(a: S, b: S) -> S:
    return 0.5 * (a + b - abs(a - b))
