"""Names beside things, each where there is room: under it, over it, left, right, or on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from shotc.emit.palette import WHITE, Rgb
from shotc.emit.storyboard.canvas import Box, Canvas, Type

GAP = 0.05
"""Between a thing and its name, and between a name and everything else, inches."""

FLUSH = ("over from", "over to", "under from", "under to")
MAP_SIDES = ("under", "over", "left", "right", *FLUSH, "over left", "over right", "on")


@dataclass(frozen=True, slots=True)
class Label:
    """A name, the rectangle of its thing, and the sides of that on which it may stand, best first.

    inside : whether it stands best on the thing, where that has room for it
    """

    text: str
    color: Rgb
    thing: Box
    sides: tuple[str, ...] = MAP_SIDES
    size: float = 7.5
    bold: bool = True
    inside: bool = False


def write_labels(
    canvas: Canvas, inner: Box, labels: Iterable[Label], taken: Sequence[Box], avoid: Sequence[Box] = ()
) -> None:
    """Write labels inside a rectangle, the first ones first; one that finds no room is left out.

    taken : where none may stand; avoid : where none stands that has a choice
    """
    full = list(taken)
    for label in labels:
        style = Type(label.size, label.color, label.bold, "center", "bottom", halo=WHITE)
        room = free_room(canvas.extent(label.text, style), inner, label, (full, avoid))
        if room is not None:
            canvas.text(room.x + room.width / 2, room.y, label.text, style)
            full.append(room)


def free_room(
    size: tuple[float, float], inner: Box, label: Label, others: tuple[Sequence[Box], Sequence[Box]]
) -> Box | None:
    """Return where a label of some size goes, or None; others : what is taken, and what to avoid."""
    taken, avoid = others
    width, height = size
    roomy = label.inside and label.thing.width > 1.3 * width and label.thing.height > 4 * height
    sides = ("on", *label.sides) if roomy else label.sides
    rooms = [room for side in sides if inner.holds(room := _beside(label.thing, side, size))]
    free = [room for room in rooms if not _meets(room, taken)]
    return next((room for room in free if not _meets(room, avoid)), free[0] if free else None)


def _meets(room: Box, others: Sequence[Box]) -> bool:
    # A little less than the gap to its own thing, which may be among the others.
    wide = Box(room.x - 0.9 * GAP, room.y - 0.9 * GAP, room.width + 1.8 * GAP, room.height + 1.8 * GAP)
    return any(wide.meets(other) for other in others)


def _beside(thing: Box, side: str, size: tuple[float, float]) -> Box:
    width, height = size
    x, y = thing.x + (thing.width - width) / 2, thing.y + (thing.height - height) / 2
    if "left" in side:
        x = thing.x - GAP - width
    elif "right" in side:
        x = thing.right + GAP
    elif "from" in side:
        x = thing.x
    elif "to" in side.split():
        x = thing.right - width
    if "under" in side:
        y = thing.y - GAP - height
    elif "over" in side:
        y = thing.top + GAP
    elif "top" in side:
        y = thing.top - height
    return Box(x, y, width, height)
