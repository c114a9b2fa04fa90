"""The map beside a shot's pictures: the scene from above or from the side, with path and frames."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from shotc.emit.palette import (
    CAMERA,
    FLIGHT,
    GROUND,
    GROUND_FAR,
    INK,
    KEEP_IN,
    KEEP_OUT,
    QUIET,
    SKY_LOW,
    SUBJECT,
    WHITE,
    shade,
)
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type
from shotc.emit.storyboard.content import ShotBoard, StoryboardFrame, standing
from shotc.emit.storyboard.contours import (
    PlanRelief,
    contour_heights,
    draw_profile,
    draw_relief,
    profile,
    relief_of,
)
from shotc.emit.storyboard.furniture import height_marks, north_arrow, round_length, scale_bar, view_name
from shotc.emit.storyboard.labels import MapLabel, nearest_room, write_labels
from shotc.emit.storyboard.sheet import Sheet, sheet_of
from shotc.emit.storyboard.standing import draw_on_map
from shotc.geom.bernstein import Array
from shotc.geom.camera import view
from shotc.geom.solids import Cylinder, convex_hull
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.target import Target

NUMBER_RADIUS_IN = 0.095
"""Radius of a frame's number, inches."""

MOST_SQUARES = 20
"""Most squares in half the width of a sheet; with more, the squares are made larger."""


def draw_map(canvas: Canvas, box: PageRectangle, board: ShotBoard, mission: MissionIR, grid: float) -> None:
    """Draw the map of one shot into ``box``.

    Names that have no room on it are written below it.

    grid : width of a ground square in the shot's pictures, metres
    """
    whole, mission = mission, standing(mission, board)
    sheet = sheet_of(box, board, mission)
    step = _step(sheet, grid)
    relief = relief_of(sheet, mission.terrain.ground) if mission.terrain and sheet.is_plan else None
    draw_paper(canvas, sheet, step, relief)
    if not sheet.is_plan:
        _ground_below(canvas, sheet, board, mission)
    draw_on_map(canvas, sheet, mission)
    zones(canvas, sheet, mission)
    canvas.lines([sheet.place(board.flight)], (*FLIGHT, 0.8), 0.9, box, dash=(4.0, 2.5))
    pad = _pad(sheet, board)
    canvas.polygons([p.outline() for p in pad], WHITE, INK, 1.0)
    for moment in board.moments:
        _frustum(canvas, sheet, moment, board.drone.aspect)
    _tracks(canvas, sheet, board, whole)
    _path(canvas, sheet, board, mission)
    _targets(canvas, sheet, mission)
    taken = [*_furniture(canvas, sheet, (step, relief), board, mission), *pad]
    _numbers(canvas, sheet, board, mission, taken)
    if relief is not None:
        taken += contour_heights(canvas, sheet, relief, taken + _content(sheet, board, mission))
    lost = _names(canvas, sheet, board, mission, taken)
    if lost:
        words = f"also here: {', '.join(lost)}"
        canvas.write(box.x, box.y - 0.15, words, Type(7.5, QUIET), box.width)
    canvas.polygons([box.outline()], "none", INK, 0.8)


def _step(sheet: Sheet, grid: float) -> float:
    """Return the width of a sheet's squares, metres: that of the pictures if there are not too many."""
    most = float(np.max(reach_of(sheet)))
    return grid if most <= MOST_SQUARES * grid else round_length(most / 8)


def draw_paper(canvas: Canvas, sheet: Sheet, step: float, relief: PlanRelief | None) -> None:
    """Draw the background of a sheet: paper or sky, relief, and grid lines ``step`` metres apart."""
    canvas.polygons([sheet.box.outline()], GROUND_FAR if sheet.is_plan else SKY_LOW)
    if relief is not None:
        draw_relief(canvas, sheet, relief)
    squares(canvas, sheet, step)


