"""The page: for each display a map, and its pictures with the transitions to them, in the order of time."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, hypot
from typing import NamedTuple

import numpy as np

from shotc.emit.audience import ASPECT, Audience, audience
from shotc.emit.palette import FAINT, INK, QUIET, WHITE
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.furniture import round_length
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.trajectory import VerifiedIR
from shotc.rounding import as_minutes
from shotc.show.emit.contact_sheet.ground import draw_ground, map_height
from shotc.show.emit.contact_sheet.moments import FRAMES_BETWEEN, Board, SheetFrame, boards, lights
from shotc.show.emit.contact_sheet.night import hidden_lights, night
from shotc.show.emit.contact_sheet.scenery import Scenery, scenery
from shotc.show.emit.contact_sheet.stands import NUMBER_IN, number

WIDTH_IN, MARGIN_IN, GAP_IN = 16.0, 0.55, 0.34
HEADING_IN, FOOTING_IN, BAND_IN, CAPTION_IN = 1.30, 0.35, 0.60, 0.46
MAP_IN, COLUMNS = 3.9, 2
SLIT_IN = 0.05
"""Gap between small frames, and between them and the large one, inches."""

CELL = (WIDTH_IN - 2 * MARGIN_IN - MAP_IN - 0.35 + GAP_IN) / COLUMNS - GAP_IN
BIG = (CELL - SLIT_IN + 2 * SLIT_IN / FRAMES_BETWEEN * ASPECT * (FRAMES_BETWEEN - 1) / 2) / (
    1 + 1 / FRAMES_BETWEEN
)
HEIGHT = BIG / ASPECT
SMALL = (HEIGHT - (FRAMES_BETWEEN - 1) * SLIT_IN) / FRAMES_BETWEEN
LEAST_MAP_IN = 3.2


def draw_page(plan: VerifiedIR, dpi: float) -> bytes:
    """Return the whole sheet as PNG bytes."""
    with house_style():
        return _page(plan, dpi)


def _page(plan: VerifiedIR, dpi: float) -> bytes:
    sheets = boards(plan)
    height = HEADING_IN + sum(_height(board) for board in sheets) + FOOTING_IN
    canvas = Canvas(WIDTH_IN, height, dpi)
    _heading(canvas, height, plan)
    top = height - HEADING_IN
    for board in sheets:
        _board(canvas, top, (board, dpi), plan)
        top -= _height(board)
    return canvas.png()


def _height(board: Board) -> float:
    """Return the height of a display's part of the page, inches."""
    return BAND_IN + max(ceil(len(board.moments) / COLUMNS) * (HEIGHT + CAPTION_IN), LEAST_MAP_IN) + 0.22


def _heading(canvas: Canvas, height: float, plan: VerifiedIR) -> None:
    mission = plan.trajectory.keyframes.mission
    canvas.write(MARGIN_IN, height - 0.72, mission.name, Type(26, INK, bold=True), WIDTH_IN - 2 * MARGIN_IN)
    fleets = ", ".join(f"{len(flight.coef)} drones of {flight.fleet}" for flight in plan.trajectory.fleets)
    pictures = sum(len(display.pictures) for display in mission.displays)
    end = max(float(flight.breaks[-1]) for flight in plan.trajectory.fleets)
    facts = [fleets, f"{pictures} picture{'' if pictures == 1 else 's'}", f"{as_minutes(end)} in the air"]
    facts += _take_offs(plan)
    text = "   ·   ".join(facts)
    canvas.write(MARGIN_IN, height - 1.04, text, Type(11, QUIET), WIDTH_IN - 2 * MARGIN_IN)


def _take_offs(plan: VerifiedIR) -> list[str]:
    """Return which fleets take off in layers, with the number and the time, in words."""
    known, facts = dict(plan.trajectory.stats), []
    for flight in plan.trajectory.fleets:
        layers, seconds = (known.get(f"fleet {flight.fleet} take-off {key}") for key in ("layers", "s"))
        if layers is not None and seconds is not None:
            whose = f" of {flight.fleet}" if len(plan.trajectory.fleets) > 1 else ""
            facts.append(f"take-off{whose} in {float(layers):.0f} layers, {float(seconds):.0f} s")
    return facts


def _board(canvas: Canvas, top: float, what: tuple[Board, float], plan: VerifiedIR) -> None:
    board, dpi = what
    mission = plan.trajectory.keyframes.mission
    seen = audience(plan, board.display, ASPECT)
    canvas.lines([np.array([[MARGIN_IN, top], [WIDTH_IN - MARGIN_IN, top]])], FAINT, 0.8)
    _band(canvas, top, board, seen)
    start, tall = top - BAND_IN, _height(board) - BAND_IN - 0.22 - 0.17
    tall = min(tall, max(LEAST_MAP_IN, map_height(board, MAP_IN, seen)))
    draw_ground(canvas, PageRectangle(MARGIN_IN, start - tall, MAP_IN, tall), board, mission, seen)
    # The first transition starts on the ground, which no picture shows.
    wide = audience(plan, board.display, ASPECT, board.moments[0].way)
    large, small, first = (
        scenery(mission, view, (round(width * dpi), round(height * dpi)))
        for view, width, height in (
            (seen, BIG, HEIGHT),
            (seen, SMALL * ASPECT, SMALL),
            (wide, SMALL * ASPECT, SMALL),
        )
    )
    left = MARGIN_IN + MAP_IN + 0.35
    for i, moment in enumerate(board.moments):
        row, column = divmod(i, COLUMNS)
        x, y = left + column * (CELL + GAP_IN), start - row * (HEIGHT + CAPTION_IN) - HEIGHT
        _cell(canvas, (x, y), (board, moment), CellViews(large, first if i == 0 else small))


