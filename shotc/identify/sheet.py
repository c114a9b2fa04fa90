"""The sheet of pictures: each keyframe's view with its box and the found cylinders."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil
from typing import NamedTuple

import numpy as np

from shotc.emit.palette import CAMERA, INK, KEEP_OUT, QUIET, SUBJECT, WHITE, Rgb
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, chip, house_style
from shotc.geom.bernstein import Array
from shotc.geom.camera import ScreenBox
from shotc.geom.shapes import CylinderShape
from shotc.geom.silhouette import shape_outline, solid_edges
from shotc.geom.solids import Cylinder
from shotc.identify.cylinders import Upright
from shotc.identify.tasks import DOUBTFUL_SHARE, SearchTask

DPI = 120.0
WIDTH_IN, MARGIN_IN, GAP_IN, COLUMNS = 14.0, 0.5, 0.3, 3
HEADING_IN, CAPTION_IN, LINE_IN, FOOTING_IN = 1.0, 0.5, 0.24, 0.35
CELL_IN = (WIDTH_IN - 2 * MARGIN_IN - (COLUMNS - 1) * GAP_IN) / COLUMNS


class SheetRow(NamedTuple):
    """A target on the sheet.

    shares : its share of the box's content, by number of keyframe
    """

    name: str
    cylinder: Upright
    shares: Mapping[int, float]


def draw_sheet(
    title: str, tasks: Sequence[SearchTask], pictures: Sequence[Array], rows: Sequence[SheetRow]
) -> bytes:
    """Return the sheet as PNG bytes.

    pictures : of each task, shape (rows, columns, 3), 0 to 1
    """
    with house_style():
        return _sheet(title, tasks, pictures, rows)


def _sheet(
    title: str, tasks: Sequence[SearchTask], pictures: Sequence[Array], rows: Sequence[SheetRow]
) -> bytes:
    tallest = max(CELL_IN / task.camera.aspect for task in tasks)
    lines = ceil(len(tasks) / COLUMNS)
    height = HEADING_IN + lines * (tallest + CAPTION_IN) + len(rows) * LINE_IN + FOOTING_IN
    canvas = Canvas(WIDTH_IN, height, DPI)
    canvas.write(MARGIN_IN, height - 0.5, title, Type(22, INK, bold=True), WIDTH_IN - 2 * MARGIN_IN)
    about = "targets that keyframes mean: the box of each (dashed: a guess), and the cylinder that was found"
    canvas.write(MARGIN_IN, height - 0.8, about, Type(10, QUIET), WIDTH_IN - 2 * MARGIN_IN)
    for number, (task, picture) in enumerate(zip(tasks, pictures, strict=True)):
        row, column = divmod(number, COLUMNS)
        top = height - HEADING_IN - row * (tallest + CAPTION_IN)
        tall = CELL_IN / task.camera.aspect
        box = PageRectangle(MARGIN_IN + column * (CELL_IN + GAP_IN), top - tall, CELL_IN, tall)
        _picture(canvas, box, (task, picture), number, rows)
    for number, each in enumerate(rows):
        text = f"{each.name}: {each.cylinder.described}"
        y = FOOTING_IN + (len(rows) - number - 1) * LINE_IN
        canvas.write(MARGIN_IN, y, text, Type(10, INK), WIDTH_IN - 2 * MARGIN_IN)
    return canvas.png()


def _picture(
    canvas: Canvas, box: PageRectangle, seen: tuple[SearchTask, Array], number: int, rows: Sequence[SheetRow]
) -> None:
    task, pixels = seen
    canvas.image(np.rint(np.clip(pixels, 0.0, 1.0) * 255).astype(np.uint8), box)
    for row in rows:
        meant = number in row.shares
        _cylinder(canvas, box, task, row.cylinder, meant=meant)
        if meant:
            share = row.shares[number]
            face: Rgb = SUBJECT if share >= DOUBTFUL_SHARE else KEEP_OUT
            chip(canvas, (box.right - 0.06, box.top - 0.06), f"{row.name}  {100 * share:.0f} %", face, 9.0)
    if task.box is not None:
        corners = _placed(_corners(task.box), box)
        strip = np.concatenate([corners, corners[:1]])
        canvas.lines([strip], WHITE, 3.4, box)
        canvas.lines([strip], CAMERA, 1.9, box, (3.0, 2.0) if task.guessed else None)
    canvas.write(box.x, box.y - 0.2, task.label, Type(9.5, INK), box.width)


def _cylinder(canvas: Canvas, box: PageRectangle, task: SearchTask, c: Upright, *, meant: bool) -> None:
    """Draw the outline of a cylinder, and its rims if the keyframe means it."""
    eye, camera = task.camera.eye, task.camera.view
    x, y, z = c.middle
    outline = shape_outline(camera, (x - eye[0], y - eye[1], z - eye[2]), CylinderShape(c.radius, c.height))
    if len(outline):
        shape = _placed(outline, box)
        face = (*SUBJECT, 0.22 if meant else 0.0)
        canvas.polygons([shape], face, (*SUBJECT, 1.0 if meant else 0.55), 1.6 if meant else 0.8, box)
    if meant:
        edges = solid_edges(camera, eye, Cylinder(c.centre, c.radius, c.bottom, c.top))
        canvas.lines([_placed(edge, box) for edge in edges], (*SUBJECT, 0.8), 0.8, box)


def _corners(b: ScreenBox) -> Array:
    return np.array([[b.u_min, b.v_min], [b.u_max, b.v_min], [b.u_max, b.v_max], [b.u_min, b.v_max]])


def _placed(uv: Array, box: PageRectangle) -> Array:
    """Return page positions of screen points, shape (K, 2), inches."""
    return np.asarray(np.array([box.x, box.y]) + (uv + 1.0) / 2.0 * np.array([box.width, box.height]))
