"""Scenes and buildings in the storyboard's pictures and maps."""

from __future__ import annotations

import numpy as np

from shotc.emit.hillshade import shades
from shotc.emit.mesh_shades import Faces, faces_of
from shotc.emit.palette import STONE
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas
from shotc.emit.storyboard.sheet import Sheet
from shotc.emit.storyboard.splats import OnPage, perspective, raster_of
from shotc.geom.bernstein import Array
from shotc.geom.surface.triangles import TINY_SQUARE, cross
from shotc.ir.mission import MissionIR

PIXELS_PER_IN = 165.0
FAR_M = 1e5
"""Distance of a map's eye from W's origin, metres."""
UPRIGHT_BRIGHTNESS_RATIO = 0.75
"""Lightness on a map of a face that is seen edge-on."""
DISTANCE_BANDS = 24
"""Number of distances at which painting alternates between terrain and meshes."""


class MeshPainter:
    """Draws the meshes of a mission into a picture step by step, from far to near."""

    def __init__(self, canvas: Canvas, camera_view: PictureRectangle, mission: MissionIR) -> None:
        self._canvas, self._shown = canvas, camera_view
        eye = np.array(camera_view.eye)
        size = (_size(camera_view.box.height), _size(camera_view.box.width))
        self._raster = raster_of(
            faces_of(mission.meshes, eye), perspective(camera_view.camera, eye, size), size
        )
        apart = self._raster.points[..., :2] - eye[:2]
        self._away = np.nan_to_num(np.hypot(apart[..., 0], apart[..., 1]), nan=-1.0)
        self._drawn = np.inf

    @property
    def bands(self) -> list[float]:
        """Distances in the plan from the nearest to the farthest visible point, metres."""
        seen = self._away[self._away > 0.0]
        return list(np.geomspace(seen.min(), seen.max(), DISTANCE_BANDS)) if seen.size else []

    def draw_beyond(self, distance: float) -> None:
        """Draw the remaining meshes beyond a distance in the plan, metres."""
        now = (self._away >= distance) & (self._away < self._drawn)
        self._drawn = min(self._drawn, distance)
        if now.any():
            self._canvas.image(self._raster.pixels(now), self._shown.box)


def _size(inches: float) -> int:
    return max(1, round(inches * PIXELS_PER_IN))


def draw_on_map(canvas: Canvas, sheet: Sheet, mission: MissionIR) -> None:
    """Draw the meshes of a mission on a plan or on a side view."""
    if not mission.meshes:
        return
    box = sheet.box
    size = (_size(box.height), _size(box.width))
    right, up = sheet.axes
    ahead = np.cross(up, right)

    def project(p: Array) -> OnPage:
        place = sheet.place(p)
        column, row = (
            (place[..., 0] - box.x) / box.width * size[1],
            (box.top - place[..., 1]) / box.height * size[0],
        )
        beyond = [column < 0.0, column > size[1], row < 0.0, row > size[0]]
        return OnPage(np.stack([column, row], axis=-1), FAR_M + p @ ahead, np.stack(beyond, axis=-1))

    faces = faces_of(mission.meshes, -FAR_M * ahead)
    a, b, c = (faces.triangles[:, k] for k in range(3))
    normal = cross(b - a, c - a)
    across = np.abs(normal @ ahead) / np.maximum(np.linalg.norm(normal, axis=1), TINY_SQUARE)
    flat = Faces(
        faces.triangles,
        shades(np.array(STONE), UPRIGHT_BRIGHTNESS_RATIO + (1.0 - UPRIGHT_BRIGHTNESS_RATIO) * across),
    )
    raster = raster_of(flat, project, size)
    canvas.image(raster.pixels(raster.shown), box)
