"""Meshes, clouds and buildings that stand in a mission's world, of triangles."""

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
"""Metres that a body is wide and high at least, to be looked past."""


class NearPart(NamedTuple):
    """What of a mesh is nearest to a place: the name of its part, how far it is, metres, and its place."""

    name: str
    distance: float
    place: Vec3


@dataclass(frozen=True, slots=True, eq=False)
class ObstacleMesh:
    """What drones keep clear of and what hides that which is behind it: the triangles of one file.

    kind    : the key of ``world`` that names the file
    file    : its name, as the mission writes it
    surface : the triangles, metres of W, and the tree of boxes round them
    part    : shape (n,), of each triangle that the surface was made of, the number of what it belongs to
    names   : of those parts: a building's name or id, a node of a scene
    body    : shape (n,), likewise the number of the connected body that each belongs to
    closed  : which of those bodies have an inside
    spacing : metres that every triangle stands for beyond itself: half the spacing of a cloud's points; 0 of
        meshes and buildings. Every clearance is that much larger.
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
        """Where the mission names the file."""
        return ("world", self.kind, "file")

    def holds(self, p: Array) -> Mask:
        """Tell which points (K, 3) of W are inside of a closed body; (K,)."""
        return inside(self.surface, self.body, self.closed, p)

    def signed_distance(self, p: Array, limit: float = inf) -> Array:
        """Return how far points (K, 3) are, metres, negative inside of a closed body; (K,).

        limit : beyond it a distance is infinite, or inside the limit itself
        """
        distance = nearest(self.surface, p, limit).distance
        return np.where(self.holds(p), -np.minimum(distance, limit), distance)

    def nearest_part(self, place: Vec3) -> NearPart:
        """Return what is nearest to a place of W."""
        found = nearest(self.surface, np.array([place]))
        x, y, z = found.point[0]
        name = self.name_at(int(self.surface.source[found.triangle[0]]))
        return NearPart(name, float(found.distance[0]), (float(x), float(y), float(z)))

    def block(self, part: int) -> UprightPrism:
        """Return the upright prism about a part: over the hull of its corners, as high as they are."""
        corners = self.surface.triangles[self.part[self.surface.source] == part].reshape(-1, 3)
        plan = np.unique(corners[:, :2], axis=0).tolist()
        low, high = float(corners[:, 2].min()), float(corners[:, 2].max())
        return UprightPrism(convex_hull(tuple((x, y) for x, y in plan)), low, high)

    def lacks(self, places: Sequence[Vec3], clearance: float) -> list[float]:
        """Return by how much places lack the distance that a body's centre keeps from surfaces, metres.

        clearance : that distance, without the spacing; what is farther than it lacks minus infinity
        """
        need = clearance + self.spacing
        found: list[float] = (need - self.signed_distance(np.array(places), need)).tolist()
        return found

    def name_at(self, triangle: int) -> str:
        """Return the name of what a triangle belongs to; triangle : of those that the surface was made of."""
        return self.names[int(self.part[triangle])]


def obstacle_mesh(
    kind: Literal["scene", "buildings"],
    file: str,
    triangles: Array,
    parts: tuple[IntArray, tuple[str, ...]],
    spacing: float = 0.0,
) -> ObstacleMesh:
    """Return triangles (n, 3, 3), metres of W, with their tree; parts : of each triangle, and their names."""
    part, names = parts
    made = bodies(triangles)
    return ObstacleMesh(kind, file, surface_of(triangles), part, names, made.body, made.closed, spacing)


@lru_cache(maxsize=4)
def body_prisms(mesh: ObstacleMesh) -> tuple[Prism, ...]:
    """Return upright convex prisms round the bodies of a mesh, but for those too small to be looked past."""
    surface = mesh.surface
    order = np.argsort(mesh.body[surface.source], kind="stable")
    of = mesh.body[surface.source][order]
    found = []
    for its in np.split(order, np.flatnonzero(np.diff(of)) + 1):
        corners = surface.triangles[its].reshape(-1, 3)
        low, high = corners.min(axis=0), corners.max(axis=0)
        if min(float(np.max((high - low)[:2])), float(high[2] - low[2])) < LEAST_M:
            continue
        hull = convex_hull(tuple((float(x), float(y)) for x, y in np.unique(corners[:, :2], axis=0)))
        if len(hull) > 2:
            found.append(Prism(hull, float(low[2]), float(high[2])))
    return tuple(found)
