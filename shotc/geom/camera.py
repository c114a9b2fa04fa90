"""The pinhole camera, and the margins of shapes (``geom.shapes``) in its frame.

Frames: W is East, North, Up; C is x right, y down, z forward; roll is zero. Yaw is counter-clockwise
from East, pitch is positive up. Screen (u, v) lies in [-1, 1]^2, u right, v up. The functions use
plain arithmetic only, so they take floats and numpy arrays alike (``S`` below is either).
"""

from math import atan2, cos, hypot, pi, sin, sqrt, tan
from typing import Any, NamedTuple, Protocol

from shotc.geom.vec import Vec2, Vec3, direction

ROUNDING_M = 1e-6
"""Tolerance at the frame's edge for rounding, metres: a target may touch the edge."""

S = Any  # float or NDArray[float64]; arithmetic is the same for both
Offset = tuple[S, S, S]


class OnScreen(NamedTuple):
    """A place on screen, and its depth, metres; it is visible only if depth > 0."""

    u: S
    v: S
    depth: S


class View(NamedTuple):
    """Direction cosines of a camera, and half its screen: tan of half the fields of view."""

    cos_yaw: S
    sin_yaw: S
    cos_pitch: S
    sin_pitch: S
    half_width: S
    half_height: S

    def to_camera(self, d: tuple[S, S, S]) -> tuple[S, S, S]:
        """Return a vector of W in C: components right, down, forward."""
        along = self.cos_yaw * d[0] + self.sin_yaw * d[1]
        right = self.sin_yaw * d[0] - self.cos_yaw * d[1]
        forward = self.cos_pitch * along + self.sin_pitch * d[2]
        down = self.sin_pitch * along - self.cos_pitch * d[2]
        return right, down, forward

    def project(self, d: tuple[S, S, S]) -> OnScreen:
        """Project an offset from the camera (W, metres) to (u, v, depth); visible only if depth > 0."""
        right, down, forward = self.to_camera(d)
        return OnScreen(right / (forward * self.half_width), -down / (forward * self.half_height), forward)


def view(yaw: float, pitch: float, hfov: float, aspect: float) -> View:
    """Return the view of one camera pose; angles in rad, aspect = width / height."""
    half = tan(hfov / 2)
    return View(cos(yaw), sin(yaw), cos(pitch), sin(pitch), half, half / aspect)


class UnitVector(NamedTuple):
    """A direction in C, and its component along W's up."""

    right: S
    down: S
    forward: S
    up: S


class ScreenBox(NamedTuple):
    """A box on the screen, half frames."""

    u_min: S
    u_max: S
    v_min: S
    v_max: S


class Reaching(Protocol):
    """A body that extends about its centre."""

    def reach(self, camera: View, n: UnitVector, /) -> S:
        """Return its extent from its centre along a unit vector, metres."""


class VisibleShape(Reaching, Protocol):
    """The shape of a target about its centre, as a camera needs it (``geom.shapes``)."""

    @property
    def height(self) -> float:
        """Its height, metres."""

    def half_width(self, across: tuple[S, S], /) -> S:
        """Return its extent along a horizontal unit vector of W, metres."""

    def nearest_depth(self, camera: View, offset: Offset, /) -> S:
        """Return the depth of its point nearest to the image plane, metres; offset : of its centre, W."""

    def bounds(self, camera: View, offset: Offset, /) -> ScreenBox:
        """Return the exact screen box of its outline; offset : of its centre, W."""


class FrustumMargins(NamedTuple):
    """Distances inside each plane of the frustum, metres; negative is cropped."""

    left: S
    right: S
    bottom: S
    top: S


