"""Terrain as a camera sees it: rings around the eye, drawn from the farthest to the nearest.

A ring is divided into columns by directions that spread over the picture. The distance between rings is
proportional to their radius, so that all have about one size on screen, independent of the number of
triangles.

The ground is a height over the plan, so what is nearer in the plan is never behind what is farther. Painting
by rings is therefore the exact order. An object is painted between the rings behind it and those that hide
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shotc.emit.hillshade import hillshade, shades
from shotc.emit.palette import GROUND, GROUND_FAR
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas
from shotc.emit.storyboard.flat_ground import NEAR_M, draw_squares, squares
from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.camera import View
from shotc.geom.pieces import Mask
from shotc.geom.surface.ground import Ground, height_at

RINGS, COLUMNS = 96, 64
"""Rings and columns of a picture; a picture that shows the nadir has twice the columns, all around."""

FIRST_RING_RATIO = 0.05
"""Radius of the first ring over the height of the eye above ground."""

NADIR_HALF_FRAMES = 1.2
"""Distance of the nadir from the middle of the picture, in half pictures, up to which columns go
all around.
"""

INNERMOST_RING_M = 1e-3
"""Radius of the innermost ring if there is ground below the eye, metres."""

HAZE_RATIO = 20.0
"""Distance at which haze has taken half of the colour, over the height of the eye above ground."""

FARTHEST_HALF_FRAMES = 50.0
"""Half pictures from the middle at which positions are clipped, far outside the picture."""

SAME_SLOPE = 1e-6
LINE_PIECES = 160


@dataclass(frozen=True, slots=True, eq=False)
class Fan:
    """The ground around an eye.

    radius : of the rings, metres, ascending, (R,)
    angle : of the columns, in W, rad, ascending, (C,)
    z : of the ground at rings and columns relative to the eye, metres, (R, C); NaN where there is none
    over : height of the eye above the ground below it, metres, at least 1
    """

    radius: Array
    angle: Array
    z: Array
    over: float

    @property
    def points(self) -> Array:
        """The ground at rings and columns relative to the eye, metres, (R, C, 3)."""
        x = self.radius[:, None] * np.cos(self.angle)
        y = self.radius[:, None] * np.sin(self.angle)
        return np.stack([x, y, self.z], axis=-1)

    @property
    def horizon(self) -> Array:
        """Largest slope (rise over run) from the eye to the ground up to each ring, (R, C)."""
        slope = self.z / self.radius[:, None]
        return np.asarray(np.maximum.accumulate(np.where(np.isnan(slope), -np.inf, slope), axis=0))


def fan_of(view: PictureRectangle, ground: Ground, parts: Sequence[float] = ()) -> Fan:
    """Return the ground that a picture may show.

    parts : radii at which there must be a ring, metres
    """
    eye = np.array(view.eye)
    low, high = (box.reshape(-1, 3) for box in (ground.surface.low[-1], ground.surface.high[-1]))
    low, high = low.min(axis=0), high.max(axis=0)
    gap = np.maximum(np.maximum(low - eye, eye - high), 0.0)[:2]
    reach = float(np.hypot(*np.maximum(np.abs(low - eye), np.abs(high - eye))[:2]))
    under = float(height_at(ground, eye[None, :2])[0])
    over = max(float(eye[2]) - (float(low[2]) if np.isnan(under) else under), 1.0)
    first = min(max(FIRST_RING_RATIO * over, float(np.hypot(*gap))), reach / 2)
    rings = np.geomspace(first, reach, RINGS)
    if not gap.any():
        rings[0] = INNERMOST_RING_M  # no hole below the eye
    inner = [part for part in parts if rings[0] < part < reach]
    radius = np.unique(np.concatenate([rings, inner]))
    angle = _directions(view.camera)
    fan = Fan(radius, angle, np.zeros((len(radius), len(angle))), over)
    xy = eye[:2] + fan.points[..., :2].reshape(-1, 2)
    return replace(fan, z=height_at(ground, xy).reshape(fan.z.shape) - eye[2])


def _directions(camera: View) -> Array:
    """Return evenly spaced directions in the plan that cover a picture, angles in W, rad, shape (C,)."""
    yaw = float(np.arctan2(camera.sin_yaw, camera.cos_yaw))
    _, down, forward = camera.to_camera((0.0, 0.0, -1.0))
    if forward > 0 and abs(down) <= NADIR_HALF_FRAMES * forward * camera.half_height:
        return yaw + np.linspace(-np.pi, np.pi, 2 * COLUMNS)
    side = np.linspace(-1.0, 1.0, 17)
    u = np.concatenate([side, side, np.full(17, 1.0)]) * camera.half_width
    v = np.concatenate([np.full(17, 1.0), np.full(17, -1.0), side]) * camera.half_height
    along = camera.cos_pitch - camera.sin_pitch * v
    half = float(np.max(np.abs(np.arctan2(u, along)))) + 0.02
    return yaw + np.linspace(-1.0, 1.0, COLUMNS) * min(half, np.pi)


class FanPainter:
    """Draws a fan step by step from the farthest ring to the nearest, with a square grid on it.

    grid : width of a square, metres
    """

    def __init__(self, canvas: Canvas, view: PictureRectangle, fan: Fan, grid: float) -> None:
        self._canvas, self._shown, self._fan, self._grid = canvas, view, fan, grid
        self._top = len(fan.radius) - 1
        self._corners = _on_page(view, fan)
        self._faces = _faces(fan)
        self._lines = draped(fan, squares(view.eye, grid, LINE_PIECES))
        self._away = np.hypot(self._lines[..., 0], self._lines[..., 1])

    def draw_beyond(self, distance: float) -> None:
        """Draw the remaining ground beyond a distance in the plan, metres."""
        radius, top = self._fan.radius, self._top
        low = int(np.searchsorted(radius, distance * (1.0 - 1e-9)))
        if low >= top:
            return
        self._top = low
        rows = slice(low, top)
        corners, faces = self._corners[low : top + 1][::-1], self._faces[rows][::-1]
        self._canvas.mesh(corners, faces, self._shown.box)
        # A line piece across a ring is drawn on both sides, because the nearer ground covers half of it.
        now = (self._away.max(axis=1) > radius[low]) & (self._away.min(axis=1) <= radius[top])
        if now.any():
            draw_squares(self._canvas, self._shown, self._lines[now], self._grid)


def _on_page(view: PictureRectangle, fan: Fan) -> Array:
    """Return the page positions of rings and columns, (R, C, 2); NaN behind the camera."""
    points = fan.points
    right, down, forward = view.camera.to_camera((points[..., 0], points[..., 1], points[..., 2]))
    depth = np.where(forward > NEAR_M, forward, np.nan)
    uv = np.stack(
        [right / (depth * view.camera.half_width), -down / (depth * view.camera.half_height)], axis=-1
    )
    return view.place(np.clip(uv, -FARTHEST_HALF_FRAMES, FARTHEST_HALF_FRAMES))


def _faces(fan: Fan) -> Array:
    """Return the colours of the quads between rings and columns, (R - 1, C - 1, 3)."""
    p = np.nan_to_num(fan.points)
    light = hillshade(np.cross(p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]))
    colors = shades(np.array(GROUND), light)
    distances = 0.5 * (fan.radius[1:] + fan.radius[:-1])
    haze = (distances / (distances + HAZE_RATIO * max(fan.over, 10.0)))[:, None, None]
    return np.asarray(colors + (np.array(GROUND_FAR) - colors) * haze)


def draped(fan: Fan, lines: Array) -> Array:
    """Return line pieces (n, 2, 3) laid on the ground of a fan, without those that the ground hides.

    All are relative to the eye, metres.
    """
    at = _Cell.of(fan, lines)
    z = at.between(fan.z)
    radius = np.hypot(lines[..., 0], lines[..., 1])
    nearer = at.nearer(fan.horizon)
    with np.errstate(invalid="ignore"):
        seen = (at.inside & (z / np.maximum(radius, 1e-9) >= nearer - SAME_SLOPE)).all(axis=1)
    laid = np.concatenate([lines[..., :2], z[..., None]], axis=-1)
    return np.asarray(laid[seen])


@dataclass(frozen=True, slots=True, eq=False)
class _Cell:
    """Positions of points in a fan: the cell of a ring and a column, and shares (w, s) in it."""

    ring: IntArray
    column: IntArray
    w: Array
    s: Array
    inside: Mask

    @classmethod
    def of(cls, fan: Fan, points: Array) -> _Cell:
        radius = np.hypot(points[..., 0], points[..., 1])
        middle = 0.5 * (fan.angle[0] + fan.angle[-1])
        turn = (np.arctan2(points[..., 1], points[..., 0]) - middle + np.pi) % (2 * np.pi) - np.pi + middle
        ring = np.clip(np.searchsorted(fan.radius, radius) - 1, 0, len(fan.radius) - 2).astype(np.intp)
        column = np.clip(np.searchsorted(fan.angle, turn) - 1, 0, len(fan.angle) - 2).astype(np.intp)
        w = (radius - fan.radius[ring]) / (fan.radius[ring + 1] - fan.radius[ring])
        s = (turn - fan.angle[column]) / (fan.angle[column + 1] - fan.angle[column])
        inside = (w >= 0) & (w <= 1) & (s >= 0) & (s <= 1)
        return cls(ring, column, w, s, inside)

    def nearer(self, value: Array) -> Array:
        """Return a value (R, C), interpolated at the ring before the points."""
        a, b = value[self.ring, self.column], value[self.ring, self.column + 1]
        return np.asarray(np.where(np.isinf(a) | np.isinf(b), -np.inf, a + (b - a) * self.s))

    def between(self, value: Array) -> Array:
        """Return a value (R, C), interpolated at the points."""
        r, c, w, s = self.ring, self.column, self.w, self.s
        near = value[r, c] * (1 - s) + value[r, c + 1] * s
        return np.asarray(near * (1 - w) + (value[r + 1, c] * (1 - s) + value[r + 1, c + 1] * s) * w)
