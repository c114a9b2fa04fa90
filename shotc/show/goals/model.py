"""Places meshes and point clouds: gives points of their volumes, of their surfaces, or the cloud's own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors
from shotc.show.geom.columns import (
    Columns,
    candidates,
    column_at,
    columns_below,
    drawn,
    spans,
    through_triangles,
)
from shotc.show.goals.body import Fill
from shotc.show.goals.model_file import ModelMesh

COLUMNS_PER_POINT = 0.25
"""Vertical lines (columns) drawn for each point."""
MOST_PAIRS = 20_000_000
"""Most pairs of a column and a face whose bounding box it crosses; for more, fewer columns are drawn."""


@dataclass(frozen=True, slots=True, eq=False)
class CloudBody:
    """A point cloud, as read from a file."""

    mesh: ModelMesh

    def draw(self, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
        """Return its points (M, 3), or a random selection if there are more than ``count``."""
        points = self.mesh.corners
        if len(points) <= count:
            return points
        return points[np.sort(rng.choice(len(points), count, replace=False))]

    def encloses(self, place: Array) -> bool:
        """Return False for a place (3,): a point cloud has no inside."""
        return False

    def colors(self, places: Array) -> Colors | None:
        """Return the colours of the points nearest to places (M, 3)."""
        return _nearest_colors(self.mesh, places)


@dataclass(frozen=True, slots=True, eq=False)
class MeshBody:
    """A triangle mesh; parity : whether its faces are not oriented consistently, so that crossings are only
    counted.
    """

    mesh: ModelMesh
    parity: bool

    def draw(self, fill: Fill, count: int, rng: np.random.Generator) -> Array | None:
        """Return points (M, 3) of the volume or of the surface, None for the outline: a mesh has no drawn
        edges.
        """
        if fill == "outline":
            return None
        corners = self.mesh.corners[self.mesh.triangles]
        if fill == "surface":
            return _on_surface(corners, count, rng)
        columns = _affordable(corners, round(COLUMNS_PER_POINT * count), rng)
        inside = spans(through_triangles(columns, corners), self.parity)
        if not len(inside.low) or not (inside.high - inside.low).sum() > 0:
            return None
        return drawn(columns, inside, count, rng)

    def encloses(self, place: Array) -> bool:
        """Tell whether a place (3,) is inside, if the mesh has an inside."""
        corners = self.mesh.corners[self.mesh.triangles]
        inside = spans(through_triangles(column_at(place[:2]), corners), self.parity)
        return bool(np.any((inside.low < place[2]) & (place[2] < inside.high)))

    def colors(self, places: Array) -> Colors | None:
        """Return the colours of the corners nearest to places (M, 3)."""
        return _nearest_colors(self.mesh, places)


def mesh_body(mesh: ModelMesh) -> MeshBody | CloudBody:
    """Return the body of a mesh, or of a point cloud if there are no faces."""
    if not len(mesh.triangles):
        return CloudBody(mesh)
    directed = _sides(mesh)
    return MeshBody(mesh, len(np.unique(directed, axis=0)) < len(directed))


def open_edges(mesh: ModelMesh) -> int:
    """Return the number of edges with an odd number of faces: 0 for a closed mesh."""
    sides = np.sort(_sides(mesh), axis=1)
    return int((np.unique(sides, axis=0, return_counts=True)[1] % 2).sum())


def _sides(mesh: ModelMesh) -> Array:
    return np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])


def _affordable(corners: Array, count: int, rng: np.random.Generator) -> Columns:
    flat = corners[:, :, :2].reshape(-1, 2)
    low, high = flat.min(axis=0), flat.max(axis=0)
    columns = columns_below(low, high, max(100, count), rng)
    work = int(candidates(columns, corners)[1].prod(axis=1).sum())
    if work <= MOST_PAIRS:
        return columns
    return columns_below(low, high, max(100, count * MOST_PAIRS // work), rng)


def _on_surface(corners: Array, count: int, rng: np.random.Generator) -> Array | None:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    ends = np.cumsum(areas)
    if not ends[-1] > 0:
        return None
    along = (np.arange(count) + rng.random(count)) / count * ends[-1]
    k = np.minimum(np.searchsorted(ends, along, side="right"), len(ends) - 1)
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    return np.asarray(a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]))


def _nearest_colors(mesh: ModelMesh, places: Array) -> Colors | None:
    if mesh.colors is None:
        return None
    return np.asarray(mesh.colors[cKDTree(mesh.corners).query(places)[1]])
