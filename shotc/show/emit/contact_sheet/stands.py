"""The pictures of a display on the map: an outline in its own colour for each, with its number."""

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
"""Distance of an outline from the lights, inches, so that flat pictures have an outline, too."""

FINE_IN = 0.04
"""Distance of points on an outline, inches."""

APART_IN = 0.25
"""Distance from all other outlines, above which all places on an outline are equally good, inches."""

FACE_SHARE = 0.28
"""Sum of the opacities of all outlines' insides."""

CELL_IN = 0.12
"""Width of the squares that represent an outline's inside, inches."""


def color_of(index: int) -> Rgb:
    """Return the colour of a display's picture by its index on the sheet."""
    return PICTURES[index % len(PICTURES)]


def number(canvas: Canvas, at: tuple[float, float], index: int) -> None:
    """Draw the number of a picture on a disc of its colour."""
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
        lit_places = at[lit[:, k], k] if lit[:, k].any() else at[:, k]
        spread = (lit_places[:, None] + corners).reshape(-1, 2)
        shapes.append(np.array(convex_hull(tuple((float(x), float(y)) for x, y in spread))))
    return shapes


def draw_stands(
    canvas: Canvas, sheet: Sheet, shapes: Sequence[Array], taken: Sequence[PageRectangle]
) -> list[PageRectangle]:
    """Draw outlines with their numbers beside them; return the rectangles of the numbers.

    A number is outside all outlines if there is room.

    shapes : outlines on the sheet, (K, 2) each, inches
    taken : rectangles that numbers must not overlap
    """
    for k, shape in enumerate(shapes):
        canvas.polygons([shape], (*color_of(k), FACE_SHARE / max(len(shapes), 4)), clip=sheet.box)
    # The longest outline is drawn first, so that coinciding parts of others stay visible.
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
        spots = (nearest_room(size, inner, thing, full, 0.02) for full in tries)
        spot = next((one for one in spots if one is not None), _square(anchor, NUMBER_IN))
        leader(canvas, spot, thing, color_of(k))
        rooms.append(spot)
    for k, spot in enumerate(rooms):
        number(canvas, (spot.x + NUMBER_IN, spot.y + NUMBER_IN), k)
    return rooms


def anchors(shapes: Sequence[Array]) -> list[Array]:
    """Return the place (2,) on each outline (K, 2) to which its number leads: far from other outlines, else
    spread around.
    """
    edges = [_fine(shape) for shape in shapes]
    anchors = []
    middle = np.concatenate(edges).mean(axis=0)
    for k, edge in enumerate(edges):
        others = [other for i, other in enumerate(edges) if i != k]
        distances = cKDTree(np.concatenate(others)).query(edge)[0] if others else np.full(len(edge), APART_IN)
        out = edge - middle
        turn = 2.0 * pi * k / len(edges)
        towards = (out @ [np.sin(turn), np.cos(turn)]) / max(float(np.linalg.norm(out, axis=1).max()), 1e-9)
        anchors.append(edge[int(np.argmax(np.minimum(distances, APART_IN) / APART_IN + 0.1 * towards))])
    return anchors


def _fine(shape: Array) -> Array:
    """Return points along a closed outline, ``FINE_IN`` apart, shape (M, 2)."""
    parts = []
    for start, end in zip(shape, np.roll(shape, -1, axis=0), strict=True):
        count = max(1, int(np.linalg.norm(end - start) / FINE_IN))
        parts.append(start + np.arange(count)[:, None] / count * (end - start))
    return np.concatenate(parts)


def _length(line: Array) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def _inside(shape: Array) -> Array:
    """Return points inside a convex, counter-clockwise outline, ``CELL_IN`` apart along both axes, (M, 2)."""
    low, high = shape.min(axis=0), shape.max(axis=0)
    x, y = (np.arange(low[i] + CELL_IN / 2, high[i], CELL_IN) for i in (0, 1))
    at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return at[in_convex(shape, at)]


def _squares(points: Sequence[Array], width: float) -> list[PageRectangle]:
    """Return the grid squares of the page that contain points, once each."""
    cells = np.unique(np.round(np.concatenate(points) / width), axis=0)
    return [_square(at * width, width / 2) for at in cells]


def _square(at: Array, half: float) -> PageRectangle:
    return PageRectangle(float(at[0]) - half, float(at[1]) - half, 2 * half, 2 * half)
