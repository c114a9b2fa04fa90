"""Outlines of solids on a camera's screen: for prisms the hull of their corners, else in closed form.

The contour of the solid from the camera's position is built in W and clipped at a near plane before it is
projected. So a solid that extends behind the camera is drawn correctly too. Screen coordinates are those of
``geom.camera``.
"""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from shotc.geom.camera import View
from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape
from shotc.geom.solids import Cylinder, Prism, Solid, convex_hull, convex_parts
from shotc.geom.vec import Vec2, Vec3

Array = NDArray[np.float64]

NEAR_PLANE_M = 0.01
"""Depth of the near plane, metres; it is small compared with any clearance, so the cut is never on screen."""


def cylinder_contour(offset: Array, radius: float, height: float, count: int = 48) -> Array:
    """Return the closed contour of an upright cylinder seen from a point, as offsets from that point.

    offset : shape (..., 3), centre of the cylinder minus the eye, W, metres
    count  : points on each of the two rims
    The result has shape (..., 2 count, 3), all NaN if the eye is inside the cylinder.

    From outside the radius r an eye at distance d sees two generators, at azimuths +-acos(r / d) from the
    direction to the eye. One arc of each rim connects them: the far arc if the eye is beyond that rim's
    plane, else the near one. From inside the radius the contour is one whole rim.
    """
    x, y, z = offset[..., 0], offset[..., 1], offset[..., 2]
    distance = np.hypot(x, y)
    outside = distance > radius
    ratio = radius / np.where(outside, distance, max(radius, 1.0))
    half = np.where(outside, np.arccos(np.clip(ratio, -1.0, 1.0)), 0.0)[..., None]
    facing = np.arctan2(-y, -x)[..., None]
    above, below = z + height / 2 < 0, z - height / 2 > 0
    sweep = np.linspace(-1.0, 1.0, count)
    near = facing + half * sweep
    far = facing + np.pi + (np.pi - half) * -sweep
    top = np.where(above[..., None], far, near)
    bottom = np.where(below[..., None], far, near)[..., ::-1]
    top_z, bottom_z = z + height / 2, z - height / 2
    # Above the disc only the rim that faces the eye is contour: move the other one onto it.
    top_z, bottom_z = (
        np.where(~outside & below, bottom_z, top_z),
        np.where(~outside & above, top_z, bottom_z),
    )
    angles = np.concatenate([top, bottom], axis=-1)
    heights = np.concatenate(
        [np.repeat(top_z[..., None], count, axis=-1), np.repeat(bottom_z[..., None], count, axis=-1)], axis=-1
    )
    loop = np.stack(
        [x[..., None] + radius * np.cos(angles), y[..., None] + radius * np.sin(angles), heights], axis=-1
    )
    inside = ~outside & ~above & ~below
    return np.asarray(np.where(inside[..., None, None], np.nan, loop))


def box_contour(offset: Array, box: BoxShape) -> Array:
    """Return the closed contour of an upright box seen from a point, as offsets from that point.

    offset : shape (..., 3), centre of the box minus the eye, W, metres; its course may be an array
    The result has shape (..., 6, 3), all NaN if the eye is inside the box. A contour of four corners repeats
    the last one three times.

    An edge is contour if one of its sides faces the eye and the other does not. For each pair of opposite
    sides the eye is beyond one, beyond the other, or between them.
    """
    half = np.array([box.length, box.width, box.height]) / 2
    c, s = np.broadcast_arrays(np.asarray(box.ahead[0]), np.asarray(box.ahead[1]))
    along, across = offset[..., 0] * c + offset[..., 1] * s, offset[..., 1] * c - offset[..., 0] * s
    eye = -np.stack([along, across, offset[..., 2]], axis=-1)
    beyond = (eye > half).astype(np.intp) - (eye < -half)
    which = (beyond + 1) @ np.array([9, 3, 1])
    corners = half * _CONTOURS[which]
    turned = np.stack(
        [
            corners[..., 0] * c[..., None] - corners[..., 1] * s[..., None],
            corners[..., 0] * s[..., None] + corners[..., 1] * c[..., None],
            corners[..., 2],
        ],
        axis=-1,
    )
    return np.asarray(offset[..., None, :] + turned)


