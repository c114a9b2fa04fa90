"""What the audience sees behind and before lights at night: sky and ground, hills, scenes and buildings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import tan

import numpy as np
from scipy.ndimage import maximum_filter

from shotc.emit.audience import Audience
from shotc.emit.hillshade import hillshade
from shotc.emit.mesh_shades import Faces, faces_of
from shotc.emit.storyboard.splats import DepthRaster, perspective, raster_of
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.surface.triangles import cross
from shotc.ir.mission import MissionIR

ZENITH, HORIZON = (0.012, 0.018, 0.045), (0.060, 0.078, 0.130)
EARTH, FAR = (0.022, 0.026, 0.028), (0.050, 0.056, 0.058)
LINE = (0.20, 0.23, 0.27)
SLOPE = (0.085, 0.102, 0.098)
"""Colour of level terrain near the eye."""
RELIEF_POWER = 2.0
"""Power of the shading of slopes, which have less contrast in the dark."""
WALL_SHARE = 0.30
"""Lightness of buildings and scenes at night, as a share of that by day."""
HAZE_M = 2500.0
"""Distance at which slopes have come nearer to the colour of the horizon by 63 %, metres."""
HIDDEN_M = 0.5
"""Least distance by which a light is behind what hides it, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Scenery:
    """The audience's picture without lights.

    seen : the audience
    colors : shape (rows, columns, 3), 0 to 1
    distance : of what stands in each pixel, from the eye, (rows, columns), metres; inf where nothing does. It
        is the largest of the pixel and its eight neighbours, so that no light at a border counts as hidden.
    """

    seen: Audience
    colors: Array
    distance: Array

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows."""
        rows, columns = self.distance.shape
        return columns, rows

    def hides(self, p: Array) -> Mask:
        """Tell which places (n, 3) of W, metres, are behind terrain, a scene or a building, (n,).

        A place outside of the picture counts as visible.
        """
        columns, rows = self.size
        offset = p - np.array(self.seen.eye)
        u, v, depth = self.seen.view(columns / rows).project((offset[:, 0], offset[:, 1], offset[:, 2]))
        inside = (depth > 0.0) & (np.abs(u) < 1.0) & (np.abs(v) < 1.0)
        column = ((np.where(inside, u, 0.0) + 1.0) / 2.0 * columns).astype(int)
        row = ((1.0 - np.where(inside, v, 0.0)) / 2.0 * rows).astype(int)
        nearer = self.distance[row, column] < np.linalg.norm(offset, axis=1) - HIDDEN_M
        return np.asarray(inside & nearer)


def scenery(mission: MissionIR, seen: Audience, size: tuple[int, int]) -> Scenery:
    """Return the audience's picture of a mission's world; size : columns, rows."""
    colors, (columns, rows) = backdrop(seen, size), size
    eye = np.array(seen.eye)
    project = perspective(seen.view(columns / rows), eye, (rows, columns))
    distance = np.full((rows, columns), np.inf)
    for faces in _standing(mission, eye):
        raster = raster_of(faces, project, (rows, columns))
        depths = np.where(raster.shown, np.linalg.norm(raster.points - eye, axis=-1), np.inf)
        nearer = depths < distance
        colors[nearer] = _hazy(raster, depths)[nearer]
        distance = np.minimum(distance, depths)
    return Scenery(seen, colors, maximum_filter(distance, 3))


def backdrop(seen: Audience, size: tuple[int, int]) -> Array:
    """Return sky and flat ground, shape (rows, columns, 3); the horizon is at the height of the eye."""
    columns, rows = size
    view = seen.view(columns / rows)
    v = 1.0 - 2.0 * (np.arange(rows) + 0.5) / rows
    horizon = -tan(seen.pitch) / float(view.half_height)
    above = np.clip((v - horizon) / 2.0, 0.0, 1.0)[:, None] ** 0.7
    below = np.clip((horizon - v) / 0.5, 0.0, 1.0)[:, None]
    sky = np.array(HORIZON) + above * (np.array(ZENITH) - np.array(HORIZON))
    earth = np.array(FAR) + below * (np.array(EARTH) - np.array(FAR))
    picture = np.where(v[:, None] >= horizon, sky, earth)
    picture[np.abs(v - horizon) < 1.0 / rows] = LINE
    return np.repeat(picture[:, None], columns, axis=1)


def _standing(mission: MissionIR, eye: Array) -> Iterator[Faces]:
    """Yield the triangles of the terrain, and those of scenes and buildings, with their colours at night."""
    if mission.terrain is not None:
        triangles = mission.terrain.ground.surface.triangles
        normals = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        up = np.where(normals[:, 2:] < 0.0, -normals, normals)
        yield Faces(triangles, np.array(SLOPE) * hillshade(up)[:, None] ** RELIEF_POWER)
    if mission.meshes:
        faces = faces_of(mission.meshes, eye)
        yield Faces(faces.triangles, WALL_SHARE * faces.colors)


def _hazy(raster: DepthRaster, depth: Array) -> Array:
    """Return the colours of a picture, hazier with the distance (rows, columns), metres."""
    clear = np.exp(-np.where(np.isfinite(depth), depth, 0.0) / HAZE_M)[..., None]
    return np.asarray(raster.colors * clear + np.array(HORIZON) * (1.0 - clear))