def frustum_margins(camera: View, offset: Offset, shape: Reaching | None = None) -> FrustumMargins:
    """Return the distance of a whole shape inside each frustum plane, metres; of a point without a shape.

    offset : its centre minus the camera, W, metres. Negative is cropped.
    The value is exact: a body lies inside a plane with inward unit normal n through the camera iff n.p is at
    least its extent from its centre p along -n. For an upright cylinder this extent is
    h/2 |n.up| + r sqrt(1 - (n.up)^2).
    """
    right, down, forward = camera.to_camera(offset)
    across = 1.0 / (1.0 + camera.half_width**2) ** 0.5
    along = 1.0 / (1.0 + camera.half_height**2) ** 0.5
    margins = (
        across * (camera.half_width * forward + right),
        across * (camera.half_width * forward - right),
        along * (camera.half_height * forward - down),
        along * (camera.half_height * forward + down),
    )
    if shape is None:
        return FrustumMargins(*margins)
    # World up in C is (0, -cos pitch, sin pitch).
    side, level = camera.half_width * across, camera.half_height * along
    up_side = side * camera.sin_pitch
    up_bottom = along * (camera.half_height * camera.sin_pitch + camera.cos_pitch)
    up_top = along * (camera.half_height * camera.sin_pitch - camera.cos_pitch)
    outwards = (
        UnitVector(-across, 0.0, -side, -up_side),
        UnitVector(across, 0.0, -side, -up_side),
        UnitVector(0.0, along, -level, -up_bottom),
        UnitVector(0.0, -along, -level, -up_top),
    )
    return FrustumMargins(*(m - shape.reach(camera, n) for m, n in zip(margins, outwards, strict=True)))


def point_margins(camera: View, offset: Offset, shape: VisibleShape) -> FrustumMargins:
    """Return the least distance of four points of a target inside each frustum plane, metres.

    Arguments as in ``frustum_margins``. The points are those of Gebhardt and Hilliges, Eq. 4-7: the axis at
    top and bottom, and the half width to either side at half height, perpendicular to the line of sight.
    World up replaces the camera's up, which is correct at any pitch. The points lie within the outline of a
    cylinder, so all of them may be in a frame that crops the target.
    """
    x, y, z = offset
    level = (x * x + y * y + 1e-18) ** 0.5
    radius, height = shape.half_width((-y / level, x / level)), shape.height
    sideways = (-y / level * radius, x / level * radius)
    points = (
        (x, y, z + height / 2),
        (x, y, z - height / 2),
        (x + sideways[0], y + sideways[1], z),
        (x - sideways[0], y - sideways[1], z),
    )
    a, b, c, d = (frustum_margins(camera, point) for point in points)

    def least(plane: int) -> S:
        return _smaller(_smaller(a[plane], b[plane]), _smaller(c[plane], d[plane]))

    return FrustumMargins(least(0), least(1), least(2), least(3))


def _smaller(a: S, b: S) -> S:
    return 0.5 * (a + b - abs(a - b))


def aim_at(offset: Vec3, uv: Vec2, hfov: float, aspect: float, yaw_if_vertical: float = 0.0) -> Vec2 | None:
    """Return the (yaw, pitch), rad, that shows the point ``offset`` from the camera at screen place ``uv``.

    None if no camera without roll does so (the point is too steeply above or below for that u). Of the two
    solutions for the pitch, the one with the smaller magnitude is returned.
    """
    half = tan(hfov / 2)
    ray = (uv[0] * half, uv[1] * half / aspect, 1.0)  # right, up, forward
    norm = sqrt(ray[0] ** 2 + ray[1] ** 2 + 1.0)
    right, up, forward = (c / norm for c in ray)
    length = hypot(*offset)
    if length == 0:
        return None
    # Up component of the ray after pitching: up cos(p) + forward sin(p) = offset_z / length.
    reach = hypot(up, forward)
    sine = offset[2] / length
    if abs(sine) > reach:
        return None
    lean = atan2(up, forward)
    rise = atan2(sine, sqrt(max(0.0, reach**2 - sine**2)))
    pitch = min((rise - lean, pi - rise - lean), key=lambda p: abs(direction(p)))
    pitch = direction(pitch)
    along = forward * cos(pitch) - up * sin(pitch)
    horizontal = hypot(offset[0], offset[1])
    if horizontal < 1e-9 * length:
        return (yaw_if_vertical, pitch)
    return (direction(atan2(offset[1], offset[0]) + atan2(right, along)), pitch)


def heading_of(yaw: float) -> float:
    """Return the compass heading in [0, 2 pi) of a yaw that is counter-clockwise from East."""
    return (pi / 2 - yaw) % (2 * pi)


def yaw_of(heading: float) -> float:
    """Return the yaw in (-pi, pi] of a compass heading."""
    return direction(pi / 2 - heading)