def _ground_below(canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR) -> None:
    """Draw the ground of a side view: the plane z = 0, or a section of the terrain below the path."""
    box = sheet.box
    if mission.terrain is not None:
        draw_profile(canvas, sheet, profile(sheet, mission.terrain.ground, board.path[:, :2].mean(axis=0)))
        return
    level = min(float(sheet.at(np.zeros(2))[1]), box.top)
    if level > box.y:
        canvas.polygons([PageRectangle(box.x, box.y, box.width, level - box.y).outline()], GROUND)
        canvas.lines([np.array([[box.x, level], [box.right, level]])], shade(GROUND, 0.6), 1.2, box)


def reach_of(sheet: Sheet) -> Array:
    """Return half the extent of a sheet along both axes, metres, shape (2,)."""
    return np.asarray(np.array([sheet.box.width, sheet.box.height]) / 2 / sheet.inches)


def squares(canvas: Canvas, sheet: Sheet, step: float) -> None:
    """Draw grid lines ``step`` metres apart across a sheet."""
    half = reach_of(sheet)
    low, high = sheet.centre - half, sheet.centre + half
    x = np.arange(np.ceil(low[0] / step), np.floor(high[0] / step) + 1) * step
    y = np.arange(np.ceil(low[1] / step), np.floor(high[1] / step) + 1) * step
    strips = [np.array([[a, low[1]], [a, high[1]]]) for a in x]
    strips += [np.array([[low[0], b], [high[0], b]]) for b in y]
    if strips:
        canvas.lines([sheet.at(s) for s in strips], (*WHITE, 0.8), 0.7, sheet.box)


def zones(canvas: Canvas, sheet: Sheet, mission: MissionIR) -> None:
    """Draw the outlines of a mission's zones."""
    for zone in mission.zones:
        shape = sheet.outline(zone.solid)
        if zone.keep == "out":
            canvas.polygons([shape], (*KEEP_OUT, 0.25), KEEP_OUT, 1.0, sheet.box)
        else:
            closed = np.concatenate([shape, shape[:1]])
            canvas.lines([closed], (*KEEP_IN, 0.25), 3.5, sheet.box)
            canvas.lines([closed], KEEP_IN, 1.0, sheet.box, dash=(5.0, 2.0))


def _tracks(canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR) -> None:
    """Draw the tracks of moving targets during the shot."""
    times = np.linspace(board.start, board.end, 60)
    for target in mission.targets:
        if target.track is not None:
            line = sheet.place(np.array([target.at(float(t)) for t in times]))
            canvas.lines([line], (*shade(SUBJECT, 0.75), 0.9), 1.1, sheet.box, dash=(1.5, 1.5))


def _pad(sheet: Sheet, board: ShotBoard) -> list[PageRectangle]:
    """Return where the drone's pad is drawn; nothing if it is off the map."""
    pad = _square(sheet.place(np.array(board.drone.home)), 0.055)
    return [pad] if sheet.box.holds(pad) else []


def _targets(canvas: Canvas, sheet: Sheet, mission: MissionIR) -> None:
    for target in sorted(mission.targets, key=lambda t: t.centre[2] + t.height / 2):
        canvas.polygons([_body(sheet, target)], SUBJECT, shade(SUBJECT, 0.55), 0.9, sheet.box)


def _body(sheet: Sheet, target: Target) -> Array:
    """Return the outline of a target on the page, large enough to be visible, shape (k, 2)."""
    solid, least = target.solid, 0.06 / sheet.inches
    if target.radius < least:
        x, y, _ = target.centre
        solid = Cylinder((x, y), least, solid.bottom, solid.top)
    return sheet.outline(solid)


