"""Draws triangles as pixels: points less than a pixel apart cover each triangle, and the nearest point is
seen.

The cost of a picture is about the number of its pixels times the depth complexity, however many triangles
there are. Triangles larger than a few pixels are quartered first, and those outside the picture are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mesh_shades import Faces
from shotc.geom.bernstein import Array
from shotc.geom.camera import View
from shotc.geom.pieces import Mask
from shotc.geom.surface.triangles import highest, lowest

NEAR_M = 0.05
"""Least depth at which something is drawn, metres."""
LONGEST_PX = 48.0
"""Longest side of a triangle that is covered by points without quartering, pixels."""
LEAST_M = 0.2
"""Longest side of a triangle that is partly behind the eye, metres."""
STEP_PX = 0.7
"""Largest distance between neighbouring points of a triangle, pixels."""
POINTS_AT_ONCE = 1_000_000
"""Most points that are made in one batch."""
BLOCK_TRIANGLES = 64
"""Consecutive (and thus neighbouring) triangles that are culled together."""
_CORNERS = tuple((i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1))
EDGE_BRIGHTNESS_RATIO = 0.82
"""Lightness of a pixel beside one that is much nearer."""
NEARER_SHARE = 0.06
"""Share of a pixel's distance by which its neighbour has to be nearer to count as much nearer."""


@dataclass(frozen=True, slots=True, eq=False)
class OnPage:
    """Points in a picture.

    at : shape (..., 2), columns and rows of pixels, rows from the top
    depth : shape (...), smaller is nearer; inf where a point is not in front of the picture
    beyond : shape (..., n), whether a point is outside each of the n planes of the view frustum
    """

    at: Array
    depth: Array
    beyond: Mask


Project = Callable[[Array], OnPage]
"""Takes points (..., 3) in W, metres."""


def perspective(camera: View, eye: Array, size: tuple[int, int]) -> Project:
    """Return the projection onto the pixels of a camera's picture.

    eye : shape (3,), W, metres; size : rows, columns
    """
    rows, columns = size
    half_width, half_height = float(camera.half_width), float(camera.half_height)

    def project(p: Array) -> OnPage:
        d = p - eye
        right, down, ahead = camera.to_camera((d[..., 0], d[..., 1], d[..., 2]))
        depth = np.where(ahead > NEAR_M, ahead, np.inf)
        safe = np.where(ahead > NEAR_M, ahead, 1.0)
        column = 0.5 * columns * (1.0 + right / safe / half_width)
        row = 0.5 * rows * (1.0 + down / safe / half_height)
        aside, above = half_width * ahead, half_height * ahead
        beyond = [right > aside, right < -aside, down > above, down < -above, ahead <= NEAR_M]
        return OnPage(np.stack([column, row], axis=-1), np.asarray(depth), np.stack(beyond, axis=-1))

    return project


@dataclass(frozen=True, slots=True, eq=False)
class DepthRaster:
    """The nearest point of each pixel.

    colors : shape (rows, columns, 3), 0 to 1
    points : W, metres, (rows, columns, 3); NaN where there is none
    """

    colors: Array
    points: Array

    @property
    def shown(self) -> Mask:
        """Whether a pixel shows something, (rows, columns)."""
        return ~np.isnan(self.points[..., 0])

    def pixels(self, which: Mask) -> NDArray[np.uint8]:
        """Return the selected pixels as bytes (rows, columns, 4); the others are transparent."""
        out = np.zeros((*which.shape, 4), dtype=np.uint8)
        out[..., :3] = np.round(255.0 * self.colors)
        out[..., 3] = np.where(which & self.shown, 255, 0)
        return out


