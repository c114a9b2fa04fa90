"""differences.png: each condition beside the last one, at the time of their largest difference in
each shot.
"""

from __future__ import annotations

from shotc.emit.palette import INK, QUIET
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.frame import Cell, caption_height
from shotc.emit.storyboard.side_by_side import (
    CELL_IN,
    GAP_IN,
    HEADING_IN,
    MARGIN_IN,
    NAMES_IN,
    draw_moment,
    moment_at,
    picture_size,
)
from shotc.ir.comparison import Comparison, ShotDifference

FACTS_HEIGHT_IN = 0.36


def draw_differences(comparison: Comparison, dpi: float) -> bytes:
    """Return the page as PNG bytes; the same comparison gives the same bytes.

    Raises ValueError if no two conditions have a plan.
    """
    if not comparison.differences:
        raise ValueError("no two conditions have a plan")
    with house_style():
        return _page(comparison, dpi)


def _page(comparison: Comparison, dpi: float) -> bytes:
    mission, differences = comparison.mission, comparison.differences
    sizes = [picture_size(mission.drone(mission.shot(each.shot).drone).aspect) for each in differences]
    heights = [NAMES_IN + height + caption_height(CELL_IN) + FACTS_HEIGHT_IN for _, height in sizes]
    width, height = 2 * MARGIN_IN + 2 * (CELL_IN + GAP_IN) - GAP_IN, HEADING_IN + sum(heights) + 0.2
    canvas = Canvas(width, height, dpi)
    canvas.write(MARGIN_IN, height - 0.66, mission.name, Type(22, INK, bold=True), width - 2 * MARGIN_IN)
    text = "where two refiners differ most: metres between cameras plus degrees between where they look"
    canvas.write(MARGIN_IN, height - 0.95, text, Type(10, QUIET), width - 2 * MARGIN_IN)
    top = height - HEADING_IN
    for each, size, used in zip(differences, sizes, heights, strict=True):
        _row(canvas, comparison, each, (top, size))
        top -= used
    return canvas.png()


def _row(
    canvas: Canvas, comparison: Comparison, difference: ShotDifference, at: tuple[float, tuple[float, float]]
) -> None:
    """Draw two pictures side by side.

    at : top of the row, and size of a picture, inches
    """
    top, (width, height) = at
    for column, (name, time) in enumerate(
        ((difference.condition, difference.time), (difference.other, difference.other_time))
    ):
        left = MARGIN_IN + column * (CELL_IN + GAP_IN)
        each = next(c for c in comparison.conditions if c.name == name)
        assert each.plan is not None
        shot = next(s for s in each.shots if s.id == difference.shot)
        canvas.write(left, top - 0.3, f"{name}, {difference.shot}", Type(13, INK, bold=True), CELL_IN)
        picture = PageRectangle(left, top - NAMES_IN - height, width, height)
        draw_moment(canvas, Cell(picture, CELL_IN), each.plan, moment_at(each.plan, shot, time, column + 1))
    apart = f"{difference.metres:.2f} m and {difference.degrees:.1f} deg apart"
    facts = f"{apart}; mean of their sum {difference.mean:.2f}"
    base = top - NAMES_IN - height - caption_height(CELL_IN) - 0.02
    canvas.write(MARGIN_IN, base, facts, Type(8.5, INK), 2 * CELL_IN + GAP_IN)
