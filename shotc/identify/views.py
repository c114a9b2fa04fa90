"""Casts rays from cameras through boxes on their screens onto the world's triangles."""

from __future__ import annotations

from dataclasses import dataclass
from math import tan
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.camera import ScreenBox, View, view
from shotc.geom.pieces import Mask
from shotc.geom.surface.boards import Billboards
from shotc.geom.surface.hits import first_hits
from shotc.geom.surface.tree import Surface
from shotc.geom.vec import Vec2, Vec3
from shotc.ir.hiding_surfaces import DISC_SPACINGS
from shotc.ir.mission import MissionIR
from shotc.ir.terrain import ground_heights

TILE_RAYS = 8
"""Rays along each side of a tile, all of which share one search in the tree."""
SKY, GROUND = -1, -2
"""Values in place of a mesh number: a ray that hits nothing, or the ground."""
ON_GROUND_M = 0.5
"""Height above ground, up to which a hit counts as ground."""
_Kind = TypeVar("_Kind", bound=np.generic)
FRAME = ScreenBox(-1.0, 1.0, -1.0, 1.0)


@dataclass(frozen=True, slots=True)
class CameraPose:
    """A camera pose.

    eye : W, metres
    yaw, pitch, hfov : rad
    aspect : width / height
    """

    eye: Vec3
    yaw: float
    pitch: float
    hfov: float
    aspect: float

    @property
    def view(self) -> View:
        """Its direction cosines and half its screen."""
        return view(self.yaw, self.pitch, self.hfov, self.aspect)


@dataclass(frozen=True, slots=True, eq=False)
class RayHits:
    """First hits of the rays through the middles of the cells of a box on screen.

    All arrays have shape (rows, columns), the lowest row and the left column first.

    point : W, metres, shape (rows, columns, 3); NaN where nothing is hit
    mesh : number of the mesh, SKY or GROUND; a hit within ON_GROUND_M of the ground is GROUND
    triangle : index among the triangles from which the mesh was made; -1 where no mesh is hit
    footprint : width of a cell at its hit, metres
    shade : cosine of the angle between the ray and the surface normal, 0 to 1
    """

    point: Array
    mesh: IntArray
    triangle: IntArray
    footprint: Array
    shade: Array

    @property
    def solid(self) -> Mask:
        """Where a mesh is hit above the ground."""
        return np.asarray(self.mesh >= 0)


def look(mission: MissionIR, camera: CameraPose, box: ScreenBox, tiles: Vec2 | tuple[int, int]) -> RayHits:
    """Return what a camera sees of a mission's meshes and ground through a box on its screen.

    tiles : number of tiles of TILE_RAYS x TILE_RAYS rays, across and up
    """
    across, up = int(tiles[0]), int(tiles[1])
    boards = _boards(camera, box, (across, up))
    rays = _laid(_tile_rays(boards), (across, up))
    eye = np.array(camera.eye)
    first = _nearest(mission, boards, (across, up), rays)
    with np.errstate(invalid="ignore"):
        point = eye + first.depth[..., None] * rays
    met = np.isfinite(first.depth)
    point[~met] = np.nan
    low = met & (first.mesh >= 0)
    low[low] = point[low][:, 2] < ground_heights(mission, point[low][:, :2]) + ON_GROUND_M
    mesh = np.where(low, GROUND, first.mesh)
    size = _cell(camera, box, (TILE_RAYS * across, TILE_RAYS * up))
    length = np.linalg.norm(rays, axis=-1) * np.linalg.norm(first.normal, axis=-1)
    shade = np.abs((first.normal * rays).sum(axis=-1)) / np.where(length > 0.0, length, 1.0)
    return RayHits(point, mesh, first.triangle, np.where(met, first.depth, 0.0) * size, shade)


def _cell(camera: CameraPose, box: ScreenBox, cells: tuple[int, int]) -> float:
    """Return the width of a cell of a box at a depth of one metre: the larger of its sides."""
    half = tan(camera.hfov / 2)
    width = half * (box.u_max - box.u_min) / cells[0]
    return float(max(width, half / camera.aspect * (box.v_max - box.v_min) / cells[1]))


