"""Scale bar, North arrow and other marks of a map, in corners that its content leaves free."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.emit.palette import GROUND_FAR, INK, PAPER, QUIET, SKY_LOW, WHITE
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type
from shotc.emit.storyboard.sheet import Sheet
from shotc.geom.camera import heading_of

LOWER_FIRST = (("left", "low"), ("right", "low"), ("left", "high"), ("right", "high"))
UPPER_FIRST = (("right", "high"), ("left", "high"), ("right", "low"), ("left", "low"))


def round_length(length: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, ... that is at most ``length``."""
    power = 10.0 ** np.floor(np.log10(max(length, 1e-6)))
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= length * (1 + 1e-9)) * power)


def corner(
    box: PageRectangle,
    size: tuple[float, float],
    corners: Sequence[tuple[str, str]],
    content: Sequence[PageRectangle],
) -> PageRectangle:
    """Return a rectangle in the first corner that overlaps the fewest parts of the content."""
    rooms = []
    for across, up in corners:
        x = box.x + 0.07 if across == "left" else box.right - 0.07 - size[0]
        y = box.y + 0.07 if up == "low" else box.top - 0.07 - size[1]
        rooms.append(PageRectangle(x, y, *size))
    return min(rooms, key=lambda rectangle: sum(rectangle.meets(other) for other in content))


def scale_bar(
    canvas: Canvas, sheet: Sheet, step: float, content: Sequence[PageRectangle], contours: float = 0.0
) -> PageRectangle:
    """Draw the scale bar with the width of the sheet's squares, ``step`` metres; return its rectangle.

    contours : metres between contours; 0 if there are none
    """
    length = round_length(0.26 * sheet.box.width / sheet.inches)
    width = length * sheet.inches
    text, style = f"{length:g} m · grid {step:g} m", Type(7.5, INK)
    text += f" · contours {contours:g} m" if contours else ""
    rectangle = corner(
        sheet.box, (max(width, canvas.extent(text, style)[0]) + 0.12, 0.31), LOWER_FIRST, content
    )
    x, y = rectangle.x + 0.06, rectangle.y + 0.07
    canvas.polygons([rectangle.outline()], (*GROUND_FAR, 0.85))
    for i, face in enumerate((INK, WHITE)):
        canvas.polygons([PageRectangle(x + i * width / 2, y, width / 2, 0.055).outline()], face, INK, 0.7)
    canvas.text(x, y + 0.09, text, style)
    return rectangle


def north_arrow(canvas: Canvas, sheet: Sheet, content: Sequence[PageRectangle]) -> PageRectangle:
    """Draw the North arrow of a plan; return its rectangle."""
    rectangle = corner(sheet.box, (0.3, 0.52), UPPER_FIRST, content)
    x, y = rectangle.x + 0.15, rectangle.y + 0.14
    canvas.polygons([np.array([[x, y + 0.17], [x - 0.07, y - 0.1], [x, y - 0.05]])], INK)
    canvas.polygons([np.array([[x, y + 0.17], [x + 0.07, y - 0.1], [x, y - 0.05]])], WHITE, INK, 0.7)
    canvas.text(x, y + 0.19, "N", Type(8, INK, bold=True, across="center"))
    return rectangle


def view_name(canvas: Canvas, sheet: Sheet, content: Sequence[PageRectangle]) -> PageRectangle:
    """Write the viewing direction of a side view; return its rectangle."""
    east, north = sheet.axes[0, :2]
    heading = round(np.degrees(heading_of(float(np.arctan2(east, -north))))) % 360
    text, style = f"side view, looking {heading:03d}°", Type(7.5, QUIET)
    width, height = canvas.extent(text, style)
    rectangle = corner(sheet.box, (width + 0.1, height + 0.06), UPPER_FIRST, content)
    canvas.polygons([rectangle.outline()], (*PAPER, 0.7))
    canvas.text(rectangle.x + 0.05, rectangle.y + 0.05, text, style)
    return rectangle


def height_marks(canvas: Canvas, sheet: Sheet, *, over_plane: bool = True) -> list[PageRectangle]:
    """Write heights along the right edge of a side view; return their rectangles.

    over_plane : the ground is the plane z = 0, so heights up to 0 need no label
    """
    box, style = sheet.box, Type(7.5, QUIET, across="right", along="center_baseline")
    step = max(1.0, round_length(0.75 / sheet.inches))
    middle = sheet.centre[1]
    most = box.height / 2 / sheet.inches
    rooms = []
    first = int(np.ceil((middle - most) / step))
    for k in range(max(1, first) if over_plane else first, int(np.floor((middle + most) / step)) + 1):
        y = float(sheet.at(np.array([0.0, k * step]))[1])
        text = f"{k * step:g} m".replace("-", "−")
        width = canvas.extent(text, style)[0]
        rectangle = PageRectangle(box.right - width - 0.18, y - 0.08, width + 0.17, 0.16)
        if box.holds(rectangle):
            canvas.polygons([rectangle.outline()], (*SKY_LOW, 0.85))
            canvas.lines([np.array([[box.right - 0.08, y], [box.right, y]])], INK, 0.8)
            canvas.text(box.right - 0.12, y, text, style)
            rooms.append(rectangle)
    return rooms
