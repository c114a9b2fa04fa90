"""compare.png: every refiner's worst picture of each shot, above its screen error over time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from textwrap import wrap

import numpy as np

from shotc.emit.palette import CAMERA, FAINT, GROUND_FAR, INK, KEEP_OUT, PAPER, QUIET, WHITE
from shotc.emit.screen import error_top, off_place, percent
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.content import StoryboardFrame, passing
from shotc.emit.storyboard.frame import Cell, caption_height, draw_frame
from shotc.emit.storyboard.furniture import round_length
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.comparison import ComparedShot, Comparison, Condition, Score, Trace
from shotc.ir.mission import Shot
from shotc.ir.trajectory import VerifiedIR

MARGIN_IN, GAP_IN, CELL_IN = 0.55, 0.32, 3.15
HEADING_IN, NAMES_IN, PLOT_IN, FACTS_IN = 1.15, 0.42, 1.15, 0.72
TALLEST_IN = 3.0
"""Height of the tallest picture, inches, for a camera in portrait format."""


@dataclass(frozen=True, slots=True)
class Panel:
    """Position of one refiner's column of a shot: left edge, top, and size of its picture, inches."""

    left: float
    top: float
    picture: tuple[float, float]


def draw_comparison(comparison: Comparison, dpi: float) -> bytes:
    """Return the page as PNG bytes; the same comparison gives the same bytes."""
    with house_style():
        return _page(comparison, dpi)


def worst_frame(shot: ComparedShot) -> float:
    """Return the mission time at which a shot shows its targets worst, seconds.

    It is the time of the largest cropping, else that of the largest screen error, else the middle of the
    shot.
    """
    cropped = [(float(t.margin.min()), float(t.times[int(np.argmin(t.margin))])) for t in shot.traces]
    if cropped and min(cropped)[0] < 0.0:
        return min(cropped)[1]
    off = [
        (float(np.nanmax(t.error)), float(t.times[int(np.nanargmax(t.error))]))
        for t in shot.traces
        if not np.isnan(t.error).all()
    ]
    return max(off)[1] if off else 0.5 * (shot.start + shot.end)


def _page(comparison: Comparison, dpi: float) -> bytes:
    mission, count = comparison.mission, len(comparison.conditions)
    sizes = [picture_size(mission.drone(shot.drone).aspect) for shot in mission.shots]
    heights = [_height(size) for size in sizes]
    width = 2 * MARGIN_IN + max(count, 2) * (CELL_IN + GAP_IN) - GAP_IN
    height = HEADING_IN + sum(heights) + 0.2
    canvas = Canvas(width, height, dpi)
    canvas.write(MARGIN_IN, height - 0.66, mission.name, Type(22, INK, bold=True), width - 2 * MARGIN_IN)
    text = (
        "every refiner's worst frame (amber below), and its screen error over the shot, in half frames; "
        "shaded where the target is not whole in the frame"
    )
    canvas.write(MARGIN_IN, height - 0.95, text, Type(10, QUIET), width - 2 * MARGIN_IN)
    top = height - HEADING_IN
    for shot, size, used in zip(mission.shots, sizes, heights, strict=True):
        canvas.lines([np.array([[MARGIN_IN, top], [width - MARGIN_IN, top]])], FAINT, 0.8)
        _shot(canvas, comparison, shot, Panel(MARGIN_IN, top, size))
        top -= used
    return canvas.png()


def picture_size(aspect: float) -> tuple[float, float]:
    """Return the width and the height of a picture, inches."""
    width = min(CELL_IN, TALLEST_IN * aspect)
    return width, width / aspect


def _height(picture: tuple[float, float]) -> float:
    return NAMES_IN + picture[1] + caption_height(CELL_IN) + PLOT_IN + FACTS_IN


def _shot(canvas: Canvas, comparison: Comparison, shot: Shot, first: Panel) -> None:
    several = len(comparison.mission.shots) > 1
    flown = [next((s for s in each.shots if s.id == shot.id), None) for each in comparison.conditions]
    top = error_top([trace.error for s in flown if s is not None for trace in s.traces])
    for i, (each, there) in enumerate(zip(comparison.conditions, flown, strict=True)):
        panel = Panel(first.left + i * (CELL_IN + GAP_IN), first.top, first.picture)
        name = f"{each.name}, {shot.id}" if several else each.name
        canvas.write(panel.left, panel.top - 0.3, name, Type(13, INK, bold=True), CELL_IN)
        if there is None or each.plan is None:
            _no_plan(canvas, each, panel)
        else:
            _flown(canvas, each.plan, there, panel, (i + 1, top))


def _flown(
    canvas: Canvas, plan: VerifiedIR, shot: ComparedShot, panel: Panel, what: tuple[int, float]
) -> None:
    """Draw the column of a shot with a plan.

    what : number of the column, and the end of the error axis
    """
    number, top = what
    width, height = panel.picture
    moment = moment_at(plan, shot, worst_frame(shot), number)
    picture = PageRectangle(panel.left, panel.top - NAMES_IN - height, width, height)
    draw_moment(canvas, Cell(picture, CELL_IN), plan, moment)
    plot = PageRectangle(
        panel.left + 0.34, picture.y - caption_height(CELL_IN) - PLOT_IN + 0.1, CELL_IN - 0.34, PLOT_IN - 0.22
    )
    draw_error(canvas, plot, shot, (moment.time, top))
    for i, text in enumerate(_facts(shot.score)):
        lost = i == 1 and shot.score.in_frame not in (None, 1.0)
        canvas.write(
            panel.left, plot.y - 0.36 - i * 0.17, text, Type(8.5, KEEP_OUT if lost else INK), CELL_IN
        )