def _frustum(canvas: Canvas, sheet: Sheet, moment: StoryboardFrame, aspect: float) -> None:
    """Draw the near part of the camera's field of view."""
    reach = min(0.75, 0.3 * sheet.box.height) / sheet.inches
    yaw, pitch, half = (float(moment.pose[c]) for c in (CAM_YAW, CAM_PITCH, HFOV))
    seen = view(yaw, pitch, half, aspect)
    side = np.linspace(-1.0, 1.0, 9)
    edge = np.ones(9)
    u = np.concatenate([side, edge, side, -edge]) * seen.half_width
    v = np.concatenate([edge, side, -edge, side]) * seen.half_height
    ahead = np.array([cos(pitch) * cos(yaw), cos(pitch) * sin(yaw), sin(pitch)])
    right = np.array([sin(yaw), -cos(yaw), 0.0])
    rays = ahead + u[:, None] * right + v[:, None] * np.cross(right, ahead)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    fan = sheet.place(np.concatenate([moment.pose[None, :3], moment.pose[:3] + reach * rays]))
    outline = np.array(convex_hull(tuple((float(x), float(y)) for x, y in fan)))
    canvas.polygons([outline], (*CAMERA, 0.20), (*CAMERA, 0.75), 0.6, sheet.box)


def _path(canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR) -> None:
    strip = sheet.place(board.path)
    canvas.lines([strip], INK, 2.6, sheet.box)
    canvas.lines([strip], CAMERA, 1.6, sheet.box)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(strip, axis=0), axis=1))])
    if length[-1] < 0.6:
        return
    marks = np.array(
        [sheet.place(m.pose[:3]) for m in board.moments]
        + [sheet.place(np.array(target.centre)) for target in mission.targets]
    )
    for share in (0.3, 0.8):
        at = _clear_of(strip, marks, int(np.searchsorted(length, share * length[-1])))
        step = strip[at] - strip[max(at - 2, 0)]
        direction = step / max(float(np.linalg.norm(step)), 1e-9)
        side = np.array([-direction[1], direction[0]])
        tip = strip[at] + 0.09 * direction
        head = np.array(
            [tip, strip[at] - 0.07 * direction + 0.075 * side, strip[at] - 0.07 * direction - 0.075 * side]
        )
        canvas.polygons([head], CAMERA, INK, 0.7, sheet.box)


def _clear_of(strip: Array, marks: Array, start: int) -> int:
    """Return the index of the point on a path nearest to ``start`` that no frame number covers."""
    distance = np.linalg.norm(strip[:, None] - marks, axis=-1).min(axis=1)
    free = np.flatnonzero(distance > 2.2 * NUMBER_RADIUS_IN)
    free = free[(free > 2) & (free < len(strip) - 3)]
    return int(free[np.argmin(np.abs(free - start))]) if len(free) else start


def _furniture(
    canvas: Canvas, sheet: Sheet, what: tuple[float, PlanRelief | None], board: ShotBoard, mission: MissionIR
) -> list[PageRectangle]:
    """Draw direction, scale bar, and distances of squares and contours; return the occupied rectangles."""
    step, relief = what
    content = _content(sheet, board, mission)
    if sheet.is_plan:
        taken = [north_arrow(canvas, sheet, content)]
    else:
        taken = height_marks(canvas, sheet, over_plane=mission.terrain is None)
        taken.append(view_name(canvas, sheet, content + taken))
    contours = 0.0 if relief is None else relief.step
    return [*taken, scale_bar(canvas, sheet, step, content + taken, contours)]


def _content(sheet: Sheet, board: ShotBoard, mission: MissionIR) -> list[PageRectangle]:
    """Return the rectangles of a map's content: path, frames, home, targets and zones."""
    content = [_square(at, 0.06) for at in sheet.place(board.path[::4])]
    content += [_square(sheet.place(m.pose[:3]), 2 * NUMBER_RADIUS_IN) for m in board.moments]
    content.append(_square(sheet.place(np.array(board.drone.home)), 0.1))
    shapes = [_body(sheet, t) for t in mission.targets]
    shapes += [sheet.outline(z.solid) for z in mission.zones if z.keep == "out"]
    return content + [seen for shape in shapes if (seen := sheet.visible(shape)) is not None]


