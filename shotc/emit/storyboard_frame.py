"""One panel of the storyboard: the camera's picture with its composition, and what is true at that moment."""

from __future__ import annotations

from math import degrees

import numpy as np
from numpy.typing import NDArray

from shotc.emit.palette import CAMERA, INK, KEEP_OUT, QUIET, WHITE, shade
from shotc.emit.screen import seen_whole
from shotc.emit.storyboard_canvas import Box, Canvas, Type, chip
from shotc.emit.storyboard_content import Moment
from shotc.emit.storyboard_scene import Picture, draw_scene, name_places, picture
from shotc.geom.camera import heading_of
from shotc.ir.mission import Composition, MissionIR, Vec2
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV

Array = NDArray[np.float64]

CAPTION = 0.50
"""Height of the two lines under a picture, inches."""

POINTS_OF_THE_COMPASS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


def draw_frame(
    canvas: Canvas, box: Box, moment: Moment, mission: MissionIR, scale: tuple[float, float]
) -> None:
    """Draw a panel into ``box``, which is the picture; the caption goes under it.

    scale : (aspect, width of a ground square in metres)
    """
    aspect, grid = scale
    shown = picture(moment.pose, aspect, box)
    draw_scene(canvas, shown, mission, moment.target, grid)
    _composition(canvas, shown, moment.composition)
    taken: list[Box] = []
    if moment.target is not None:
        target = mission.target(moment.target)
        _marks(canvas, shown, moment, shown.offset(target))
        if not bool(seen_whole(moment.pose, target, aspect)):
            taken.append(chip(canvas, (box.right - 0.07, box.top - 0.07), "CROPPED", KEEP_OUT))
    _names(canvas, shown, mission, taken)
    canvas.polygons([box.outline()], "none", shade(INK, 1.1), 0.8)
    _caption(canvas, box, moment, mission)


def clock(seconds: float) -> str:
    """Return a time as minutes, seconds and tenths."""
    tenths = round(seconds * 10)
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def compass(yaw: float) -> str:
    """Return a camera yaw as a compass heading in degrees, with its point of the compass."""
    heading = round(degrees(heading_of(yaw))) % 360
    return f"{heading:03d}° {POINTS_OF_THE_COMPASS[round(heading / 45) % 8]}"


def _composition(canvas: Canvas, shown: Picture, composition: Composition) -> None:
    points = composition.points
    crowd = len(points) > 5
    u_lines = {*composition.u_lines, *(() if crowd else (u for u, _ in points))}
    v_lines = {*composition.v_lines, *(() if crowd else (v for _, v in points))}
    if len(points) > 1:
        u_lines, v_lines = u_lines - {0.0}, v_lines - {0.0}
    strips = [np.array([[u, -1.0], [u, 1.0]]) for u in sorted(u_lines)]
    strips += [np.array([[-1.0, v], [1.0, v]]) for v in sorted(v_lines)]
    placed = [shown.place(strip) for strip in strips]
    if placed:
        canvas.lines(placed, (*INK, 0.18), 1.6, shown.box)
        canvas.lines(placed, (*WHITE, 0.85), 0.7, shown.box)
    for point in points if len(points) > 1 else ():
        x, y = shown.place(np.array(point))
        canvas.disc((float(x), float(y)), 0.032, (*WHITE, 0.9), (*INK, 0.35), 0.5)


def _marks(canvas: Canvas, shown: Picture, moment: Moment, offset: tuple[float, float, float]) -> None:
    u, v, depth = shown.camera.project(offset)
    if moment.reference is not None:
        if moment.asked is not None and np.hypot(*np.subtract(moment.asked, moment.reference)) > 0.02:
            _asked(canvas, shown, moment.asked, moment.reference)
        _cross(canvas, shown, moment.reference)
    if depth > 0 and max(abs(u), abs(v)) <= 1:
        x, y = shown.place(np.array([u, v]))
        canvas.disc((float(x), float(y)), 0.038, WHITE, INK, 0.9)


def _cross(canvas: Canvas, shown: Picture, at: Vec2) -> None:
    x, y = shown.place(np.array(at))
    arms = [
        np.array([[x + sx * r, y + sy * r] for r in (0.065, 0.2)])
        for sx, sy in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    turn = np.linspace(0, 2 * np.pi, 41)
    ring = np.stack([x + 0.115 * np.cos(turn), y + 0.115 * np.sin(turn)], axis=-1)
    canvas.lines([*arms, ring], (*INK, 0.65), 2.8, shown.box)
    canvas.lines([*arms, ring], CAMERA, 1.5, shown.box)


def _asked(canvas: Canvas, shown: Picture, asked: Vec2, reference: Vec2) -> None:
    ends = shown.place(np.array([asked, reference]))
    canvas.lines([ends], (*WHITE, 0.9), 1.0, shown.box, dash=(2.0, 2.0))
    x, y = ends[0]
    diamond = np.array([[x - 0.06, y], [x, y - 0.06], [x + 0.06, y], [x, y + 0.06]])
    canvas.polygons([diamond], (*WHITE, 0.35), INK, 0.8, shown.box)


def _names(canvas: Canvas, shown: Picture, mission: MissionIR, taken: list[Box]) -> None:
    inner = Box(shown.box.x + 0.04, shown.box.y + 0.04, shown.box.width - 0.08, shown.box.height - 0.08)
    for name, color, (x, y) in name_places(shown, mission):
        style = Type(7.0, color, across="center", along="bottom", halo=WHITE)
        width, height = canvas.extent(name, style)
        x = min(max(x, inner.x + width / 2), inner.right - width / 2)
        y = min(y + 0.03, inner.top - height)
        room = Box(x - width / 2, y, width, height)
        if inner.holds(room) and not any(room.meets(other) for other in taken):
            canvas.text(x, y, name, style)
            taken.append(Box(room.x - 0.02, room.y - 0.02, width + 0.04, height + 0.04))


def _caption(canvas: Canvas, box: Box, moment: Moment, mission: MissionIR) -> None:
    pose = moment.pose
    first, second = box.y - 0.2, box.y - 0.365
    canvas.disc((box.x + 0.095, first + 0.045), 0.095, INK, "none", 0)
    canvas.text(
        box.x + 0.095, first + 0.043, str(moment.number), Type(7, WHITE, True, "center", "center_baseline")
    )
    canvas.text(box.x + 0.26, first, clock(moment.time), Type(9.5, INK, bold=True))
    canvas.text(box.right, first, compass(float(pose[CAM_YAW])), Type(9.5, INK, bold=True, across="right"))
    facts = [f"pitch {round(degrees(pose[CAM_PITCH])):+d}°", f"hfov {degrees(pose[HFOV]):.0f}°"]
    if moment.target is not None:
        away = float(np.linalg.norm(np.subtract(mission.target(moment.target).centre, pose[:3])))
        facts.append(f"{metres(away)} away")
    facts.append(f"alt {metres(float(pose[2]))}")
    if moment.hold > 0:
        facts.append(f"hold {moment.hold:g} s")
    text, style = "  ·  ".join(facts).replace("-", "−"), Type(7.8, QUIET)
    fit = min(1.0, box.width / canvas.extent(text, style)[0])
    canvas.text(box.x, second, text, Type(7.8 * fit, QUIET))


def metres(length: float) -> str:
    """Return a length with digits that mean something on a set."""
    return f"{length:.1f} m" if abs(length) < 9.95 else f"{length:.0f} m"
