"""The map beside a shot's pictures: the scene from above, north up, with the path and the frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.emit.palette import (
    CAMERA,
    FLIGHT,
    GROUND_FAR,
    INK,
    KEEP_IN,
    KEEP_OUT,
    QUIET,
    SUBJECT,
    WHITE,
    Rgb,
    shade,
)
from shotc.emit.storyboard.canvas import Box, Canvas, Type
from shotc.emit.storyboard.content import Moment, ShotBoard
from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid
from shotc.ir.mission import MissionIR, Target
from shotc.ir.path import CAM_YAW, HFOV


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A map's rectangle and its scale: ``inches`` per metre about the ``centre`` of W it shows."""

    box: Box
    centre: Array
    inches: float

    def place(self, points: Array) -> Array:
        """Return page positions of points of W, shape (..., 2)."""
        middle = np.array([self.box.x + self.box.width / 2, self.box.y + self.box.height / 2])
        return np.asarray(middle + (points[..., :2] - self.centre) * self.inches)


def draw_map(canvas: Canvas, box: Box, board: ShotBoard, mission: MissionIR, grid: float) -> None:
    """Draw the map of one shot into ``box``; grid is the width of a ground square, metres."""
    sheet = _sheet(box, board, mission)
    canvas.polygons([box.outline()], GROUND_FAR)
    _squares(canvas, sheet, grid)
    _zones(canvas, sheet, mission)
    canvas.lines([sheet.place(board.flight)], (*FLIGHT, 0.8), 0.9, box, dash=(4.0, 2.5))
    for moment in board.moments:
        _frustum(canvas, sheet, moment)
    _targets(canvas, sheet, mission)
    _path(canvas, sheet, board)
    taken = [_north(canvas, box), _scale_bar(canvas, sheet)]
    _numbers(canvas, sheet, board, taken)
    _names(canvas, sheet, board, mission, taken)
    canvas.polygons([box.outline()], "none", INK, 0.8)


