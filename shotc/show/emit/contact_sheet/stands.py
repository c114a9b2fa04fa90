"""Where each picture of a display stands on the map: an outline in its own colour, with its number."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np
from scipy.spatial import cKDTree

from shotc.emit.palette import PICTURES, WHITE, Rgb
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type
from shotc.emit.storyboard.labels import leader, nearest_room
from shotc.emit.storyboard.sheet import Sheet
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.geom.solid_arrays.points import in_convex
from shotc.geom.solids import convex_hull
from shotc.ir.light_colors import lit_drones
from shotc.show.emit.contact_sheet.moments import Board

NUMBER_IN = 0.095
"""Radius of a picture's number, inches."""

BODY_IN = 0.03
"""How far an outline is from the lights, so that flat pictures have one, too, inches."""

FINE_IN = 0.04
"""Between two points of an outline, inches."""

APART_IN = 0.25
"""Distance from all other outlines beyond which a place on an outline is as good as any, inches."""

FACE_SHARE = 0.28
"""How much of its colour the insides of all outlines have together, of 1."""

CELL_IN = 0.12
"""Width of the squares of which an outline's inside is made, inches."""


def color_of(index: int) -> Rgb:
    """Return the colour of a display's picture, by its place on the sheet."""
    return PICTURES[index % len(PICTURES)]


def number(canvas: Canvas, at: tuple[float, float], index: int) -> None:
    """Draw the number of a picture, by its place on the sheet, on a disc of its colour."""
    canvas.disc(at, NUMBER_IN, color_of(index), WHITE, 0.8)
    canvas.text(*at, str(index + 1), Type(7.5, WHITE, True, "center", "center_baseline"))


def outlines(board: Board, sheet: Sheet) -> list[Array]:
    """Return the outline of each picture's lights on the page, (k, 2) inches, in the order of the sheet."""
    times = np.array([moment.time for moment in board.moments])
    at = sheet.place(places(board.flight.breaks, board.flight.coef, times))
    lit = lit_drones(board.flight, times)
    corners = BODY_IN * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    shapes = []
    for k in range(len(times)):
        shown = at[lit[:, k], k] if lit[:, k].any() else at[:, k]
        spread = (shown[:, None] + corners).reshape(-1, 2)
        shapes.append(np.array(convex_hull(tuple((float(x), float(y)) for x, y in spread))))
    return shapes


def draw_stands(
    canvas: Canvas, sheet: Sheet, shapes: Sequence[Array], taken: Sequence[PageRectangle]
) -> list[PageRectangle]:
    """Draw outlines and their numbers beside them; return the room that numbers and their lines take.

    taken : where no number may stand; it stands outside all outlines where there is room
    """
    for k, shape in enumerate(shapes):
        canvas.polygons([shape], (*color_of(k), FACE_SHARE / max(len(shapes), 4)), clip=sheet.box)
    # The longest first: what coincides with a part of it stays to be seen.
    closed = [np.concatenate([shape, shape[:1]]) for shape in shapes]
    for k in sorted(range(len(shapes)), key=lambda k: -_length(closed[k])):
        canvas.lines([closed[k]], color_of(k), 1.3, sheet.box)
    rims = _squares([_fine(shape) for shape in shapes], FINE_IN)
    inside = _squares([_inside(shape) for shape in shapes], CELL_IN)
    box, rooms = sheet.box, list[PageRectangle]()
    inner = PageRectangle(box.x + 0.03, box.y + 0.03, box.width - 0.06, box.height - 0.06)
    size = (2 * NUMBER_IN, 2 * NUMBER_IN)
    for k, anchor in enumerate(anchors(shapes)):
        thing = _square(anchor, 0.0)
        tries = ([*taken, *rooms, *rims, *inside], [*taken, *rooms, *rims], rooms)
        found = (nearest_room(size, inner, thing, full, 0.02) for full in tries)
        spot = next((one for one in found if one is not None), _square(anchor, NUMBER_IN))
        leader(canvas, spot, thing, color_of(k))
        rooms.append(spot)
    for k, spot in enumerate(rooms):
        number(canvas, (spot.x + NUMBER_IN, spot.y + NUMBER_IN), k)
    return rooms


def anchors(shapes: Sequence[Array]) -> list[Array]:
    """Return the place on each outline to which its number leads: where no other is near, or all round."""
    edges = [_fine(shape) for shape in shapes]
    found = []
    middle = np.concatenate(edges).mean(axis=0)
    for k, edge in enumerate(edges):
        others = [other for i, other in enumerate(edges) if i != k]
        away = cKDTree(np.concatenate(others)).query(edge)[0] if others else np.full(len(edge), APART_IN)
        out = edge - middle
        turn = 2.0 * pi * k / len(edges)
        towards = (out @ [np.sin(turn), np.cos(turn)]) / max(float(np.linalg.norm(out, axis=1).max()), 1e-9)
        found.append(edge[int(np.argmax(np.minimum(away, APART_IN) / APART_IN + 0.1 * towards))])
    return found


def _fine(shape: Array) -> Array:
    """Return points along a closed outline, ``FINE_IN`` apart."""
    parts = []
    for start, end in zip(shape, np.roll(shape, -1, axis=0), strict=True):
        count = max(1, int(np.linalg.norm(end - start) / FINE_IN))
        parts.append(start + np.arange(count)[:, None] / count * (end - start))
    return np.concatenate(parts)


def _length(line: Array) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def _inside(shape: Array) -> Array:
    """Return points in a convex outline, counter-clockwise, ``CELL_IN`` apart along both axes."""
    low, high = shape.min(axis=0), shape.max(axis=0)
    x, y = (np.arange(low[i] + CELL_IN / 2, high[i], CELL_IN) for i in (0, 1))
    at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return at[in_convex(shape, at)]


def _squares(points: Sequence[Array], width: float) -> list[PageRectangle]:
    """Return the squares of a grid on the page in which points are, each once."""
    cells = np.unique(np.round(np.concatenate(points) / width), axis=0)
    return [_square(at * width, width / 2) for at in cells]


def _square(at: Array, half: float) -> PageRectangle:
    return PageRectangle(float(at[0]) - half, float(at[1]) - half, 2 * half, 2 * half)