def moment_at(plan: VerifiedIR, shot: ComparedShot, time: float, number: int) -> StoryboardFrame:
    """Return the content of a shot's picture at a mission time, with its number on the page."""
    (placed,) = (p for p in plan.trajectory.keyframes.shots if p.shot.id == shot.id)
    (flight,) = (f for f in plan.trajectory.drones if f.drone == shot.drone)
    return passing(plan, (placed, flight), time, number)


def draw_moment(canvas: Canvas, cell: Cell, plan: VerifiedIR, moment: StoryboardFrame) -> None:
    """Draw the camera's picture at a moment, with grid squares that suit its height over ground."""
    mission = plan.trajectory.keyframes.mission
    over = float(moment.pose[2]) - mission.ground(float(moment.pose[0]), float(moment.pose[1]))
    draw_frame(canvas, cell, moment, mission, max(1.0, round_length(abs(over) / 1.5)))


def _facts(score: Score) -> list[str]:
    lines = []
    if score.error_mean is not None and score.error_p95 is not None:
        lines.append(
            f"screen error mean {off_place(score.error_mean)}, 95 % within {off_place(score.error_p95)}"
        )
    if score.in_frame is not None and score.in_frame_four_points is not None:
        points = percent(score.in_frame_four_points)
        lines.append(f"whole in frame {percent(score.in_frame)}, by four points {points}")
        if score.visible is not None and score.visible < 1.0:
            lines[-1] += f", visible {percent(score.visible)}"
    return lines


def _no_plan(canvas: Canvas, each: Condition, panel: Panel) -> None:
    width, height = panel.picture
    box = PageRectangle(panel.left, panel.top - NAMES_IN - height, width, height)
    canvas.polygons([box.outline()], GROUND_FAR, FAINT, 0.8)
    canvas.text(box.x + 0.12, box.top - 0.3, "no plan", Type(11, KEEP_OUT, bold=True))
    lines = [line for d in each.faults for line in wrap(f"{d.code}: {d.message}", 44)]
    for i, line in enumerate(lines[: int((height - 0.5) / 0.17)]):
        canvas.text(box.x + 0.12, box.top - 0.55 - i * 0.17, line, Type(8, INK, halo=PAPER))


def draw_error(canvas: Canvas, box: PageRectangle, shot: ComparedShot, what: tuple[float, float]) -> None:
    """Draw the errors of a shot.

    what : time of the frame to mark, seconds, and the end of the error axis
    """
    time, top = what
    canvas.polygons([box.outline()], WHITE, FAINT, 0.6)
    cropped = [
        PageRectangle(box.x + a * box.width, box.y, (b - a) * box.width, box.height).outline()
        for trace in shot.traces
        for a, b in stretches(trace.share, trace.margin < 0.0)
    ]
    if cropped:
        canvas.polygons(cropped, (*KEEP_OUT, 0.22), clip=box)
    at = box.x + (time - shot.start) / (shot.end - shot.start) * box.width
    canvas.lines([np.array([[at, box.y], [at, box.top]])], CAMERA, 1.2)
    for trace in shot.traces:
        for strip in _curves(box, trace, top):
            canvas.lines([strip], INK, 1.3, box)
    canvas.text(box.x - 0.05, box.top - 0.08, f"{top:g}", Type(7.5, QUIET, across="right"))
    canvas.text(box.x - 0.05, box.y, "0", Type(7.5, QUIET, across="right"))
    canvas.text(box.x, box.y - 0.14, "0 s", Type(7.5, QUIET))
    canvas.text(box.right, box.y - 0.14, f"{shot.end - shot.start:.1f} s", Type(7.5, QUIET, across="right"))


def stretches(share: Array, flags: Mask) -> Iterator[tuple[float, float]]:
    """Yield the intervals in which the flags hold, each extended half-way to the neighbouring samples.

    share : of the samples' times in the shot, (M,), ascending; flags : (M,)
    """
    joined = np.concatenate([[False], joins(share), [False]])
    for a, b in runs(share, flags):
        low = 0.5 * (share[a - 1] + share[a]) if joined[a] else share[a]
        high = 0.5 * (share[b - 1] + share[b]) if joined[b] else share[b - 1]
        yield float(low), float(high)


def runs(share: Array, flags: Mask) -> Iterator[tuple[int, int]]:
    """Yield the first and one past the last index of consecutive samples whose flags hold.

    share, flags : as of ``stretches``, (M,) each
    """
    joined = np.concatenate([[False], joins(share)])
    (firsts,) = np.nonzero(flags & ~(joined & np.roll(flags, 1)))
    (lasts,) = np.nonzero(flags & ~(np.roll(joined, -1) & np.roll(flags, -1)))
    yield from zip(firsts.tolist(), (lasts + 1).tolist(), strict=True)


def joins(share: Array) -> Mask:
    """Return which samples are followed by the next on the clock, (M - 1,); at gaps another target is filmed.

    share : as of ``stretches``
    """
    steps = np.diff(share)
    return np.asarray(steps <= 1.5 * float(np.median(steps))) if len(steps) else np.zeros(0, dtype=np.bool_)


def _curves(box: PageRectangle, trace: Trace, top: float) -> Iterator[Array]:
    """Yield the curve of an error in parts, broken where the error is unknown and cut at the top."""
    x = box.x + trace.share * box.width
    y = box.y + np.minimum(trace.error, 2 * top) / top * box.height
    for a, b in runs(trace.share, ~np.isnan(y)):
        yield np.stack([x[a:b], y[a:b]], axis=-1)