def _contour_of(beyond: tuple[int, int, int]) -> list[tuple[int, ...]]:
    """Return the corners (+-1, +-1, +-1) of a cube along its contour.

    beyond : the sides that face the eye, at least one
    """
    corners = list(product((-1, 1), repeat=3))

    def faces(axis: int, side: int) -> bool:
        return beyond[axis] == side

    def neighbours(a: tuple[int, ...]) -> list[tuple[int, ...]]:
        adjacent = []
        for axis in range(3):
            b = tuple(-x if i == axis else x for i, x in enumerate(a))
            first, second = (i for i in range(3) if i != axis)
            if faces(first, a[first]) != faces(second, a[second]):
                adjacent.append(b)
        return adjacent

    first = next(corner for corner in corners if neighbours(corner))
    loop = [first]
    while True:
        left = [b for b in neighbours(loop[-1]) if b not in loop]
        if not left:
            return loop
        loop.append(left[0])


def _contours() -> Array:
    table = np.full((27, 6, 3), np.nan)  # without a contour where the eye is inside
    for row, beyond in zip(table, product((-1, 0, 1), repeat=3), strict=True):
        if any(beyond):
            loop = _contour_of((beyond[0], beyond[1], beyond[2]))
            row[:] = [*loop, *[loop[-1]] * (6 - len(loop))]
    return table


_CONTOURS = _contours()


def shape_contour(offset: Array, shape: BodyShape, count: int = 48) -> Array:
    """Return the closed contour of a body seen from a point, shape (..., K, 3), as offsets from that point.

    offset : shape (..., 3), its centre minus the eye, W, metres; count : points of each rim of a cylinder
    """
    if isinstance(shape, BoxShape):
        return box_contour(offset, shape)
    return cylinder_contour(offset, shape.radius, shape.height, count)


def project_loop(camera: View, loop: Array) -> Array:
    """Return the screen polygon of one closed contour.

    loop : shape (M, 3), offsets from the camera, W; result shape (K, 2) in (u, v). K = 0 if the contour is
    behind the camera or not defined.
    """
    right, down, forward = camera.to_camera((loop[:, 0], loop[:, 1], loop[:, 2]))
    seen = _clip_near(np.stack([right, down, forward], axis=-1))
    return _to_screen(camera, seen)


def project_loops(camera: View, loops: Array) -> list[Array]:
    """Return the screen polygons of one contour seen by many cameras, each of shape (K, 2).

    camera : its fields have shape (T,); loops : shape (T, M, 3), offsets from each camera, W
    """
    each = View(*(np.asarray(part)[:, None] for part in camera))
    points = np.stack(each.to_camera((loops[..., 0], loops[..., 1], loops[..., 2])), axis=-1)
    half = np.stack([camera.half_width, camera.half_height], axis=-1)
    return [_scaled(_clip_near(loop), *pair) for loop, pair in zip(points, half, strict=True)]


def shape_outline(camera: View, offset: Vec3, shape: BodyShape, count: int = 48) -> Array:
    """Return the screen polygon of a body, shape (K, 2); offset : its centre minus the camera, W, metres."""
    return project_loop(camera, shape_contour(np.asarray(offset, dtype=np.float64), shape, count))


def solid_outlines(camera: View, eye: Vec3, solid: Solid) -> list[Array]:
    """Return one convex screen polygon, shape (K, 2), for each convex part of a solid that is in view."""
    outlines = [
        shape_outline(camera, *_seen_from(eye, part))
        if isinstance(part, Cylinder)
        else _prism_outline(camera, eye, part)
        for part in convex_parts(solid)
    ]
    return [outline for outline in outlines if len(outline)]


def solid_edges(camera: View, eye: Vec3, solid: Solid) -> list[Array]:
    """Return the visible and hidden edges of a solid as screen polylines, each of shape (K, 2).

    Prisms give every edge; cylinders their two rims.
    """
    strips: list[Array] = []
    for ring in (edge - np.asarray(eye) for edge in edge_strips(solid)):
        right, down, forward = camera.to_camera((ring[:, 0], ring[:, 1], ring[:, 2]))
        points = np.stack([right, down, forward], axis=-1)
        strips.extend(_to_screen(camera, run) for run in _clip_strip(points))
    return strips


