"""The outline of upright cylinders and boxes in a picture, in CasADi symbols: smooth and almost exact.

``shotc.geom.shapes`` is exact but has kinks: where the camera is as high as the cylinder's top or foot, where
it looks horizontally, and where the other rim becomes the edge of the outline. These are usual cameras for
people. Here lengths and minima are rounded off by amounts that nobody sees.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from itertools import product
from typing import Any, NamedTuple

import casadi as ca

from shotc.plugin_api.refiner import View
from shotc_casadi.extents import TINY_M2, Extent

DEEP_SHARE = 0.01  # of its distance: the least depth of a subject before the camera
LEVEL_SHARE = 0.003  # of its distance: a rim closer to the camera's height is rounded off
UPRIGHT_SINE = 0.01  # of a sine or cosine of the pitch: smaller ones are rounded off
EVEN_HALF_FRAMES = 0.001  # half frames: two rims closer on screen are rounded off


class SubjectOutline(NamedTuple):
    """A subject on screen, half frames: its centre (u, v), and the bounding box of its outline."""

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


def outline(camera: View, offset: Any, far: Any, solid: tuple[Any, Any]) -> SubjectOutline:
    """Return the outline of a cylinder.

    A cylinder that is not completely in front of the camera is moved along the camera's axis until it is.

    offset : its centre minus the camera, W, metres
    far : the length of ``offset``, not zero
    solid : radius and height, metres
    """
    radius, height = solid
    reach = height / 2 * length(camera.sin_pitch, UPRIGHT_SINE) + radius * length(
        camera.cos_pitch, UPRIGHT_SINE
    )
    centre = _before(camera, offset, far, reach)
    u, v, _ = camera.project((centre[0], centre[1], centre[2]))
    box = _cylinder(camera, centre, far, solid)
    return SubjectOutline(ca.vertcat(u, v), *box)


def outline_of(camera: View, offset: Any, far: Any, bodies: Sequence[Extent]) -> SubjectOutline:
    """Return the outline of several bodies as one.

    offset : of their common centre; other arguments as in ``outline``
    """
    reaches = [_towards(camera, body) - ca.dot(_axis(camera), body.offset) for body in bodies]
    reach = -reduce(partial(lesser, apart=DEEP_SHARE * far), [-reach for reach in reaches])
    centre = _before(camera, offset, far, reach)
    u, v, _ = camera.project((centre[0], centre[1], centre[2]))
    boxes = [box for body in bodies for box in _boxes(camera, centre + body.offset, far, body)]
    return SubjectOutline(ca.vertcat(u, v), *_union(boxes))


def _boxes(camera: View, centre: Any, far: Any, body: Extent) -> list[_Edges]:
    """Return the screen boxes of a body: of its cylinder and of its corners; one of them has no width."""
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
    """Return the bounding box of boxes; it combines them in pairs."""
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
    """Return |x|, rounded off where it is not much larger than ``least``."""
    return ca.sqrt(x**2 + least**2)


def lesser(a: Any, b: Any, apart: Any) -> Any:
    """Return the minimum of two, or up to ``apart / 2`` less where they are almost equal."""
    return 0.5 * (a + b - length(a - b, apart))


def _axis(camera: View) -> Any:
    return ca.vertcat(camera.cos_pitch * camera.cos_yaw, camera.cos_pitch * camera.sin_yaw, camera.sin_pitch)


def _towards(camera: View, body: Extent) -> Any:
    """Return how far a body reaches from its centre towards the camera's image plane, metres."""
    reach = body.height / 2 * length(camera.sin_pitch, UPRIGHT_SINE)
    reach += body.radius * length(camera.cos_pitch, UPRIGHT_SINE)
    for side in (body.along, body.across):
        part = camera.cos_pitch * (camera.cos_yaw * side[0] + camera.sin_yaw * side[1])
        reach += ca.sqrt(part**2 + UPRIGHT_SINE**2 * ca.sumsqr(side) + TINY_M2)
    return reach


def _before(camera: View, offset: Any, far: Any, reach: Any) -> Any:
    """Return an offset moved along the camera's axis until the subject is in front; else almost unchanged.

    reach : how far the subject reaches from its centre towards the camera's image plane, metres
    """
    axis = _axis(camera)
    depth = ca.dot(axis, offset) - reach
    return offset + 0.5 * (length(depth, DEEP_SHARE * far) - depth) * axis


def _rim(camera: View, centre: Any, radius: Any, far: Any) -> _Edges:
    """Return the screen box of a horizontal circle that is completely in front of the camera.

    Its points in C are (x + r sin t, y + r sin(pitch) cos t, z + r cos(pitch) cos t). y / z has its extrema
    where cos t is 1 or -1; their distance is proportional to the distance of the rim from the camera's
    height. x / z has its extrema where (x - m z)^2 is r^2 (1 + m^2 cos(pitch)^2), a quadratic equation in m.
    """
    x, y, z = camera.to_camera((centre[0], centre[1], centre[2]))
    lean_y, lean_z = radius * camera.sin_pitch, radius * camera.cos_pitch
    square = z**2 - lean_z**2
    lateral = radius * ca.sqrt(square + (camera.cos_pitch * x) ** 2)
    fall = radius * length(centre[2], LEVEL_SHARE * far)
    down = y * z - lean_y * lean_z
    wide, tall = square * camera.half_width, square * camera.half_height
    return _Edges(
        (x * z - lateral) / wide, (x * z + lateral) / wide, -(down + fall) / tall, -(down - fall) / tall
    )
