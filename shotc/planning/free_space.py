"""The free space of one drone's centre, and convex corridors through it.

A ``FreeSpace`` is the intersection of half-spaces, vertical discs and the outside of convex obstacles, each
with its clearance from the drone's centre. A piece of a corridor has one half-space per obstacle: if all
Bernstein points of a piece lie in it, the whole piece does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.planes import separate
from shotc.geom.solid_arrays.points import distances, support
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.geom.solids import Solid
from shotc.geom.taper import TAPER_SLOPE, Taper
from shotc.geom.vec import Vec3
from shotc.ir.owners import Owner
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.over_ground import OverGround

COMFORT_M = 0.5  # metres that a curve keeps beyond the clearance where there is free space
STEEPER_RATIO = 1.4  # slope of a planned taper over the needed one, because curves leave their polyline
BREACH_M = 2e-6  # metres; a smaller lack is rounding
MARGIN_M = 0.05  # metres beyond the clearances of verification; later stages interpolate


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A convex solid from which the drone's centre keeps ``clearance`` metres.

    owner : the part of the mission that it belongs to; several obstacles may share one owner
    """

    owner: Owner
    part: Solid
    clearance: float


@dataclass(frozen=True, slots=True)
class Wall:
    """A half-space in which the drone's centre stays: n.p >= offset, with n a unit vector of W.

    clearance : the part of the offset that is the distance from the border
    """

    owner: Owner
    normal: tuple[float, float, float]
    offset: float
    clearance: float = 0.0


@dataclass(frozen=True, slots=True)
class Disc:
    """A vertical cylinder of unbounded height in which the drone's centre stays."""

    owner: Owner
    centre: tuple[float, float]
    radius: float


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """All constraints on the position of one drone's centre.

    ends : places, metres, from which the clearances of nearer obstacles taper (``geom.taper``)
    terrain : bounds of the height above terrain, the least height first
    meshes : scenes and buildings
    """

    obstacles: tuple[Obstacle, ...]
    walls: tuple[Wall, ...]
    discs: tuple[Disc, ...]
    ends: tuple[Vec3, ...] = ()
    terrain: tuple[OverGround, ...] = ()
    meshes: tuple[BesideMesh, ...] = ()

    @property
    def surfaces(self) -> tuple[OverGround | BesideMesh, ...]:
        """All constraints from triangle meshes: terrain, scenes and buildings."""
        return (*self.terrain, *self.meshes)

    @property
    def owners(self) -> tuple[Owner, ...]:
        """The owners of all constraints, each once, in a fixed order."""
        names = [o.owner for o in self.obstacles] + [w.owner for w in self.walls]
        names += [d.owner for d in self.discs] + [g.owner for g in self.surfaces]
        return tuple(dict.fromkeys(names))

    @property
    def bounds(self) -> FreeSpace:
        """The free space without its obstacles: walls, discs, terrain and meshes."""
        return FreeSpace((), self.walls, self.discs, terrain=self.terrain, meshes=self.meshes)

    def without(self, owner: Owner) -> FreeSpace:
        """Return the free space without the constraints of one owner."""
        return FreeSpace(
            tuple(o for o in self.obstacles if o.owner != owner),
            tuple(w for w in self.walls if w.owner != owner),
            tuple(d for d in self.discs if d.owner != owner),
            terrain=tuple(g for g in self.terrain if g.owner != owner),
            meshes=tuple(m for m in self.meshes if m.owner != owner),
        )

    def lent(self, metres: float) -> FreeSpace:
        """Return the free space with every clearance reduced (for obstacles to zero at least)."""
        return self.giving(dict.fromkeys(self.owners, metres))

    def giving(self, metres: Mapping[Owner, float]) -> FreeSpace:
        """Return the free space with the clearances of some owners reduced, as in ``lent``."""

        def of(part: Obstacle | Wall | Disc) -> float:
            return metres.get(part.owner, 0.0)

        return FreeSpace(
            tuple(Obstacle(o.owner, o.part, max(0.0, o.clearance - of(o))) for o in self.obstacles),
            tuple(Wall(w.owner, w.normal, w.offset - of(w), w.clearance - of(w)) for w in self.walls),
            tuple(Disc(d.owner, d.centre, d.radius + of(d)) for d in self.discs),
            terrain=tuple(g.lowered(metres.get(g.owner, 0.0)) for g in self.terrain),
            meshes=tuple(m.lowered(metres.get(m.owner, 0.0)) for m in self.meshes),
        )


@dataclass(frozen=True, slots=True)
class Breach:
    """A constraint that a point violates, and the lack in metres."""

    owner: Owner
    lack: float
    clearance: float