def edge_strips(solid: Solid, count: int = 48) -> list[Array]:
    """Return the edges of a solid in W as polylines of shape (K, 3), metres."""
    if isinstance(solid, Cylinder):
        angles = np.linspace(0.0, 2 * np.pi, count + 1)
        x = solid.centre[0] + solid.radius * np.cos(angles)
        y = solid.centre[1] + solid.radius * np.sin(angles)
        footprint = np.stack([x, y], axis=-1)
        uprights: list[Array] = []
    else:
        footprint = np.array([*solid.points, solid.points[0]], dtype=np.float64)
        uprights = [np.array([[*p, solid.bottom], [*p, solid.top]]) for p in solid.points]
    rings = [np.column_stack([footprint, np.full(len(footprint), z)]) for z in (solid.bottom, solid.top)]
    return rings + uprights


def _seen_from(eye: Vec3, solid: Cylinder) -> tuple[Vec3, CylinderShape]:
    middle = (solid.bottom + solid.top) / 2
    offset = (solid.centre[0] - eye[0], solid.centre[1] - eye[1], middle - eye[2])
    return offset, CylinderShape(solid.radius, solid.top - solid.bottom)


def _prism_outline(camera: View, eye: Vec3, prism: Prism) -> Array:
    # The part in front of the near plane is convex. Its corners are the prism's corners in front, and the
    # points where edges cross the plane. Their hull on screen is the outline.
    corners: list[Array] = []
    for strip in edge_strips(prism):
        ring = strip - np.asarray(eye)
        right, down, forward = camera.to_camera((ring[:, 0], ring[:, 1], ring[:, 2]))
        corners.extend(_clip_strip(np.stack([right, down, forward], axis=-1)))
    if not corners:
        return np.empty((0, 2))
    screen = _to_screen(camera, np.concatenate(corners))
    points: tuple[Vec2, ...] = tuple((float(u), float(v)) for u, v in screen)
    hull = convex_hull(points)
    return np.array(hull) if len(hull) > 2 else np.empty((0, 2))


def _to_screen(camera: View, points: Array) -> Array:
    return _scaled(points, camera.half_width, camera.half_height)


def _scaled(points: Array, half_width: float, half_height: float) -> Array:
    u = points[:, 0] / (points[:, 2] * half_width)
    v = -points[:, 1] / (points[:, 2] * half_height)
    return np.stack([u, v], axis=-1)


def _clip_near(loop: Array) -> Array:
    # Sutherland-Hodgman against one plane, in the camera frame.
    if np.isnan(loop).any():
        return np.empty((0, 3))
    inside = loop[:, 2] >= NEAR_PLANE_M
    if inside.all():
        return loop
    corners: list[Array] = []
    for i, p in enumerate(loop):
        before = loop[i - 1]
        if inside[i] != inside[i - 1]:
            corners.append(_crossing(before, p))
        if inside[i]:
            corners.append(p)
    return np.array(corners) if corners else np.empty((0, 3))


def _clip_strip(strip: Array) -> list[Array]:
    inside = strip[:, 2] >= NEAR_PLANE_M
    if inside.all():
        return [strip]
    runs: list[list[Array]] = []
    fresh = True
    for (a, a_in), (b, b_in) in pairwise(zip(strip, inside, strict=True)):
        if not (a_in or b_in):
            fresh = True
            continue
        if fresh or not a_in:
            runs.append([a if a_in else _crossing(a, b)])
        runs[-1].append(b if b_in else _crossing(a, b))
        fresh = not b_in
    return [np.array(run) for run in runs]


def _crossing(a: Array, b: Array) -> Array:
    share = (NEAR_PLANE_M - a[2]) / (b[2] - a[2])
    point: Array = a + share * (b - a)
    point[2] = NEAR_PLANE_M
    return point
