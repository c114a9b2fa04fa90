"""One panel of the storyboard: the camera's picture with its composition, and a caption with facts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees, hypot

import numpy as np

from shotc.emit.palette import CAMERA, INK, KEEP_OUT, QUIET, WHITE
from shotc.emit.screen import guide_lines
from shotc.emit.storyboard.camera_picture import PictureRectangle, picture
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, chip
from shotc.emit.storyboard.content import StoryboardFrame
from shotc.emit.storyboard.fleet_lights import draw_lights
from shotc.emit.storyboard.labels import MapLabel, write_labels
from shotc.emit.storyboard.scene import draw_scene, name_places
from shotc.emit.storyboard.subjects import FramedSubject
from shotc.geom.bernstein import Array
from shotc.geom.camera import heading_of
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import Composition, MissionIR, frozen
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.rounding import as_minutes

LINE_HEIGHT_IN = 0.165
"""Height of a line of a caption, inches."""

DOT_IN, LEAST_UNDER_DOT_IN = 0.038, 0.2
"""Radius of the dot on a subject, and least size of a subject that stays visible under it, inches."""

WIDE_CELL_IN = 2.3
"""Width of a cell, below which the facts of a caption take two lines, inches."""

PICTURE_SIDES = ("over", "over from", "over to", "right top", "left top", "under", "right", "left", "on")
"""Positions for the name of an object in a picture, best first."""

POINTS_OF_THE_COMPASS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


@dataclass(frozen=True, slots=True)
class Cell:
    """The rectangle of a panel's picture, and the width of its caption, inches."""

    picture: PageRectangle
    width: float


def draw_frame(canvas: Canvas, cell: Cell, moment: StoryboardFrame, mission: MissionIR, grid: float) -> None:
    """Draw a panel: the picture with its caption below.

    grid : width of a ground square, metres
    """
    box, mission = cell.picture, frozen(mission, moment.time)
    view = picture(moment.pose, box.width / box.height, box)
    draw_scene(canvas, view, mission, moment.targets, grid)
    if moment.lights is not None:
        draw_lights(canvas, view, moment.lights)
    for composition in dict.fromkeys(subject.composition for subject in moment.framed):
        _composition(canvas, view, composition)
    taken: list[PageRectangle] = []
    seen = {thing.name: thing.place for thing in name_places(view, mission)}
    for subject in moment.framed:
        offset = view.offset(mission.target(subject.target))
        taken += _marks(canvas, view, subject, offset, seen.get(subject.target))
    taken += _faults(canvas, box, moment.framed)
    subjects = [part for name in moment.targets for part in mission.parts_of(name)]
    lost = _names(canvas, view, mission, subjects, taken)
    canvas.polygons([box.outline()], "none", INK, 0.8)
    _caption(canvas, cell, moment, mission, lost)


def caption_height(width: float) -> float:
    """Return the height of the caption below a picture in a cell of some width, inches."""
    return 0.24 + (3 if width > WIDE_CELL_IN else 4) * LINE_HEIGHT_IN


def compass(yaw: float) -> str:
    """Return a camera yaw as compass heading in degrees, with its compass point."""
    heading = round(degrees(heading_of(yaw))) % 360
    return f"{heading:03d}° {POINTS_OF_THE_COMPASS[round(heading / 45) % 8]}"


def _composition(canvas: Canvas, view: PictureRectangle, composition: Composition) -> None:
    us, vs = guide_lines(composition)
    strips = [np.array([[u, -1.0], [u, 1.0]]) for u in us] + [np.array([[-1.0, v], [1.0, v]]) for v in vs]
    placed = [view.place(strip) for strip in strips]
    if placed:
        canvas.lines(placed, (*INK, 0.30), 1.7, view.box)
        canvas.lines(placed, (*WHITE, 0.95), 0.8, view.box)
    for point in composition.points if len(composition.points) > 1 else ():
        x, y = view.place(np.array(point))
        canvas.disc((float(x), float(y)), 0.032, (*WHITE, 0.9), (*INK, 0.55), 0.5)


def _marks(
    canvas: Canvas, view: PictureRectangle, subject: FramedSubject, offset: Vec3, body: PageRectangle | None
) -> list[PageRectangle]:
    """Draw the reference and the actual position of a subject; return the occupied rectangles.

    body : rectangle of the subject's visible part, or None
    """
    taken: list[PageRectangle] = []
    if subject.reference is not None:
        if subject.requested is not None and subject.is_moved:
            _requested(canvas, view, subject.requested, subject.reference)
            x, y = (float(c) for c in view.place(np.array(subject.requested)))
            taken.append(PageRectangle(x - 0.07, y - 0.07, 0.14, 0.14))
        x, y = _cross(canvas, view, subject.reference)
        taken.append(PageRectangle(x - 0.13, y - 0.13, 0.26, 0.26))
    u, v, depth = view.camera.project(offset)
    if depth > 0 and max(abs(u), abs(v)) <= 1:
        x, y = (float(c) for c in view.place(np.array([u, v])))
        taken.append(_actual(canvas, (x, y), body))
    return taken


def _actual(canvas: Canvas, at: Vec2, body: PageRectangle | None) -> PageRectangle:
    """Mark the position of a subject by a dot, or by a ring if the dot would cover the subject."""
    if body is None or max(body.width, body.height) >= LEAST_UNDER_DOT_IN:
        canvas.disc(at, DOT_IN, WHITE, INK, 0.9)
        return PageRectangle(at[0] - DOT_IN, at[1] - DOT_IN, 2 * DOT_IN, 2 * DOT_IN)
    reach = max(hypot(body.width, body.height) / 2 + 0.03, 2 * DOT_IN)
    turn = np.linspace(0, 2 * np.pi, 41)
    ring = np.stack([at[0] + reach * np.cos(turn), at[1] + reach * np.sin(turn)], axis=-1)
    canvas.lines([ring], (*INK, 0.8), 2.2)
    canvas.lines([ring], WHITE, 1.2)
    return PageRectangle(at[0] - reach, at[1] - reach, 2 * reach, 2 * reach)