def round_length(length: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, ... that is no longer than ``length``."""
    power = 10.0 ** np.floor(np.log10(max(length, 1e-6)))
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= length * (1 + 1e-9)) * power)


def _sheet(box: Box, board: ShotBoard, mission: MissionIR) -> Sheet:
    points = [board.path[:, :2]]
    subjects = {m.target for m in board.moments if m.target is not None}
    for target in (mission.target(name) for name in sorted(subjects)):
        centre = np.array(target.centre[:2])
        points.append(centre + target.radius * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]))
    cloud = np.concatenate(points)
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    # A camera that stands still deserves as much ground as it sees.
    span = np.maximum(high - low, max(10.0, 0.8 * float(np.median(np.abs(board.path[:, 2])))))
    inches = float(min((box.width - 0.9) / span[0], (box.height - 0.9) / span[1]))
    return Sheet(box, (low + high) / 2, inches)


def _squares(canvas: Canvas, sheet: Sheet, grid: float) -> None:
    half = np.array([sheet.box.width, sheet.box.height]) / 2 / sheet.inches
    low, high = sheet.centre - half, sheet.centre + half
    step = grid * max(1.0, np.ceil(float(np.max(half)) / grid / 20))
    x = np.arange(np.ceil(low[0] / step), np.floor(high[0] / step) + 1) * step
    y = np.arange(np.ceil(low[1] / step), np.floor(high[1] / step) + 1) * step
    strips = [np.array([[a, low[1]], [a, high[1]]]) for a in x]
    strips += [np.array([[low[0], b], [high[0], b]]) for b in y]
    if strips:
        canvas.lines([sheet.place(s) for s in strips], (*WHITE, 0.8), 0.7, sheet.box)


def footprint(solid: Solid) -> Array:
    """Return the ground plan of a solid, shape (k, 2)."""
    if isinstance(solid, Cylinder):
        turn = np.linspace(0, 2 * np.pi, 73)[:-1]
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        return np.asarray(np.array(solid.centre) + solid.radius * ring)
    return np.asarray(solid.points, dtype=np.float64)


def _zones(canvas: Canvas, sheet: Sheet, mission: MissionIR) -> None:
    for zone in mission.zones:
        shape = sheet.place(footprint(zone.solid))
        if zone.keep == "out":
            canvas.polygons([shape], (*KEEP_OUT, 0.25), KEEP_OUT, 1.0, sheet.box)
        else:
            closed = np.concatenate([shape, shape[:1]])
            canvas.lines([closed], (*KEEP_IN, 0.25), 3.5, sheet.box)
            canvas.lines([closed], KEEP_IN, 1.0, sheet.box, dash=(5.0, 2.0))


def _targets(canvas: Canvas, sheet: Sheet, mission: MissionIR) -> None:
    for target in sorted(mission.targets, key=lambda t: t.centre[2] + t.height / 2):
        shape = sheet.place(_disc(sheet, target))
        canvas.polygons([shape], SUBJECT, shade(SUBJECT, 0.55), 0.9, sheet.box)


def _disc(sheet: Sheet, target: Target) -> Array:
    """Return the ground plan of a target, never too small to be seen."""
    radius = max(target.radius, 0.06 / sheet.inches)
    return footprint(Cylinder((target.centre[0], target.centre[1]), radius, 0.0, 1.0))


def _frustum(canvas: Canvas, sheet: Sheet, moment: Moment) -> None:
    reach = 0.75 / sheet.inches
    yaw, half = float(moment.pose[CAM_YAW]), float(moment.pose[HFOV]) / 2
    fan = [moment.pose[:2]]
    fan += [
        moment.pose[:2] + reach * np.array([np.cos(a), np.sin(a)])
        for a in np.linspace(yaw - half, yaw + half, 13)
    ]
    shape = sheet.place(np.array(fan))
    canvas.polygons([shape], (*CAMERA, 0.20), (*CAMERA, 0.75), 0.6, sheet.box)


def _path(canvas: Canvas, sheet: Sheet, board: ShotBoard) -> None:
    strip = sheet.place(board.path)
    canvas.lines([strip], INK, 2.6, sheet.box)
    canvas.lines([strip], CAMERA, 1.6, sheet.box)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(strip, axis=0), axis=1))])
    if length[-1] < 0.6:
        return
    for share in (0.3, 0.8):
        at = int(np.searchsorted(length, share * length[-1]))
        step = strip[at] - strip[max(at - 2, 0)]
        way = step / max(float(np.linalg.norm(step)), 1e-9)
        side = np.array([-way[1], way[0]])
        tip = strip[at] + 0.09 * way
        head = np.array([tip, strip[at] - 0.07 * way + 0.075 * side, strip[at] - 0.07 * way - 0.075 * side])
        canvas.polygons([head], CAMERA, INK, 0.7, sheet.box)


def _numbers(canvas: Canvas, sheet: Sheet, board: ShotBoard, taken: list[Box]) -> None:
    radius = 0.095
    spots = []
    for moment in board.moments:
        spot = _spot(sheet, moment, radius, taken)
        taken.append(_square(spot, radius))
        spots.append(spot)
    for moment, spot in zip(board.moments, spots, strict=True):
        x, y = (float(c) for c in sheet.place(moment.pose[:2]))
        canvas.lines([np.array([(x, y), spot])], INK, 0.8)
        canvas.disc((x, y), 0.03, CAMERA, INK, 0.7)
    for moment, spot in zip(board.moments, spots, strict=True):
        canvas.disc(spot, radius, INK, WHITE, 0.8)
        canvas.text(*spot, str(moment.number), Type(7, WHITE, True, "center", "center_baseline"))


def _spot(sheet: Sheet, moment: Moment, radius: float, taken: list[Box]) -> tuple[float, float]:
    """Return a free place for a keyframe's number: on it, or beside it, behind the camera first."""
    x, y = (float(c) for c in sheet.place(moment.pose[:2]))
    back = float(moment.pose[CAM_YAW]) + np.pi
    ways = [(away, back + turn) for away in (0.24, 0.42) for turn in (0.0, 0.9, -0.9, 1.8, -1.8, 2.7)]
    spots = [(x, y)] + [(x + r * float(np.cos(a)), y + r * float(np.sin(a))) for r, a in ways]
    free = (s for s in spots if not any(_square(s, radius).meets(other) for other in taken))
    return next(free, (x, y))


def _square(at: tuple[float, float], half: float) -> Box:
    return Box(at[0] - half, at[1] - half, 2 * half, 2 * half)


def _names(canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR, taken: list[Box]) -> None:
    labels: list[tuple[str, Rgb, Box]] = []
    for target in mission.targets:
        seen = _visible(sheet, _disc(sheet, target))
        if seen is not None:
            labels.append((target.name, shade(SUBJECT, 0.75), seen))
    taken += [seen for _, _, seen in labels]
    for zone in mission.zones:
        seen = _visible(sheet, footprint(zone.solid))
        if zone.keep == "out" and seen is not None:
            labels.append((zone.name, shade(KEEP_OUT, 0.8), seen))
    x, y = (float(c) for c in sheet.place(np.array(board.drone.home[:2])))
    pad = _square((x, y), 0.055)
    if sheet.box.holds(pad):
        canvas.polygons([pad.outline()], WHITE, INK, 1.0)
        taken.append(pad)
        labels.append(("home", QUIET, pad))
    for name, color, seen in labels:
        _name(canvas, sheet, (name, color), seen, taken)


def _visible(sheet: Sheet, plan: Array) -> Box | None:
    """Return the part of a ground plan's rectangle that is on the map, on the page, or None."""
    points, box = sheet.place(plan), sheet.box
    left, bottom = (float(c) for c in np.maximum(points.min(axis=0), (box.x, box.y)))
    right, top = (float(c) for c in np.minimum(points.max(axis=0), (box.right, box.top)))
    return Box(left, bottom, right - left, top - bottom) if right > left and top > bottom else None


def _name(canvas: Canvas, sheet: Sheet, what: tuple[str, Rgb], seen: Box, taken: list[Box]) -> None:
    """Write a name under its thing, or wherever else beside it or on it there is room."""
    name, color = what
    style = Type(7.5, color, bold=True, across="center", along="bottom", halo=WHITE)
    width, height = canvas.extent(name, style)
    x, y, gap = seen.x + seen.width / 2, seen.y + seen.height / 2 - height / 2, 0.06
    spots = [
        (x, seen.y - gap - height),
        (x, seen.top + gap),
        (x, y),
        (seen.right + gap + width / 2, y),
        (seen.x - gap - width / 2, y),
    ]
    for left, base in spots:
        room = Box(left - width / 2, base, width, height)
        if sheet.box.holds(room) and not any(room.meets(other) for other in taken):
            canvas.text(left, base, name, style)
            taken.append(room)
            return


def _north(canvas: Canvas, box: Box) -> Box:
    x, y = box.right - 0.22, box.top - 0.36
    canvas.polygons([np.array([[x, y + 0.17], [x - 0.07, y - 0.1], [x, y - 0.05]])], INK)
    canvas.polygons([np.array([[x, y + 0.17], [x + 0.07, y - 0.1], [x, y - 0.05]])], WHITE, INK, 0.7)
    canvas.text(x, y + 0.19, "N", Type(8, INK, bold=True, across="center"))
    return Box(x - 0.12, y - 0.12, 0.24, 0.48)


def _scale_bar(canvas: Canvas, sheet: Sheet) -> Box:
    length = round_length(0.26 * sheet.box.width / sheet.inches)
    x, y = sheet.box.x + 0.13, sheet.box.y + 0.14
    width = length * sheet.inches
    ground = Box(x - 0.05, y - 0.06, width + 0.1, 0.3)
    canvas.polygons([ground.outline()], (*GROUND_FAR, 0.85))
    for i, face in enumerate((INK, WHITE)):
        canvas.polygons([Box(x + i * width / 2, y, width / 2, 0.055).outline()], face, INK, 0.7)
    canvas.text(x, y + 0.09, f"{length:g} m", Type(7.5, INK))
    return ground
