"""Terrain on the map beside a shot's pictures: hillshade and contours on a plan, a profile on a side view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.emit.hillshade import hillshade, shades
from shotc.emit.palette import GROUND, GROUND_FAR, SKY_LOW, shade
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type
from shotc.emit.storyboard.furniture import round_length
from shotc.emit.storyboard.sheet import Sheet
from shotc.geom.bernstein import Array
from shotc.geom.surface.ground import Ground, height_at

FINE_IN = 0.05
"""Distance of the height samples of a plan, inches."""

CONTOUR_COUNT = 10
"""Approximate number of contours of a plan."""

LEAST_STEP_M = 0.5
LABELLED_EVERY = 5
"""Every LABELLED_EVERY-th contour is bold and has its height, if the plan shows at least two of them."""

MOST_LABELS = 6
LINE_PT, BOLD_PT = 0.45, 0.9
"""Widths of contours, points."""

TEXT_PT = 6.8
"""Size of the heights of contours, points."""

PROFILE_POINTS = 400
"""Samples of a profile."""

_TURN = np.array([0, 1, 2])


@dataclass(frozen=True, slots=True, eq=False)
class PlanRelief:
    """The ground that a plan shows.

    nodes : W, on a regular grid over the sheet, South first, (r, c, 3); z is NaN where there is no ground
    step : metres between contours; 0 where the ground is level
    """

    nodes: Array
    step: float

    @property
    def levels(self) -> Array:
        """Heights of the contours, z of W, shape (n,)."""
        z = self.nodes[..., 2]
        if self.step == 0.0:
            return np.zeros(0)
        first, last = np.ceil(np.nanmin(z) / self.step), np.floor(np.nanmax(z) / self.step)
        # The sum turns -0 into 0.
        return np.arange(first, last + 1) * self.step + 0.0

    @property
    def labelled(self) -> Array:
        """Heights of the bold, labelled contours, shape (n,)."""
        for every in (LABELLED_EVERY, 2):
            number = np.round(self.levels / self.step) if self.step else self.levels
            levels = self.levels[number % every == 0]
            if len(levels) >= 2:
                return np.asarray(levels)
        return self.levels

    @property
    def triangles(self) -> Array:
        """The grid's triangles with ground, (n, 3, 3)."""
        a, b = self.nodes[:-1, :-1], self.nodes[:-1, 1:]
        c, d = self.nodes[1:, 1:], self.nodes[1:, :-1]
        both = [np.stack(corners, axis=2).reshape(-1, 3, 3) for corners in ((a, b, c), (a, c, d))]
        cells = np.concatenate(both)
        return np.asarray(cells[np.isfinite(cells[..., 2]).all(axis=1)])


def relief_of(sheet: Sheet, ground: Ground) -> PlanRelief:
    """Return the ground that a plan shows."""
    half = np.array([sheet.box.width, sheet.box.height]) / 2 / sheet.inches
    columns, rows = (int(np.ceil(side / FINE_IN)) + 1 for side in (sheet.box.width, sheet.box.height))
    x = sheet.centre[0] + np.linspace(-half[0], half[0], columns)
    y = sheet.centre[1] + np.linspace(-half[1], half[1], rows)
    plan = np.stack(np.meshgrid(x, y), axis=-1)
    z = height_at(ground, plan.reshape(-1, 2)).reshape(rows, columns)
    heights = z[np.isfinite(z)]
    rise = float(np.ptp(heights)) if heights.size else 0.0
    step = max(round_length(rise / CONTOUR_COUNT), LEAST_STEP_M) if rise > LEAST_STEP_M else 0.0
    return PlanRelief(np.concatenate([plan, z[..., None]], axis=-1), step)


def draw_relief(canvas: Canvas, sheet: Sheet, relief: PlanRelief) -> None:
    """Draw hillshade and contours; the sheet is unchanged where there is no ground."""
    canvas.image(_pixels(relief), sheet.box)
    triangles, bold_levels = relief.triangles, relief.labelled
    for level in relief.levels:
        bold = level in bold_levels
        ends = contour(triangles, float(level))
        if len(ends):
            color = (*shade(GROUND, 0.45), 0.8 if bold else 0.55)
            canvas.pieces(sheet.at(ends), color, BOLD_PT if bold else LINE_PT, sheet.box)


