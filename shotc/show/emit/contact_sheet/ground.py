"""The map of a display: terrain, scenes and buildings, pads, zones, pictures, and the audience."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from shotc.emit.audience import Audience
from shotc.emit.palette import CAMERA, FLIGHT, INK, KEEP_IN, KEEP_OUT, QUIET, WHITE, Rgb, shade
from shotc.emit.storyboard.canvas import Canvas, PageRectangle
from shotc.emit.storyboard.contours import contour_heights, relief_of
from shotc.emit.storyboard.furniture import north_arrow, round_length, scale_bar
from shotc.emit.storyboard.labels import MapLabel, write_labels
from shotc.emit.storyboard.map import draw_paper, reach_of, zones
from shotc.emit.storyboard.sheet import Sheet
from shotc.emit.storyboard.standing import draw_on_map
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.mission import MissionIR
from shotc.show.emit.contact_sheet.moments import Board
from shotc.show.emit.contact_sheet.stands import draw_stands, outlines

BORDER_IN = 0.35
"""Border between the content and the map's edge, inches."""

PAD_HALF_WIDTH_IN = 0.02
"""Half the width of a pad, inches."""

HEIGHTS_PT = 7.5
"""Size of the heights of contours, points: the least that can be read on this sheet."""


def draw_ground(canvas: Canvas, box: PageRectangle, board: Board, mission: MissionIR, seen: Audience) -> None:
    """Draw the map of one display into ``box``."""
    pads = np.array(mission.fleet(board.display.fleet).pads)
    eye = np.array([seen.eye])
    sheet = _sheet(box, board, seen)
    step = max(5.0, round_length(float(np.max(reach_of(sheet))) / 3.0))
    relief = relief_of(sheet, mission.terrain.ground) if mission.terrain else None
    draw_paper(canvas, sheet, step, relief)
    draw_on_map(canvas, sheet, mission)
    zones(canvas, sheet, mission)
    _look(canvas, sheet, seen)
    squares = [_square(at, PAD_HALF_WIDTH_IN).outline() for at in sheet.place(pads)]
    canvas.polygons(squares, WHITE, FLIGHT, 0.5, box)
    shapes = outlines(board, sheet)
    content = [_around(sheet.place(pads), 0.03), _around(np.concatenate(shapes), 0.03)]
    content.append(_around(sheet.place(eye), 0.03))
    taken = [north_arrow(canvas, sheet, content)]
    taken.append(scale_bar(canvas, sheet, step, content + taken, 0.0 if relief is None else relief.step))
    taken += draw_stands(canvas, sheet, shapes, [*taken, content[0], content[2]])
    if relief is not None:
        taken += contour_heights(canvas, sheet, relief, taken + content, HEIGHTS_PT)
    _eye(canvas, sheet.place(eye[0]))
    _names(canvas, sheet, mission, (content, taken))
    canvas.polygons([box.outline()], "none", INK, 0.8)


def map_height(board: Board, width: float, seen: Audience) -> float:
    """Return the height of a map of some width, inches."""
    low, high = _reach(board, seen)
    span = np.maximum(high - low, 10.0)
    return float((width - 2 * BORDER_IN) / span[0] * span[1]) + 2 * BORDER_IN


def _reach(board: Board, seen: Audience) -> tuple[Array, Array]:
    """Return the corners of the map's content, (2,) each, metres."""
    times = np.array([moment.time for moment in board.moments])
    at = places(board.flight.breaks, board.flight.coef, np.array([0.0, *times])).reshape(-1, 3)
    cloud = np.concatenate([at[:, :2], [seen.eye[:2]]])
    return cloud.min(axis=0), cloud.max(axis=0)


def _sheet(box: PageRectangle, board: Board, seen: Audience) -> Sheet:
    low, high = _reach(board, seen)
    span = np.maximum(high - low, 10.0)
    inches = float(min((box.width - 2 * BORDER_IN) / span[0], (box.height - 2 * BORDER_IN) / span[1]))
    return Sheet(box, np.eye(3)[:2], (low + high) / 2, inches)


def _look(canvas: Canvas, sheet: Sheet, seen: Audience) -> None:
    """Draw the audience's field of view as a fan across the map."""
    reach = 2.0 * max(sheet.box.width, sheet.box.height) / sheet.inches
    turn = np.linspace(seen.yaw - seen.hfov / 2, seen.yaw + seen.hfov / 2, 25)
    rim = np.array(seen.eye[:2]) + reach * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    fan = sheet.at(np.concatenate([[seen.eye[:2]], rim]))
    canvas.polygons([fan], (*CAMERA, 0.13), clip=sheet.box)
    canvas.lines([fan[:2], fan[[0, -1]]], (*CAMERA, 0.8), 0.7, sheet.box)


def _eye(canvas: Canvas, at: Array) -> None:
    turn = np.linspace(0.0, pi, 15)
    lid = np.array([[0.12 * cos(a), 0.07 * sin(a)] for a in turn])
    shape = np.concatenate([lid, -lid])
    canvas.polygons([at + shape], WHITE, INK, 1.0)
    canvas.disc((float(at[0]), float(at[1])), 0.045, INK, WHITE, 0.6)


def _names(
    canvas: Canvas, sheet: Sheet, mission: MissionIR, others: tuple[list[PageRectangle], list[PageRectangle]]
) -> None:
    content, taken = others
    pads, _, eye = content
    labels = [
        MapLabel(
            "audience", shade(CAMERA, 0.6), _around(np.array([[eye.x, eye.y], [eye.right, eye.top]]), 0.08)
        ),
        MapLabel("pads", QUIET, pads),
    ]
    for zone in mission.zones:
        seen = sheet.visible(sheet.outline(zone.solid))
        if seen is not None:
            color: Rgb = shade(KEEP_OUT if zone.keep == "out" else KEEP_IN, 0.8)
            labels.append(MapLabel(zone.name, color, seen, inside=zone.keep == "out"))
    box = sheet.box
    inner = PageRectangle(box.x + 0.03, box.y + 0.03, box.width - 0.06, box.height - 0.06)
    write_labels(canvas, inner, labels, [*taken, *content])


def _square(at: Array, half: float) -> PageRectangle:
    return PageRectangle(float(at[0]) - half, float(at[1]) - half, 2 * half, 2 * half)


def _around(points: Array, border: float) -> PageRectangle:
    flat = np.atleast_2d(points)
    low, high = flat.min(axis=0) - border, flat.max(axis=0) + border
    return PageRectangle(float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1]))