def _cross(canvas: Canvas, view: PictureRectangle, at: Vec2) -> Vec2:
    x, y = (float(c) for c in view.place(np.array(at)))
    arms = [
        np.array([[x + sx * r, y + sy * r] for r in (0.065, 0.2)])
        for sx, sy in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    turn = np.linspace(0, 2 * np.pi, 41)
    ring = np.stack([x + 0.115 * np.cos(turn), y + 0.115 * np.sin(turn)], axis=-1)
    canvas.lines([*arms, ring], (*INK, 0.65), 2.8, view.box)
    canvas.lines([*arms, ring], CAMERA, 1.5, view.box)
    return x, y


def _requested(canvas: Canvas, view: PictureRectangle, requested: Vec2, reference: Vec2) -> None:
    ends = view.place(np.array([requested, reference]))
    canvas.lines([ends], (*WHITE, 0.9), 1.0, view.box, dash=(2.0, 2.0))
    x, y = ends[0]
    diamond = np.array([[x - 0.06, y], [x, y - 0.06], [x + 0.06, y], [x, y + 0.06]])
    canvas.polygons([diamond], (*WHITE, 0.35), INK, 0.8, view.box)


def _faults(canvas: Canvas, box: PageRectangle, framed: Sequence[FramedSubject]) -> list[PageRectangle]:
    """Write the faults of subjects, with names if there are several; return the occupied rectangles."""
    taken: list[PageRectangle] = []
    top = box.top - 0.07
    for subject in framed:
        if subject.fault:
            name = f"{subject.target} " if len(framed) > 1 else ""
            taken.append(chip(canvas, (box.right - 0.07, top), name + subject.fault.upper(), KEEP_OUT))
            top = taken[-1].y - 0.04
    return taken


def _names(
    canvas: Canvas,
    view: PictureRectangle,
    mission: MissionIR,
    subjects: Sequence[str],
    taken: list[PageRectangle],
) -> list[str]:
    """Write the names of visible objects, subjects first and none on a target; return those without room."""
    box = view.box
    inner = PageRectangle(box.x + 0.04, box.y + 0.04, box.width - 0.08, box.height - 0.08)
    things = sorted(name_places(view, mission), key=lambda thing: thing.name not in subjects)
    targets = {target.name for target in mission.targets}
    labels, bodies = [], []
    for name, color, seen in things:
        place = seen
        if name in subjects:
            for mark in (mark for mark in taken if mark.meets(seen)):
                place = place.with_box(mark)
        if name in targets:
            bodies.append(seen)
        labels.append(
            MapLabel(name, color, place, PICTURE_SIDES, 7.5, bold=False, inside=name not in targets)
        )
    return write_labels(canvas, inner, labels, [*taken, *bodies])


def _caption(
    canvas: Canvas, cell: Cell, moment: StoryboardFrame, mission: MissionIR, lost: Sequence[str]
) -> None:
    """Write the facts of a moment.

    lost : names of visible objects that have no room in the picture
    """
    pose, box = moment.pose, cell.picture
    base = box.y - 0.2
    canvas.disc((box.x + 0.095, base + 0.045), 0.095, INK, "none", 0)
    canvas.text(box.x + 0.095, base + 0.043, moment.mark, Type(7.5, WHITE, True, "center", "center_baseline"))
    canvas.text(box.x + 0.26, base, as_minutes(moment.time), Type(9.5, INK, bold=True))
    canvas.text(box.right, base, compass(float(pose[CAM_YAW])), Type(9.5, INK, bold=True, across="right"))
    facts = [f"pitch {round(degrees(pose[CAM_PITCH])):+d}°", f"hfov {degrees(pose[HFOV]):.0f}°"]
    distances = [
        float(np.linalg.norm(np.subtract(mission.target(t).centre, pose[:3]))) for t in moment.targets
    ]
    if distances:
        facts.append(f"{' to '.join(dict.fromkeys(map(metres, (min(distances), max(distances)))))} away")
    facts.append(_height(pose, mission))
    if moment.hold > 0:
        facts.append(f"hold {moment.hold:g} s")
    rows = [facts] if cell.width > WIDE_CELL_IN else [facts[:2], facts[2:]]
    for i, row in enumerate(rows, start=1):
        text = " · ".join(row).replace("-", "−")
        canvas.write(box.x, base - i * LINE_HEIGHT_IN, text, Type(7.8, QUIET), cell.width)
    x, y = box.x, base - (len(rows) + 1) * LINE_HEIGHT_IN
    if moment.worst:
        words, style = f"worst: {moment.worst}", Type(7.8, KEEP_OUT, bold=True)
        x += canvas.write(x, y, words, style, cell.width) + 0.1
    if lost:
        canvas.write(x, y, f"also seen: {', '.join(lost)}", Type(7.8, QUIET), box.x + cell.width - x)


def _height(pose: Array, mission: MissionIR) -> str:
    x, y, z = (float(c) for c in pose[:3])
    under = 0.0 if mission.terrain is None else mission.terrain.height(x, y)
    if mission.terrain is None or under is None:
        return f"alt {metres(z)}"
    return f"{metres(z - under)} over ground"


def metres(length: float) -> str:
    """Return a length with one decimal below 10 m and none above."""
    return f"{length:.1f} m" if abs(length) < 9.95 else f"{length:.0f} m"