def _pixels(relief: PlanRelief) -> np.ndarray:
    p = relief.nodes
    normals = np.cross(p[1:, 1:] - p[:-1, :-1], p[1:, :-1] - p[:-1, 1:])
    colors = shades(np.array(GROUND_FAR), hillshade(normals))
    colors[np.isnan(normals).any(axis=-1)] = SKY_LOW
    return np.round(colors[::-1] * 255).astype(np.uint8)


def contour(triangles: Array, level: float) -> Array:
    """Return the level line of triangles (n, 3, 3) at a height, as line pieces in the plan, (k, 2, 2)."""
    above = triangles[..., 2] >= level
    count = above.sum(axis=1)
    cut = (count == 1) | (count == 2)
    lone = np.where(count == 1, above.argmax(axis=1), above.argmin(axis=1))[cut]
    turned = np.take_along_axis(triangles[cut], ((lone[:, None] + _TURN) % 3)[..., None], axis=1)
    tip, others = turned[:, :1], turned[:, 1:]
    share = (level - tip[..., 2]) / (others[..., 2] - tip[..., 2])
    return np.asarray(tip[..., :2] + share[..., None] * (others[..., :2] - tip[..., :2]))


def contour_heights(
    canvas: Canvas, sheet: Sheet, relief: PlanRelief, taken: Sequence[PageRectangle], size: float = TEXT_PT
) -> list[PageRectangle]:
    """Write heights on a few contours, each in free space near the middle; return the occupied rectangles.

    size : of the text, points
    """
    rooms: list[PageRectangle] = []
    style = Type(size, shade(GROUND, 0.35), across="center", along="center_baseline", halo=GROUND_FAR)
    box, triangles = sheet.box, relief.triangles
    inner = PageRectangle(box.x + 0.05, box.y + 0.05, box.width - 0.1, box.height - 0.1)
    middle = np.array([box.x + box.width / 2, box.y + box.height / 2])
    levels = relief.labelled
    for level in levels[:: max(1, -(-len(levels) // MOST_LABELS))]:
        text = f"{level:g} m".replace("-", "−")
        width, height = canvas.extent(text, style)
        spots = sheet.at(contour(triangles, float(level))).mean(axis=1)
        for x, y in spots[np.argsort(np.linalg.norm(spots - middle, axis=1), kind="stable")]:
            rectangle = PageRectangle(float(x) - width / 2, float(y) - height / 2, width, height)
            if inner.holds(rectangle) and not any(rectangle.meets(other) for other in [*taken, *rooms]):
                canvas.text(float(x), float(y), text, style)
                rooms.append(rectangle)
                break
    return rooms


def profile(sheet: Sheet, ground: Ground, through: Array) -> Array:
    """Return the ground in the vertical plane of a side view through a place (2,), shape (n, 2).

    The columns are the position along the view and z of W, metres; z is NaN where there is no ground.
    """
    half = sheet.box.width / 2 / sheet.inches
    along = sheet.centre[0] + np.linspace(-half, half, PROFILE_POINTS)
    return profile_at(sheet.axes, ground, through, along)


def profile_at(axes: Array, ground: Ground, through: Array, along: Array) -> Array:
    """Return ``profile`` at positions (n,) along the first of two axes (2, 3), metres, shape (n, 2)."""
    direction = axes[0, :2]
    xy = through + (along - through @ direction)[:, None] * direction
    return np.column_stack([along, height_at(ground, xy)])


def draw_profile(canvas: Canvas, sheet: Sheet, line: Array) -> None:
    """Draw the ground below a profile down to the edge of the sheet.

    line : way and height of its points, (M, 2), metres; NaN where there is no ground
    """
    known = np.isfinite(line[:, 1])
    ends = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    for start, end in ends.reshape(-1, 2):
        top = sheet.at(line[start:end])
        low = np.array([[top[-1, 0], sheet.box.y], [top[0, 0], sheet.box.y]])
        canvas.polygons([np.concatenate([top, low])], GROUND, clip=sheet.box)
        canvas.lines([top], shade(GROUND, 0.6), 1.2, sheet.box)
