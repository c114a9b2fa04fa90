"""Labels beside objects, each where there is room: below, above, left, right, or on the object."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from shotc.emit.palette import WHITE, Rgb
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type

GAP_IN = 0.05
"""Distance of a label from its object and from everything else, inches."""

STEP_IN = 0.04
"""Step of the search for a free place away from the object, inches."""

FLUSH = ("over from", "over to", "under from", "under to")
MAP_SIDES = ("under", "over", "left", "right", *FLUSH, "over left", "over right", "on")


@dataclass(frozen=True, slots=True)
class MapLabel:
    """A label, the rectangle of its object, and the allowed sides, best first.

    inside : whether its best place is on the object, if that is large enough
    """

    text: str
    color: Rgb
    thing: PageRectangle
    sides: tuple[str, ...] = MAP_SIDES
    size: float = 7.5
    bold: bool = True
    inside: bool = False


def write_labels(
    canvas: Canvas,
    inner: PageRectangle,
    labels: Iterable[MapLabel],
    taken: Sequence[PageRectangle],
    avoid: Sequence[PageRectangle] = (),
) -> list[str]:
    """Write labels inside a rectangle in their order; return the names that have no room.

    A label is placed beside its object, or else in the nearest free place with a line to its object.

    taken : rectangles that labels must not overlap
    avoid : rectangles that labels do not overlap if there is another place
    """
    full, lost = list(taken), []
    for label in labels:
        style = Type(label.size, label.color, label.bold, "center", "bottom", halo=WHITE)
        size = canvas.extent(label.text, style)
        rectangle = free_room(size, inner, label, (full, avoid))
        if rectangle is None and (rectangle := nearest_room(size, inner, label.thing, full)) is not None:
            leader(canvas, rectangle, label.thing, label.color)
        if rectangle is None:
            lost.append(label.text)
            continue
        canvas.text(rectangle.x + rectangle.width / 2, rectangle.y, label.text, style)
        full.append(rectangle)
    return lost


def nearest_room(
    size: tuple[float, float],
    inner: PageRectangle,
    thing: PageRectangle,
    taken: Sequence[PageRectangle],
    gap: float = GAP_IN,
) -> PageRectangle | None:
    """Return the nearest free place of some size to an object, or None.

    gap : distance from what is taken, inches
    """
    width, height = size
    across = np.arange(inner.x, inner.right - width + 1e-9, STEP_IN)
    up = np.arange(inner.y, inner.top - height + 1e-9, STEP_IN)
    x, y = (axis.ravel() for axis in np.meshgrid(across, up))
    free = np.ones(len(x), dtype=np.bool_)
    for other in taken:
        clear = (x >= other.right + gap) | (x + width <= other.x - gap)
        free &= clear | (y >= other.top + gap) | (y + height <= other.y - gap)
    if not free.any():
        return None
    off = np.hypot(
        np.maximum(np.maximum(thing.x - (x + width), x - thing.right), 0.0),
        np.maximum(np.maximum(thing.y - (y + height), y - thing.top), 0.0),
    )
    # A small penalty prefers, among equally near places, the one most in line with the object.
    off += 1e-3 * np.hypot(x + width / 2 - _middle(thing)[0], y + height / 2 - _middle(thing)[1])
    best = int(np.argmin(np.where(free, off, np.inf)))
    return PageRectangle(float(x[best]), float(y[best]), width, height)


def leader(canvas: Canvas, rectangle: PageRectangle, thing: PageRectangle, color: Rgb) -> None:
    """Draw the line from a label to its object, between their nearest points."""
    x, y = _middle(thing)
    start = min(max(x, rectangle.x), rectangle.right), min(max(y, rectangle.y), rectangle.top)
    end = min(max(start[0], thing.x), thing.right), min(max(start[1], thing.y), thing.top)
    canvas.lines([np.array([start, end])], (*WHITE, 0.9), 2.0)
    canvas.lines([np.array([start, end])], color, 0.8)


def _middle(box: PageRectangle) -> tuple[float, float]:
    return box.x + box.width / 2, box.y + box.height / 2


def free_room(
    size: tuple[float, float],
    inner: PageRectangle,
    label: MapLabel,
    others: tuple[Sequence[PageRectangle], Sequence[PageRectangle]],
) -> PageRectangle | None:
    """Return the place of a label of some size, or None.

    others : taken rectangles, and rectangles to avoid
    """
    taken, avoid = others
    width, height = size
    roomy = label.inside and label.thing.width > 1.3 * width and label.thing.height > 4 * height
    sides = ("on", *label.sides) if roomy else label.sides
    rooms = [rectangle for side in sides if inner.holds(rectangle := _beside(label.thing, side, size))]
    free = [rectangle for rectangle in rooms if not _meets(rectangle, taken)]
    return next((rectangle for rectangle in free if not _meets(rectangle, avoid)), free[0] if free else None)


def _meets(rectangle: PageRectangle, others: Sequence[PageRectangle]) -> bool:
    # The distance is a little less than the label's gap from its own object, which may be among the others.
    wide = PageRectangle(
        rectangle.x - 0.9 * GAP_IN,
        rectangle.y - 0.9 * GAP_IN,
        rectangle.width + 1.8 * GAP_IN,
        rectangle.height + 1.8 * GAP_IN,
    )
    return any(wide.meets(other) for other in others)


def _beside(thing: PageRectangle, side: str, size: tuple[float, float]) -> PageRectangle:
    width, height = size
    x, y = thing.x + (thing.width - width) / 2, thing.y + (thing.height - height) / 2
    if "left" in side:
        x = thing.x - GAP_IN - width
    elif "right" in side:
        x = thing.right + GAP_IN
    elif "from" in side:
        x = thing.x
    elif "to" in side.split():
        x = thing.right - width
    if "under" in side:
        y = thing.y - GAP_IN - height
    elif "over" in side:
        y = thing.top + GAP_IN
    elif "top" in side:
        y = thing.top - height
    return PageRectangle(x, y, width, height)