def bounds_slack(space: FreeSpace, p: Array) -> Array:
    """Return the least slack of points (N, 3) over walls, discs, terrain and meshes, metres; shape (N,)."""
    slack = _linear_slack(space, p)
    for surface in space.surfaces:
        slack = np.minimum(slack, surface.slack(p))
    return slack


def _linear_slack(space: FreeSpace, p: Array) -> Array:
    """Return the same for walls and discs, where the slack of control points bounds that of their curve."""
    slack = np.full(len(p), np.inf)
    for wall in space.walls:
        slack = np.minimum(slack, p @ np.array(wall.normal) - wall.offset)
    for disc in space.discs:
        slack = np.minimum(slack, disc.radius - np.linalg.norm(p[:, :2] - np.array(disc.centre), axis=1))
    return slack


def breaches(space: FreeSpace, p: Array) -> list[Breach]:
    """Return the constraints that one point (3,) violates, the largest lack first."""
    breaches = []
    for o in space.obstacles:
        lack = o.clearance - float(distances(o.part, p))
        breaches.append(Breach(o.owner, lack, o.clearance))
    breaches += [Breach(w.owner, w.offset - float(p @ np.array(w.normal)), 0.0) for w in space.walls]
    for d in space.discs:
        lack = float(np.linalg.norm(p[:2] - np.array(d.centre))) - d.radius
        breaches.append(Breach(d.owner, lack, 0.0))
    for surface in space.surfaces:
        lack = -float(surface.slack(p[None])[0])
        owner = surface.owner_at(p) if lack > BREACH_M else surface.owner
        breaches.append(Breach(owner, lack, max(0.0, surface.clearance)))
    return sorted((b for b in breaches if b.lack > BREACH_M), key=lambda b: -b.lack)


def required(obstacle: Obstacle, p: Array, margin: float) -> Array:
    """Return the distance to keep near points (N, 3): clearance and margin, less where p is closer.

    A keyframe may lie anywhere beyond the clearance. Where its slack is small, half of the slack replaces the
    margin.
    """
    space = distances(obstacle.part, p) - obstacle.clearance
    return np.asarray(obstacle.clearance + np.minimum(margin, 0.5 * np.maximum(space, 0.0)))


def blocked(space: FreeSpace, a: Array, b: Array, margin: float = MARGIN_M) -> Mask:
    """Return which obstacles and meshes segments are too near to; (N, obstacles and then meshes).

    a, b : ends of the segments, shapes (N, 3)
    """
    solids = len(space.obstacles)
    out = np.zeros((len(a), solids + len(space.meshes)), dtype=bool)
    low, high = np.minimum(a, b), np.maximum(a, b)
    for j, o in enumerate(space.obstacles):
        reach = o.clearance + margin
        box_low, box_high = _box(o.part)
        near = ((low <= box_high + reach) & (high >= box_low - reach)).all(axis=1)
        if near.any():
            need = np.minimum(required(o, a[near], margin), required(o, b[near], margin))
            out[near, j] = segment_distances(o.part, a[near], b[near]) < need - 1e-9
    for j, mesh in enumerate(space.meshes):
        out[:, solids + j] = mesh.stops(a, b, margin)
    return out


@dataclass(frozen=True, slots=True, eq=False)
class HalfSpaces:
    """Half-spaces n . p >= offset for the control points of pieces of a curve.

    piece : index of the piece, shape (R,)
    normal : unit vectors of W, (R, 3)
    offset : metres, for each of the piece's six control points, (R, 6)
    owner : index of the obstacle, shape (R,)
    """

    piece: IntArray
    normal: Array
    offset: Array
    owner: IntArray

    def and_also(self, *others: HalfSpaces) -> HalfSpaces:
        """Return these half-spaces together with others."""
        every = (self, *others)
        return HalfSpaces(
            np.concatenate([each.piece for each in every]),
            np.concatenate([each.normal for each in every]),
            np.concatenate([each.offset for each in every]),
            np.concatenate([each.owner for each in every]),
        )


NO_HALF_SPACES = HalfSpaces(
    np.zeros(0, dtype=np.intp), np.zeros((0, 3)), np.zeros((0, 6)), np.zeros(0, dtype=np.intp)
)


def beside(piece: IntArray, normal: Array, ends: Array) -> HalfSpaces:
    """Return half-spaces with offsets linear along each piece; ends : offsets at its ends, shape (R, 2)."""
    x = np.linspace(0.0, 1.0, 6)
    offset = (1.0 - x) * ends[:, :1] + x * ends[:, 1:]
    return HalfSpaces(piece, normal, offset, np.zeros(len(piece), dtype=np.intp))


