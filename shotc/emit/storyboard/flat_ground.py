"""Flat ground as a camera sees it, with a square grid, and the sky above."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shotc.emit.palette import GROUND, GROUND_FAR, SKY, SKY_LOW, Rgb, shade
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas
from shotc.geom.bernstein import Array
from shotc.geom.vec import Vec3

REACH_SQUARES, FADE_STEPS = 30, 12
"""Squares from the camera to the edge of the grid, and steps in which it fades."""

NEAR_M = 0.05
"""Least depth at which the grid is drawn, metres."""


def draw_flat(canvas: Canvas, view: PictureRectangle, grid: float) -> None:
    """Draw the sky, and the plane z = 0 with its grid.

    grid : width of a square, metres
    """
    draw_sky(canvas, view)
    horizon = view.horizon
    if horizon > -1:
        _bands(canvas, view, (horizon, -1.0), GROUND_FAR, GROUND)
        level = np.array([[-1.0, min(horizon, 1.0)], [1.0, min(horizon, 1.0)]])
        canvas.lines([view.place(level)], shade(GROUND, 0.72), 0.9, view.box)
    draw_squares(canvas, view, squares(view.eye, grid), grid)


def draw_sky(canvas: Canvas, view: PictureRectangle, below: Rgb = SKY) -> None:
    """Draw the sky above the horizon.

    below : colour of what is below the horizon
    """
    canvas.polygons([view.box.outline()], below)
    if view.horizon < 1:
        _bands(canvas, view, (view.horizon, 1.0), SKY_LOW, SKY)


def _bands(canvas: Canvas, view: PictureRectangle, span: tuple[float, float], first: Rgb, last: Rgb) -> None:
    # A gradient away from the horizon, over one screen height, in thin bands.
    edges = span[0] + np.linspace(0.0, 1.0, 13) ** 1.5 * (2.0 if span[1] > 0 else -2.0)
    edges[-1] = span[1] * 40.0
    strips, colors = [], []
    for i, (a, b) in enumerate(pairwise(edges)):
        strips.append(view.place(np.array([[-1.0, a], [1.0, a], [1.0, b], [-1.0, b]])))
        share = i / 11
        colors.append(tuple(p + (q - p) * share for p, q in zip(first, last, strict=True)))
    canvas.polygons(strips, colors, colors, 0.3, view.box)


def squares(eye: Vec3, grid: float, pieces: int = 40) -> Array:
    """Return the grid lines around an eye, cut into pieces, relative to the eye, metres, (n, 2, 3).

    grid : width of a square, metres
    pieces : pieces of a line, which are short near the eye so that they can fade
    """
    reach = REACH_SQUARES * grid
    centre = np.round(np.array(eye[:2]) / grid) * grid
    across = np.arange(-REACH_SQUARES, REACH_SQUARES + 1) * grid
    share = np.linspace(-1, 1, pieces + 1)
    along = np.sign(share) * share**2 * reach
    lines = []
    for axis in (0, 1):
        points = np.zeros((len(across), len(along), 3))
        points[..., axis] = centre[axis] + across[:, None]
        points[..., 1 - axis] = centre[1 - axis] + along[None, :]
        lines.append(points)
    ground = np.concatenate(lines) - np.array(eye)
    return np.stack([ground[:, :-1], ground[:, 1:]], axis=2).reshape(-1, 2, 3)


def draw_squares(canvas: Canvas, view: PictureRectangle, pieces: Array, grid: float) -> None:
    """Draw pieces of the grid lines, relative to the eye, metres, (n, 2, 3); distant ones are fainter."""
    reach = REACH_SQUARES * grid
    right, down, forward = view.camera.to_camera((pieces[..., 0], pieces[..., 1], pieces[..., 2]))
    seen = (forward > NEAR_M).all(axis=1)
    uv = np.stack(
        [
            right[seen] / (forward[seen] * view.camera.half_width),
            -down[seen] / (forward[seen] * view.camera.half_height),
        ],
        axis=-1,
    )
    far = np.hypot(pieces[seen][..., 0], pieces[seen][..., 1]).mean(axis=1) / reach
    inside = (uv.min(axis=1) < 1).all(axis=1) & (uv.max(axis=1) > -1).all(axis=1) & (far < 1)
    if not inside.any():
        return
    ends = view.place(uv[inside])
    strength = np.ceil(FADE_STEPS * (1 - far[inside]) ** 2)
    for level in np.unique(strength):
        color = (*shade(GROUND, 0.66), 0.5 * float(level) / FADE_STEPS)
        canvas.pieces(ends[strength == level], color, 0.6, view.box)