def _band(canvas: Canvas, top: float, board: Board, seen: Audience) -> None:
    base = top - 0.40
    x = MARGIN_IN + canvas.write(MARGIN_IN, base, board.display.id, Type(15, INK, bold=True), 4.0) + 0.22
    first, last = board.span
    facts = [f"{len(board.flight.coef)} drones of {board.flight.fleet}"]
    facts.append(f"{as_minutes(first)} to {as_minutes(last)} ({last - first:.1f} s)")
    if board.total > len(board.moments):
        facts.append(f"{len(board.moments)} of {board.total} frames")
    text = "  ·  ".join(facts)
    canvas.write(x, base, text, Type(9.5, QUIET), 6.0)
    whose = "as seen from the viewpoint" if seen.placed else "as seen from the south, for want of a viewpoint"
    words = f"{whose}, {_distance(board, seen):.0f} m away"
    canvas.text(WIDTH_IN - MARGIN_IN, base, words, Type(9.5, QUIET, across="right"))


def _distance(board: Board, seen: Audience) -> float:
    """Return the horizontal distance of the middle of the pictures from the audience, metres."""
    middle = _middle(board.flight, board.moments[0].time)
    return hypot(middle[0] - seen.eye[0], middle[1] - seen.eye[1])


def _middle(flight: FleetTrajectory, time: float) -> tuple[float, float, float]:
    at = places(flight.breaks, flight.coef, np.array([time]))[:, 0]
    x, y, z = ((at.min(axis=0) + at.max(axis=0)) / 2.0).tolist()
    return x, y, z


class CellViews(NamedTuple):
    """What the audience sees behind a picture, and behind the small frames of the transition to it."""

    picture: Scenery
    way: Scenery


def _cell(canvas: Canvas, at: tuple[float, float], what: tuple[Board, SheetFrame], behind: CellViews) -> None:
    """Draw a picture with the transition to it on its left, and a caption with its name and times."""
    (x, y), (board, moment) = at, what
    width = SMALL * ASPECT
    for i, time in enumerate(moment.way):
        box = PageRectangle(x, y + HEIGHT - SMALL - i * (SMALL + SLIT_IN), width, SMALL)
        _sky(canvas, box, (board, time), behind.way)
    box = PageRectangle(x + width + SLIT_IN, y, BIG, HEIGHT)
    _sky(canvas, box, (board, moment.time), behind.picture)
    _scale(canvas, box, _depth(board, moment, behind.picture.seen))
    hidden = hidden_lights(board.flight, moment.time, behind.picture)
    if hidden:
        canvas.text(
            box.x + 0.08,
            box.top - 0.17,
            f"{hidden} light{' is' if hidden == 1 else 's are'} hidden",
            Type(7.5, WHITE),
        )
    if board.flight.lights.looks:  # the lights change while the picture stands
        canvas.text(box.x + 0.08, box.y + 0.07, as_minutes(moment.time), Type(7.5, WHITE))
    name = (
        moment.name if moment.part is None else f"{moment.name}, frame {moment.part[0]} of {moment.part[1]}"
    )
    number(canvas, (box.x + NUMBER_IN, y - 0.15), board.moments.index(moment))
    canvas.write(box.x + 2 * NUMBER_IN + 0.07, y - 0.19, name, Type(10, INK, bold=True), 0.55 * BIG - 0.26)
    stands = as_minutes(moment.start)
    if moment.end - moment.start >= 1.0:
        stands = f"{as_minutes(moment.start)} to {as_minutes(moment.end)}"
    text = f"{stands}  ·  {lights(board.flight, moment.time)} of {len(board.flight.coef)} lights"
    canvas.text(box.right, y - 0.19, text, Type(8.5, QUIET, across="right"))
    if moment.way:
        canvas.text(x, y - 0.19, "on the way", Type(8.5, QUIET))
        _times(canvas, PageRectangle(x, y - 0.36, width, 0.15), moment.way)


def _times(canvas: Canvas, box: PageRectangle, way: Sequence[float]) -> None:
    """Write the times of the small frames below them, that of the top one first; lights fill the frames."""
    each = box.width / len(way)
    for i, time in enumerate(way):
        canvas.write(box.x + i * each, box.y, as_minutes(time), Type(7.5, QUIET), each - SLIT_IN)


def _sky(canvas: Canvas, box: PageRectangle, what: tuple[Board, float], behind: Scenery) -> None:
    board, time = what
    canvas.image(night((board.flight, *board.beside), time, behind), box)


def _depth(board: Board, moment: SheetFrame, seen: Audience) -> float:
    """Return the width of the audience's frame at the distance of a picture, metres."""
    middle = np.array(_middle(board.flight, moment.time)) - np.array(seen.eye)
    view = seen.view(ASPECT)
    return float(2.0 * view.half_width * max(view.to_camera((middle[0], middle[1], middle[2]))[2], 1.0))


def _scale(canvas: Canvas, box: PageRectangle, metres: float) -> None:
    """Draw a scale bar at the picture's distance."""
    length = round_length(0.22 * metres)
    width = length / metres * box.width
    right, y = box.right - 0.1, box.y + 0.1
    ends = [np.array([[right - width, y], [right, y]])]
    ends += [np.array([[e, y - 0.025], [e, y + 0.025]]) for e in (right - width, right)]
    canvas.lines(ends, (*WHITE, 0.65), 0.9)
    canvas.text(right - width / 2, y + 0.045, f"{length:g} m", Type(7.5, FAINT, across="center"))
