"""Draws the visible sides of a target, shaded, in a picture's rectangle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.emit.palette import Rgb, shade
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas
from shotc.geom.bernstein import Array
from shotc.geom.shapes import BodyShape, CylinderShape
from shotc.geom.silhouette import project_loop, shape_outline
from shotc.geom.vec import Vec3

LIGHT_RAD = np.radians(215.0)
"""Direction to the light, an angle in W, rad; it is fixed, so that shading shows which side is seen."""

STRIP_COUNT, RIM_POINTS = 24, 64  # strips of a cylinder's side, points of its rim


class Sides(NamedTuple):
    """The vertical sides of a body that face an eye.

    edges : ends of their upper edges on the map, relative to the eye, shape (n, 2, 2)
    outwards : directions of their outward normals, angles in W, shape (n,)
    top : corners of the body's top, relative to the eye, shape (K, 2)
    """

    edges: Array
    outwards: Array
    top: Array


def draw_body(canvas: Canvas, view: PictureRectangle, shape: BodyShape, offset: Vec3, color: Rgb) -> None:
    """Draw a body.

    offset : its centre minus the eye, W, metres
    """
    outline = shape_outline(view.camera, offset, shape)
    if not len(outline):
        return
    canvas.polygons([view.place(outline)], color, clip=view.box)
    sides = sides_seen(shape, offset)
    low, high = offset[2] - shape.height / 2, offset[2] + shape.height / 2
    strips, colors = [], []
    for (a, b), outward in zip(sides.edges, sides.outwards, strict=True):
        polygon = project_loop(view.camera, np.array([[*a, low], [*b, low], [*b, high], [*a, high]]))
        if len(polygon):
            strips.append(view.place(polygon))
            colors.append(shade(color, 1.02 + 0.26 * float(np.cos(outward - LIGHT_RAD))))
    if strips:
        canvas.polygons(strips, colors, colors, 0.4, view.box)
    if high < 0:
        cap = project_loop(view.camera, np.column_stack([sides.top, np.full(len(sides.top), high)]))
        if len(cap):
            canvas.polygons([view.place(cap)], shade(color, 1.4), shade(color, 1.2), 0.5, view.box)
    canvas.polygons([view.place(outline)], "none", shade(color, 0.55), 1.1, view.box)


def sides_seen(shape: BodyShape, offset: Vec3) -> Sides:
    """Return the vertical sides of a body that face the eye.

    offset : its centre minus the eye, W, metres
    """
    return _round(shape, offset) if isinstance(shape, CylinderShape) else _flat(shape.solid(offset).points)


def _round(shape: CylinderShape, offset: Vec3) -> Sides:
    x, y, _ = offset
    distance, radius = float(np.hypot(x, y)), shape.radius

    def rim(turn: Array) -> Array:
        return np.stack([x + radius * np.cos(turn), y + radius * np.sin(turn)], axis=-1)

    top = rim(np.linspace(0, 2 * np.pi, RIM_POINTS + 1)[:-1])
    if distance <= radius:
        return Sides(np.empty((0, 2, 2)), np.empty(0), top)
    half = np.arccos(radius / distance)
    turn = np.arctan2(-y, -x) + half * np.linspace(-1, 1, STRIP_COUNT + 1)
    seen = rim(turn)
    return Sides(np.stack([seen[:-1], seen[1:]], axis=1), (turn[:-1] + turn[1:]) / 2, top)


def _flat(points: tuple[tuple[float, float], ...]) -> Sides:
    corners = np.array(points)
    edges = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    along = edges[:, 1] - edges[:, 0]
    outward = np.stack([along[:, 1], -along[:, 0]], axis=-1)  # the corners run counter-clockwise
    facing = (outward * edges[:, 0]).sum(axis=1) < 0
    return Sides(edges[facing], np.arctan2(outward[facing, 1], outward[facing, 0]), corners)