def raster_of(faces: Faces, project: Project, size: tuple[int, int]) -> DepthRaster:
    """Return the picture of triangles, of size (rows, columns)."""
    rows, columns = size
    count = rows * columns
    pixels = _Pixels(np.full(count, np.inf), np.zeros((count, 3)), np.full((count, 3), np.nan))
    small = _small(faces, project)
    page = project(small.triangles)
    sides = np.linalg.norm(page.at - page.at[:, [1, 2, 0]], axis=2).max(axis=1)
    cuts = np.maximum(1, np.ceil(np.nan_to_num(sides, posinf=LONGEST_PX) / STEP_PX)).astype(int)
    for cut in np.unique(cuts):
        share = _shares(int(cut))
        own = np.flatnonzero(cuts == cut)
        for some in np.array_split(own, 1 + len(own) * len(share) // POINTS_AT_ONCE):
            a, b, c = (small.triangles[some, k, None] for k in range(3))
            # einsum takes three times as long for such short sums.
            p = (share[:, :1] * a + share[:, 1:2] * b + share[:, 2:] * c).reshape(-1, 3)
            tint = np.repeat(small.colors[some], len(share), axis=0)
            _put(project(p), p, tint, pixels, size)
    depth = pixels.depth.reshape(size)
    lined = pixels.colors.reshape(rows, columns, 3) * _edges(depth)[..., None]
    return DepthRaster(lined, pixels.points.reshape(rows, columns, 3))


def _small(faces: Faces, project: Project) -> Faces:
    """Return the potentially visible triangles, none longer than LONGEST_PX."""
    within = _in_view(faces.triangles, project)
    triangles, colors = faces.triangles[within], faces.colors[within]
    finished = [Faces(triangles[:0], colors[:0])]
    while len(triangles):
        page = project(triangles)
        seen = ~np.any(np.all(page.beyond, axis=1), axis=1)
        before = np.isfinite(page.depth).all(axis=1)
        sides = np.linalg.norm(page.at - page.at[:, [1, 2, 0]], axis=2).max(axis=1)
        edges = np.linalg.norm(triangles - triangles[:, [1, 2, 0]], axis=2).max(axis=1)
        large = seen & np.where(before, sides > LONGEST_PX, edges > LEAST_M)
        keep = seen & ~large
        finished.append(Faces(triangles[keep], colors[keep]))
        triangles, colors = _quartered(triangles[large]), np.tile(colors[large], (4, 1))
    return Faces(
        np.concatenate([some.triangles for some in finished]),
        np.concatenate([some.colors for some in finished]),
    )


def _in_view(triangles: Array, project: Project) -> Mask:
    """Return which triangles are in a potentially visible bounding box of BLOCK_TRIANGLES consecutive
    triangles, (N,).
    """
    if not len(triangles):
        return np.zeros(0, dtype=bool)
    starts = np.arange(0, len(triangles), BLOCK_TRIANGLES)
    ends = np.stack(
        [
            np.minimum.reduceat(lowest(triangles), starts, axis=0),
            np.maximum.reduceat(highest(triangles), starts, axis=0),
        ]
    )
    corners = np.stack([ends[[i, j, k], :, [0, 1, 2]].T for i, j, k in _CORNERS], axis=1)
    seen = ~np.any(np.all(project(corners).beyond, axis=1), axis=1)
    return np.repeat(seen, BLOCK_TRIANGLES)[: len(triangles)]


def _quartered(triangles: Array) -> Array:
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _shares(cut: int) -> Array:
    """Return the barycentric weights of points in a triangle with each side divided into ``cut``, (S, 3)."""
    i, j = np.meshgrid(np.arange(cut + 1), np.arange(cut + 1), indexing="ij")
    inside = i + j <= cut
    i, j = i[inside], j[inside]
    return np.asarray(np.column_stack([i, j, cut - i - j]) / cut)


class _Pixels(NamedTuple):
    """Depths (P,), colours (P, 3) and points (P, 3) of pixels, row by row."""

    depth: Array
    colors: Array
    points: Array


def _put(page: OnPage, p: Array, tint: Array, pixels: _Pixels, size: tuple[int, int]) -> None:
    """Write points into the pixels in which they are the nearest so far."""
    rows, columns = size
    column, row = page.at[:, 0], page.at[:, 1]
    ok = np.flatnonzero(
        np.isfinite(page.depth) & (column >= 0.0) & (column < columns) & (row >= 0.0) & (row < rows)
    )
    pixel, depth = row[ok].astype(int) * columns + column[ok].astype(int), page.depth[ok]
    nearer = depth < pixels.depth[pixel]
    ok, pixel, depth = ok[nearer], pixel[nearer], depth[nearer]
    # The last point written to a pixel stays. The order makes it the nearest, and the first of equally near
    # ones.
    order = np.argsort(depth, kind="stable")[::-1]
    last = np.full(rows * columns, -1)
    last[pixel[order]] = order
    last = last[last >= 0]
    pixels.depth[pixel[last]] = depth[last]
    pixels.colors[pixel[last]] = tint[ok[last]]
    pixels.points[pixel[last]] = p[ok[last]]


def _edges(depth: Array) -> Array:
    """Return the lightness of pixels: darker beside much nearer pixels and beside empty ones."""
    light = np.ones_like(depth)
    for axis in (0, 1):
        for step in (1, -1):
            beside = np.roll(depth, step, axis=axis)
            finite = np.isfinite(depth)
            near = np.where(finite, depth, 0.0) * (1.0 - NEARER_SHARE)
            light[finite & ((beside < near) | np.isinf(beside))] = EDGE_BRIGHTNESS_RATIO
    return light