def _numbers(
    canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR, taken: list[PageRectangle]
) -> None:
    """Write the frame numbers at or beside the cameras, and none on a target or on another number."""
    bodies = [seen for t in mission.targets if (seen := sheet.visible(_body(sheet, t))) is not None]
    spots = []
    for moment in board.moments:
        spot = _spot(sheet, moment, [*taken, *bodies])
        taken.append(_square(np.array(spot), NUMBER_RADIUS_IN))
        spots.append(spot)
    for moment, spot in zip(board.moments, spots, strict=True):
        x, y = (float(c) for c in sheet.place(moment.pose[:3]))
        canvas.lines([np.array([(x, y), spot])], INK, 0.8)
        canvas.disc((x, y), 0.03, CAMERA, INK, 0.7)
    for moment, spot in zip(board.moments, spots, strict=True):
        canvas.disc(spot, NUMBER_RADIUS_IN, INK, WHITE, 0.8)
        canvas.text(*spot, moment.mark, Type(7.5, WHITE, True, "center", "center_baseline"))


def _spot(sheet: Sheet, moment: StoryboardFrame, taken: list[PageRectangle]) -> tuple[float, float]:
    """Return a free place for a frame's number: at the camera, or beside it, first behind it."""
    x, y = (float(c) for c in sheet.place(moment.pose[:3]))
    back = float(moment.pose[CAM_YAW]) + pi if sheet.is_plan else pi
    polar = [(radius, back + turn) for radius in (0.24, 0.42) for turn in (0.0, 0.9, -0.9, 1.8, -1.8, 2.7)]
    spots = [(x, y)] + [(x + r * cos(a), y + r * sin(a)) for r, a in polar]
    rooms = (_square(np.array(s), NUMBER_RADIUS_IN) for s in spots)
    free = (r for r in rooms if sheet.box.holds(r) and not any(r.meets(other) for other in taken))
    place = _square(np.array((x, y)), 0.0)
    rectangle = next(free, None) or nearest_room(
        (2 * NUMBER_RADIUS_IN, 2 * NUMBER_RADIUS_IN), sheet.box, place, taken, 0.0
    )
    return (x, y) if rectangle is None else (rectangle.x + NUMBER_RADIUS_IN, rectangle.y + NUMBER_RADIUS_IN)


def _square(at: Array, half: float) -> PageRectangle:
    return PageRectangle(float(at[0]) - half, float(at[1]) - half, 2 * half, 2 * half)


def _names(
    canvas: Canvas, sheet: Sheet, board: ShotBoard, mission: MissionIR, taken: list[PageRectangle]
) -> list[str]:
    """Write the names of objects on the map; return those without room."""
    labels = []
    for target in {t.name: t for t in mission.targets}.values():
        seen = sheet.visible(_body(sheet, target))
        if seen is not None:
            labels.append(MapLabel(target.name, shade(SUBJECT, 0.75), seen))
    named = len(labels)
    bodies = [seen for t in mission.targets if (seen := sheet.visible(_body(sheet, t))) is not None]
    labels += [MapLabel("home", QUIET, pad) for pad in _pad(sheet, board)]
    for zone in mission.zones:
        seen = sheet.visible(sheet.outline(zone.solid))
        if zone.keep == "out" and seen is not None:
            labels.append(MapLabel(zone.name, shade(KEEP_OUT, 0.8), seen, inside=True))
    inner = PageRectangle(
        sheet.box.x + 0.03, sheet.box.y + 0.03, sheet.box.width - 0.06, sheet.box.height - 0.06
    )
    lines = [_square(at, 0.03) for at in sheet.place(board.path[::2])]
    # Names may cover a zone, but not one so small that they would hide it.
    small = [label.thing for label in labels[named:] if label.thing.height < 0.6]
    return write_labels(canvas, inner, labels, [*taken, *bodies], [*lines, *small])