def corridor(space: FreeSpace, hulls: Array, reach: float, share: float = 0.5) -> HalfSpaces:
    """Return half-spaces between each piece and each obstacle within ``reach`` metres beyond its clearance.

    A piece that is itself too near gets a half-space at the full clearance, which its points violate. Owners
    are indices of obstacles, then of surfaces.

    hulls : shape (P, m, 3), points whose convex hull contains each piece
    share : share of a piece's slack beyond the clearance that is kept, COMFORT_M at most
    """
    planes: list[HalfSpaces] = []
    middle, size = hulls.mean(axis=1), np.linalg.norm(np.ptp(hulls, axis=1), axis=1)
    for j, o in enumerate(space.obstacles):
        near = np.flatnonzero(distances(o.part, middle) < o.clearance + reach + size)
        if not len(near):
            continue
        n, gap = separate(o.part, hulls[near])
        keep = gap < o.clearance + reach
        near, n, gap = near[keep], n[keep], gap[keep]
        border = np.einsum("nmd,nd->nm", hulls[near], n).min(axis=1) - gap
        less, slack = np.zeros((len(near), 6)), gap - o.clearance
        if space.ends:
            points = six(hulls[near])
            less = o.clearance - taper(space, o).needs(points)
            along = np.einsum("nmd,nd->nm", points, n) - border[:, None]
            slack = (along - o.clearance + less).min(axis=1)
        offset = (border + o.clearance + kept(slack, share))[:, None] - less
        planes.append(HalfSpaces(near, n, offset, np.full(len(near), j)))
    for j, surface in enumerate(space.surfaces):
        planes.append(beside_surface(surface, hulls, (reach, share), len(space.obstacles) + j))
    return NO_HALF_SPACES.and_also(*planes)


def beside_surface(
    surface: OverGround | BesideMesh, hulls: Array, cover: tuple[float, float], owner: int
) -> HalfSpaces:
    """Return half-spaces for a height above terrain, or beside a mesh.

    hulls : shape (P, m, 3), points whose convex hull contains each piece
    cover : reach and share, as in ``corridor``
    owner : their index
    """
    reach, share = cover
    planes = surface.planes(hulls, reach, lambda slack: kept(slack, share))
    offset = np.repeat(planes.offset[:, None], 6, axis=1)
    return HalfSpaces(planes.piece, planes.normal, offset, np.full(len(planes.piece), owner))


def taper(space: FreeSpace, obstacle: Obstacle) -> Taper:
    """Return the tapered clearance from an obstacle in a free space with ends."""
    ends = np.array(space.ends, dtype=np.float64).reshape(-1, 3)
    return Taper(obstacle.clearance, STEEPER_RATIO * TAPER_SLOPE, ends, distances(obstacle.part, ends))


def six(hulls: Array) -> Array:
    """Return the six control points of pieces, shape (P, 6, 3); for chords, evenly spaced points on them."""
    if hulls.shape[1] == 6:
        return hulls
    x = np.linspace(0.0, 1.0, 6)[:, None]
    return np.asarray((1.0 - x) * hulls[:, :1] + x * hulls[:, -1:])


def kept(slack: Array, share: float) -> Array:
    """Return the margin to keep (...), metres, for a ``slack`` (...) beyond the clearance."""
    return np.minimum(COMFORT_M, share * np.maximum(slack, 0.0))


def shortfall(space: FreeSpace, hulls: Array) -> Array:
    """Return the metres by which each piece lacks its clearances; shape (P,), <= 0 is proved.

    A piece inside a ball that is clear needs no plane; its number is then that of the ball.

    hulls : shape (P, m, 3)
    """
    worst = -_linear_slack(space, hulls.reshape(-1, 3)).reshape(hulls.shape[:2]).min(axis=1)
    middle = hulls.mean(axis=1)
    size = np.linalg.norm(hulls - middle[:, None], axis=2).max(axis=1)
    for o in space.obstacles:
        gap = distances(o.part, middle) - size
        near = np.flatnonzero(gap < o.clearance)
        if len(near):
            _, gap[near] = separate(o.part, hulls[near])
        worst = np.maximum(worst, o.clearance - gap)
    for surface in space.surfaces:
        worst = np.maximum(worst, surface.lack(hulls))
    return np.asarray(worst)


def _box(part: Solid) -> tuple[Array, Array]:
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    reach = support(part, axes)
    return -reach[3:], reach[:3]
