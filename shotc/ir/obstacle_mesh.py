"""Meshes, point clouds and buildings of a mission's world, as triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf
from typing import Literal, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.enclosing import UprightPrism
from shotc.geom.pieces import Mask
from shotc.geom.solids import Prism, convex_hull
from shotc.geom.surface.inside import bodies, inside
from shotc.geom.surface.near import nearest
from shotc.geom.surface.tree import Surface, surface_of
from shotc.geom.vec import Vec3
from shotc.ir.origin import KeyPath

LEAST_M = 0.5
"""Least width and height of a body that counts as an occluder, metres."""


class NearPart(NamedTuple):
    """The point of a mesh nearest to a place: the name of its part, its distance, metres, and the point."""

    name: str
    distance: float
    place: Vec3


@dataclass(frozen=True, slots=True, eq=False)
class ObstacleMesh:
    """The triangles of one file: an obstacle and an occluder.

    kind    : the key of ``world`` that names the file
    file    : its name, as the mission writes it
    surface : the triangles, metres of W, and the tree of boxes round them
    part    : shape (n,), for each triangle that the surface was made of, the number of its part
    names   : of the parts: a building's name or id, a node of a scene
    body    : shape (n,), likewise the number of the connected body of each triangle
    closed  : which of those bodies have an inside
    spacing : half the spacing of a cloud's points, metres, by which every clearance is larger; 0 for meshes
        and buildings
    """

    kind: Literal["scene", "buildings"]
    file: str
    surface: Surface
    part: IntArray
    names: tuple[str, ...]
    body: IntArray
    closed: Mask
    spacing: float = 0.0

    @property
    def path(self) -> KeyPath:
        """Key path of the file's name in the mission."""
        return ("world", self.kind, "file")

    def holds(self, p: Array) -> Mask:
        """Return which points (K, 3) of W are inside a closed body, shape (K,)."""
        return inside(self.surface, self.body, self.closed, p)

    def signed_distance(self, p: Array, limit: float = inf) -> Array:
        """Return the distances of points (K, 3), metres, negative inside a closed body, shape (K,).

        limit : larger distances are infinite outside, and minus the limit inside
        """
        distance = nearest(self.surface, p, limit).distance
        return np.where(self.holds(p), -np.minimum(distance, limit), distance)

    def nearest_part(self, place: Vec3) -> NearPart:
        """Return the nearest point to a place of W."""
        closest_point = nearest(self.surface, np.array([place]))
        x, y, z = closest_point.point[0]
        name = self.name_at(int(self.surface.source[closest_point.triangle[0]]))
        return NearPart(name, float(closest_point.distance[0]), (float(x), float(y), float(z)))

    def block(self, part: int) -> UprightPrism:
        """Return the upright prism about a part: the convex hull of its corners in the plan, and heights."""
        corners = self.surface.triangles[self.part[self.surface.source] == part].reshape(-1, 3)
        plan = np.unique(corners[:, :2], axis=0).tolist()
        low, high = float(corners[:, 2].min()), float(corners[:, 2].max())
        return UprightPrism(convex_hull(tuple((x, y) for x, y in plan)), low, high)

    def lacks(self, places: Sequence[Vec3], clearance: float) -> list[float]:
        """Return the lack of each place in the clearance of a body's centre, metres.

        clearance : metres, without the spacing; places that are farther have minus infinity
        """
        need = clearance + self.spacing
        lacks: list[float] = (need - self.signed_distance(np.array(places), need)).tolist()
        return lacks

    def name_at(self, triangle: int) -> str:
        """Return the name of a triangle's part; triangle : index among those that the surface was made of."""
        return self.names[int(self.part[triangle])]


def obstacle_mesh(
    kind: Literal["scene", "buildings"],
    file: str,
    triangles: Array,
    parts: tuple[IntArray, tuple[str, ...]],
    spacing: float = 0.0,
) -> ObstacleMesh:
    """Return the mesh of triangles (n, 3, 3), metres of W; parts : part numbers (n,), and names of parts."""
    part, names = parts
    solids = bodies(triangles)
    return ObstacleMesh(kind, file, surface_of(triangles), part, names, solids.body, solids.closed, spacing)


@lru_cache(maxsize=4)
def body_prisms(mesh: ObstacleMesh) -> tuple[Prism, ...]:
    """Return upright convex prisms round the bodies of a mesh, without those too small to be occluders."""
    surface = mesh.surface
    order = np.argsort(mesh.body[surface.source], kind="stable")
    of = mesh.body[surface.source][order]
    prisms = []
    for its in np.split(order, np.flatnonzero(np.diff(of)) + 1):
        corners = surface.triangles[its].reshape(-1, 3)
        low, high = corners.min(axis=0), corners.max(axis=0)
        if min(float(np.max((high - low)[:2])), float(high[2] - low[2])) < LEAST_M:
            continue
        hull = convex_hull(tuple((float(x), float(y)) for x, y in np.unique(corners[:, :2], axis=0)))
        if len(hull) > 2:
            prisms.append(Prism(hull, float(low[2]), float(high[2])))
    return tuple(prisms)
