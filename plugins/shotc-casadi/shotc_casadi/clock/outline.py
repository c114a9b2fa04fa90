"""The outline of upright cylinders and boxes in a picture, in CasADi symbols: smooth, and next to exact.

``shotc.geom.shapes`` is exact, and has kinks: where the camera is as high as the cylinder's
top or foot, where it looks level, and where one rim takes the other's place at an edge of the outline. Those
are where people are filmed from. Here lengths and lesser values are rounded off by as little as nobody sees.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from itertools import product
from typing import Any, NamedTuple

import casadi as ca

from shotc.plugin_api.refiner import View
from shotc_casadi.extents import TINY_M2, Extent

DEEP_SHARE = 0.01  # of its distance, by which a subject counts as before the camera at least
LEVEL_SHARE = 0.003  # of its distance: a rim that is less above or below the camera is rounded off
UPRIGHT = 0.01  # of a sine or cosine of the pitch, the same
EVEN_HALF_FRAMES = 0.001  # half frames: two rims that are less apart on screen are, too


class Outline(NamedTuple):
    """Where a subject is on screen, half frames: its centre (u, v), and the box about its outline."""

    place: Any
    left: Any
    right: Any
    low: Any
    high: Any


class _Edges(NamedTuple):
    left: Any
    right: Any
    low: Any
    high: Any


def outline(camera: View, away: Any, far: Any, solid: tuple[Any, Any]) -> Outline:
    """Return the outline of a cylinder.

    away : its centre less the camera, W, metres; far : the length of that, not zero
    solid : radius and height. A cylinder that is not all before the camera is moved along the camera's axis
    until it is.
    """
    radius, height = solid
    reach = height / 2 * length(camera.sin_pitch, UPRIGHT) + radius * length(camera.cos_pitch, UPRIGHT)
    centre = _before(camera, away, far, reach)
    u, v, _ = camera.project((centre[0], centre[1], centre[2]))
    box = _cylinder(camera, centre, far, solid)
    return Outline(ca.vertcat(u, v), *box)


def outline_of(camera: View, away: Any, far: Any, bodies: Sequence[Extent]) -> Outline:
    """Return the outline of several bodies as one; away : of their common centre, else as in ``outline``."""
    reaches = [_towards(camera, body) - ca.dot(_axis(camera), body.offset) for body in bodies]
    reach = -reduce(partial(lesser, apart=DEEP_SHARE * far), [-reach for reach in reaches])
    centre = _before(camera, away, far, reach)
    u, v, _ = camera.project((centre[0], centre[1], centre[2]))
    boxes = [box for body in bodies for box in _boxes(camera, centre + body.offset, far, body)]
    return Outline(ca.vertcat(u, v), *_union(boxes))


def _boxes(camera: View, centre: Any, far: Any, body: Extent) -> list[_Edges]:
    """Return what a body takes of the screen: a cylinder and a box's corners, one of them without width."""
    corners = []
    for a, b, c in product((-1, 1), repeat=3):
        level = centre[:2] + a * body.along + b * body.across
        u, v, _ = camera.project((level[0], level[1], centre[2] + c * body.height / 2))
        corners.append(_Edges(u, u, v, v))
    return [_cylinder(camera, centre, far, (body.radius, body.height)), _union(corners)]


def _cylinder(camera: View, centre: Any, far: Any, solid: tuple[Any, Any]) -> _Edges:
    radius, height = solid
    ends = [
        _rim(camera, ca.vertcat(centre[:2], centre[2] + end * height / 2), radius, far) for end in (-1, 1)
    ]
    return _union(ends)


def _union(boxes: Sequence[_Edges]) -> _Edges:
    """Return the box about boxes, two and two."""
    if len(boxes) == 1:
        return boxes[0]
    half = (len(boxes) + 1) // 2
    a, b = _union(boxes[:half]), _union(boxes[half:])
    return _Edges(
        lesser(a.left, b.left, EVEN_HALF_FRAMES),
        -lesser(-a.right, -b.right, EVEN_HALF_FRAMES),
        lesser(a.low, b.low, EVEN_HALF_FRAMES),
        -lesser(-a.high, -b.high, EVEN_HALF_FRAMES),
    )


def length(x: Any, least: Any) -> Any:
    """Return |x|, rounded off where it is not well above ``least``."""
    return ca.sqrt(x**2 + least**2)


def lesser(a: Any, b: Any, apart: Any) -> Any:
    """Return the lesser of two, or up to ``apart / 2`` less where they are nearly the same."""
    return 0.5 * (a + b - length(a - b, apart))


def _axis(camera: View) -> Any:
    return ca.vertcat(camera.cos_pitch * camera.cos_yaw, camera.cos_pitch * camera.sin_yaw, camera.sin_pitch)


def _towards(camera: View, body: Extent) -> Any:
    """Return how far a body reaches from its centre towards the camera's image plane, metres."""
    reach = body.height / 2 * length(camera.sin_pitch, UPRIGHT)
    reach += body.radius * length(camera.cos_pitch, UPRIGHT)
    for side in (body.along, body.across):
        part = camera.cos_pitch * (camera.cos_yaw * side[0] + camera.sin_yaw * side[1])
        reach += ca.sqrt(part**2 + UPRIGHT**2 * ca.sumsqr(side) + TINY_M2)
    return reach


def _before(camera: View, away: Any, far: Any, reach: Any) -> Any:
    """Return an offset moved along the camera's axis until all of a subject is before it, hardly else.

    reach : how far the subject comes from there towards the camera's image plane, metres
    """
    axis = _axis(camera)
    depth = ca.dot(axis, away) - reach
    return away + 0.5 * (length(depth, DEEP_SHARE * far) - depth) * axis


def _rim(camera: View, centre: Any, radius: Any, far: Any) -> _Edges:
    """Return the screen box of a level circle, all of it before the camera.

    Its points in C are (x + r sin t, y + r sin(pitch) cos t, z + r cos(pitch) cos t). y / z has its extremes
    where cos t is 1 or -1; the distance of the two is that of the rim from the camera's height. x / z
    has them where (x - m z)^2 is r^2 (1 + m^2 cos(pitch)^2), a quadratic in m.
    """
    x, y, z = camera.to_camera((centre[0], centre[1], centre[2]))
    lean_y, lean_z = radius * camera.sin_pitch, radius * camera.cos_pitch
    square = z**2 - lean_z**2
    aside = radius * ca.sqrt(square + (camera.cos_pitch * x) ** 2)
    fall = radius * length(centre[2], LEVEL_SHARE * far)
    down = y * z - lean_y * lean_z
    wide, tall = square * camera.half_width, square * camera.half_height
    return _Edges(
        (x * z - aside) / wide, (x * z + aside) / wide, -(down + fall) / tall, -(down - fall) / tall
    )