def _boards(camera: CameraPose, box: ScreenBox, tiles: tuple[int, int]) -> Billboards:
    """Return the tiles of a box at a depth of one metre, row by row; shares of a ray are then depths."""
    eyes = camera.view
    right = np.array([eyes.sin_yaw, -eyes.cos_yaw, 0.0])
    ahead = np.array([eyes.cos_pitch * eyes.cos_yaw, eyes.cos_pitch * eyes.sin_yaw, eyes.sin_pitch])
    up = np.array([-eyes.sin_pitch * eyes.cos_yaw, -eyes.sin_pitch * eyes.sin_yaw, eyes.cos_pitch])
    side = right * eyes.half_width * (box.u_max - box.u_min) / tiles[0]
    rise = up * eyes.half_height * (box.v_max - box.v_min) / tiles[1]
    eye = np.array(camera.eye)
    low = eye + ahead + right * eyes.half_width * box.u_min + up * eyes.half_height * box.v_min
    row, column = (n.ravel() for n in np.meshgrid(np.arange(tiles[1]), np.arange(tiles[0]), indexing="ij"))
    corner = low + column[:, None] * side + row[:, None] * rise
    count = len(row)
    return Billboards(np.tile(eye, (count, 1)), corner, np.tile(side, (count, 1)), np.tile(rise, (count, 1)))


def _tile_rays(boards: Billboards) -> Array:
    """Return the vector to the middle of each cell of tiles, shape (F, TILE_RAYS, TILE_RAYS, 3)."""
    middle = (np.arange(TILE_RAYS) + 0.5) / TILE_RAYS
    a, b = np.meshgrid(middle, middle, indexing="ij")
    at = (boards.corner - boards.eye)[:, None, None]
    right, up = boards.right[:, None, None], boards.up[:, None, None]
    return np.asarray(at + a[..., None] * right + b[..., None] * up)


def _laid(values: NDArray[_Kind], tiles: tuple[int, int]) -> NDArray[_Kind]:
    """Return values of tiles, (F, along right, along up, ...), as rows and columns of the box."""
    across, up = tiles
    n, rest = TILE_RAYS, values.shape[3:]
    shaped = values.reshape(up, across, n, n, *rest)
    order = (0, 3, 1, 2, *range(4, 4 + len(rest)))
    return np.asarray(shaped.transpose(order).reshape(up * n, across * n, *rest))


class _FirstHits(NamedTuple):
    """First hits: depth, mesh and triangle, (rows, columns), and normal, (rows, columns, 3)."""

    depth: Array
    mesh: IntArray
    triangle: IntArray
    normal: Array


def _nearest(mission: MissionIR, boards: Billboards, tiles: tuple[int, int], rays: Array) -> _FirstHits:
    """Return the first hit of each cell."""
    share, normal = _ground(mission, boards, tiles, rays)
    mesh = np.where(np.isfinite(share), GROUND, SKY)
    triangle = np.full(share.shape, -1, dtype=np.intp)
    for number, each in enumerate(mission.meshes):
        hits = first_hits(each.surface, boards, TILE_RAYS, DISC_SPACINGS * each.spacing)
        its_share, its_triangle = _laid(hits.share, tiles), _laid(hits.triangle, tiles)
        closer = its_share < share
        share = np.where(closer, its_share, share)
        mesh = np.where(closer, number, mesh)
        triangle[closer] = each.surface.source[its_triangle[closer]]
        normal[closer] = _normals(each.surface, its_triangle[closer], rays[closer])
    return _FirstHits(share, mesh, triangle, normal)


def _ground(
    mission: MissionIR, boards: Billboards, tiles: tuple[int, int], rays: Array
) -> tuple[Array, Array]:
    """Return depth and normal of the ground: the terrain, or the plane z = 0."""
    if mission.terrain is not None:
        surface = mission.terrain.ground.surface
        hits = first_hits(surface, boards, TILE_RAYS)
        share, triangle = _laid(hits.share, tiles), _laid(hits.triangle, tiles)
        normal = np.zeros(rays.shape)
        met = np.isfinite(share)
        normal[met] = _normals(surface, triangle[met], rays[met])
        return share, normal
    height = float(boards.eye[0, 2])
    down = (rays[..., 2] * height) < 0.0
    share = np.where(down, -height / np.where(down, rays[..., 2], 1.0), np.inf)
    return share, np.broadcast_to([0.0, 0.0, 1.0], rays.shape).copy()


def _normals(surface: Surface, triangle: IntArray, rays: Array) -> Array:
    """Return normals (K, 3) of triangles, not normalised; a point's normal is parallel to the ray."""
    corners = surface.triangles[triangle]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat = np.linalg.norm(normal, axis=1) == 0.0
    normal[flat] = rays[flat]
    return np.asarray(normal)
