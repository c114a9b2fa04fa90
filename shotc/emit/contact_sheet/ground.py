"""The map of a display: pads, zones, where its pictures stand, and where the audience is."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from shotc.emit.audience import Audience
from shotc.emit.contact_sheet.moments import Board
from shotc.emit.palette import CAMERA, FLIGHT, GROUND_FAR, INK, KEEP_IN, KEEP_OUT, QUIET, WHITE, Rgb, shade
from shotc.emit.storyboard.canvas import Box, Canvas
from shotc.emit.storyboard.furniture import north_arrow, round_length, scale_bar
from shotc.emit.storyboard.labels import Label, write_labels
from shotc.emit.storyboard.map import reach_of, zones
from shotc.emit.storyboard.map import squares as draw_squares
from shotc.emit.storyboard.sheet import Sheet
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import Colors
from shotc.ir.mission import MissionIR
from shotc.ir.sampling import light_colors

BORDER = 0.35
DOT, PAD = 0.022, 0.02
"""Radius of a light and half the width of a pad, inches."""

DARKER = 0.72
"""Lights on paper: what shines in the dark is too pale here."""


def draw_ground(canvas: Canvas, box: Box, board: Board, mission: MissionIR, seen: Audience) -> None:
    """Draw the map of one display into ``box``."""
    pads = np.array(mission.fleet(board.display.fleet).pads)
    lights = _pictures(board)
    eye = np.array([seen.eye])
    sheet = _sheet(box, np.concatenate([pads, lights[0], eye]))
    canvas.polygons([box.outline()], GROUND_FAR)
    step = max(5.0, round_length(float(np.max(reach_of(sheet))) / 3.0))
    draw_squares(canvas, sheet, step)
    zones(canvas, sheet, mission)
    _look(canvas, sheet, seen)
    squares = [_square(at, PAD).outline() for at in sheet.place(pads)]
    canvas.polygons(squares, WHITE, FLIGHT, 0.5, box)
    spots = [_square(at, DOT).outline() for at in sheet.place(lights[0])]
    canvas.polygons(spots, [tuple(DARKER * c / 255.0 for c in color) for color in lights[1].tolist()])
    _eye(canvas, sheet.place(eye[0]))
    content = [_around(sheet.place(points), 0.03) for points in (pads, lights[0], eye)]
    taken = [north_arrow(canvas, sheet, content)]
    taken.append(scale_bar(canvas, sheet, step, content + taken))
    _names(canvas, sheet, mission, (content, taken))
    canvas.polygons([box.outline()], "none", INK, 0.8)


def _pictures(board: Board) -> tuple[Array, Colors]:
    """Return where the lights of all pictures are, and how they shine."""
    times = np.array([moment.time for moment in board.moments])
    at = places(board.flight.breaks, board.flight.coef, times)
    colors = light_colors(board.flight.lights, times)
    return at.reshape(-1, 3), colors.reshape(-1, 3)


def _sheet(box: Box, cloud: Array) -> Sheet:
    low, high = cloud[:, :2].min(axis=0), cloud[:, :2].max(axis=0)
    span = np.maximum(high - low, 10.0)
    inches = float(min((box.width - 2 * BORDER) / span[0], (box.height - 2 * BORDER) / span[1]))
    return Sheet(box, np.eye(3)[:2], (low + high) / 2, inches)


def _look(canvas: Canvas, sheet: Sheet, seen: Audience) -> None:
    """Draw what is in the audience's frame, as a fan across the map."""
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


def _names(canvas: Canvas, sheet: Sheet, mission: MissionIR, others: tuple[list[Box], list[Box]]) -> None:
    content, taken = others
    pads, lights, eye = content
    labels = [
        Label(
            "audience", shade(CAMERA, 0.6), _around(np.array([[eye.x, eye.y], [eye.right, eye.top]]), 0.08)
        ),
        Label("pads", QUIET, pads),
        Label("pictures", INK, lights),
    ]
    for zone in mission.zones:
        seen = sheet.visible(sheet.outline(zone.solid))
        if seen is not None:
            color: Rgb = shade(KEEP_OUT if zone.keep == "out" else KEEP_IN, 0.8)
            labels.append(Label(zone.name, color, seen, inside=zone.keep == "out"))
    box = sheet.box
    inner = Box(box.x + 0.03, box.y + 0.03, box.width - 0.06, box.height - 0.06)
    write_labels(canvas, inner, labels, [*taken, *content])


def _square(at: Array, half: float) -> Box:
    return Box(float(at[0]) - half, float(at[1]) - half, 2 * half, 2 * half)


def _around(points: Array, border: float) -> Box:
    flat = np.atleast_2d(points)
    low, high = flat.min(axis=0) - border, flat.max(axis=0) + border
    return Box(float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1]))
