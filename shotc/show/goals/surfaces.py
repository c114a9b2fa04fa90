"""Terrain, scenes and buildings as obstacles of a show: clearance at places, along paths, and from above.

Pictures are pushed apart thousands of times, and most are far above all obstacles. Therefore places above the
highest corner of the obstacles in their box count as clear without another test.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.ground import NoGround, height_at, leaves
from shotc.geom.surface.height import inf_height
from shotc.geom.surface.near import nearest, within
from shotc.geom.surface.tree import Pairs, Surface, in_plan, plan_boxes_meet, search
from shotc.geom.surface.triangles import highest
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner, mesh_owner
from shotc.ir.show import Fleet
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.over_ground import OUTSIDE_M, OverGround, heights_over

CELL_M = 8.0
"""Size to which horizontal boxes are rounded, so that their content is looked up once."""
CLOSED_M = 4e-7
"""Accuracy of proved distances and heights: below ``clearances.ROUNDING_M``."""
UPSIDE_DOWN = np.array([1.0, 1.0, -1.0])


class _Under(NamedTuple):
    """The content of a horizontal box: z of the highest corner; whole : whether the terrain
    covers all of it.
    """

    top: float
    whole: bool


@dataclass(frozen=True, slots=True, eq=False)
class OverTerrain:
    """The least or greatest height over terrain: ``OverGround``, for whole fleets."""

    kept: OverGround
    _known: dict[tuple[int, ...], _Under] = field(default_factory=dict)

    @property
    def owner(self) -> Owner:
        """Return the owner of the limit."""
        return self.kept.owner

    def owner_at(self, _: Array) -> Owner:
        """Return the owner of the limit at a place, (3,)."""
        return self.kept.owner

    def lack(self, p: Array) -> Array:
        """Return the missing height at places (n, 3), (n,), m; at most 0 where the limit is kept."""
        if not len(p):
            return np.zeros(0)
        least = self._under(p).top + self.kept.clearance - self._turned(p)[:, 2]
        if self._under(p).whole and least.max() <= 0.0:
            return np.asarray(least)
        return -self.kept.slack(p)

    def up(self, p: Array, *, every: bool) -> Array:
        """Return the rise with which places (n, 3) keep the height, (n,), m, at least 0."""
        if self.kept.flipped:
            return np.zeros(len(p))
        lack = self.lack(p)
        return np.where(lack >= OUTSIDE_M, inf, np.maximum(lack, 0.0))

    def worst(self, pieces: Pieces) -> float:
        """Return the largest missing height on pieces, proved, m; at most 0 if the limit is kept."""
        pieces = Pieces(pieces.low, pieces.high, self._turned(pieces.ctrl))
        ground, clearance = self.kept.ground, self.kept.clearance
        low, high = pieces.ctrl.min(axis=1), pieces.ctrl.max(axis=1)
        if not self.kept.flipped and self._leaves(pieces, low, high):
            return OUTSIDE_M

        def meets(item: IntArray, its_low: Array, its_high: Array) -> Mask:
            over = plan_boxes_meet(low[item], high[item], its_low, its_high)
            return np.asarray(over & (low[item, 2] < its_high[:, 2] + clearance))

        near = _those(search(ground.surface, len(pieces), meets), pieces)
        if not near.any():
            return 0.0
        bound = inf_height(pieces.pick(near), ground, lambda _: CLOSED_M)
        return OUTSIDE_M if isinstance(bound, NoGround) else clearance - bound.proven

    def _leaves(self, pieces: Pieces, low: Array, high: Array) -> bool:
        """Tell whether pieces cross the terrain's border, or start beyond it."""
        if np.isnan(height_at(self.kept.ground, pieces.ctrl[:, 0, :2])).any():
            return True
        near = _those(in_plan(self.kept.ground.edge, low, high), pieces)
        return bool(near.any()) and leaves(self.kept.ground, pieces.pick(near)) is not None

    def _turned(self, p: Array) -> Array:
        return p * UPSIDE_DOWN if self.kept.flipped else p

    def _under(self, p: Array) -> _Under:
        low, high = _rounded(p, 0.0)
        key = (*low, *high)
        if key not in self._known:
            a, b = (np.array([corner], dtype=np.float64) * CELL_M for corner in (low, high))
            tree = self.kept.ground.surface
            top = _top(tree, a, b)
            whole = isfinite(top) and not len(in_plan(self.kept.ground.edge, a, b))
            self._known[key] = _Under(top, whole)
        return self._known[key]


@dataclass(frozen=True, slots=True, eq=False)
class BesideSurface:
    """A distance to keep from all triangles of a tree: of a scene, of buildings, or of terrain such as
    cliffs.

    mesh : their ``BesideMesh``, None for terrain, which has no inside
    """

    owner: Owner
    surface: Surface
    clearance: float
    mesh: BesideMesh | None = None
    _known: dict[tuple[int, ...], float] = field(default_factory=dict)

    def owner_at(self, p: Array) -> Owner:
        """Return the owner of the surface nearest to a place, (3,)."""
        return self.owner if self.mesh is None else self.mesh.owner_at(p)

    def lack(self, p: Array) -> Array:
        """Return the missing distance at places (n, 3), (n,), m; at most 0 where the distance is kept."""
        least = self._tops(p) + self.clearance - p[:, 2]
        low = least > 0.0
        if not low.any():
            return np.asarray(least)
        lack = least
        lack[low] = -self._slack(p[low])
        return lack

    def up(self, p: Array, *, every: bool) -> Array:
        """Return the rise that brings places (n, 3) above all that is near in the horizontal plane, (n,), m.

        every : whether all places must be above, or only those that are too near at present; for terrain the
            result is then 0, because a place with enough height over it is hardly ever too near to it
        """
        if self.mesh is None and not every:
            return np.zeros(len(p))
        rise = self._tops(p) + self.clearance - p[:, 2]
        rising = np.flatnonzero(rise > 0.0)
        if not every and len(rising):
            rising = rising[self._slack(p[rising]) < 0.0]
        heights = np.zeros(len(p))
        if len(rising):
            at = p[rising]
            pairs = in_plan(self.surface, at[:, :2] - self.clearance, at[:, :2] + self.clearance)
            top = np.full(len(rising), -inf)
            np.maximum.at(top, pairs.item, highest(self.surface.triangles[pairs.triangle])[:, 2])
            heights[rising] = np.maximum(top + self.clearance - at[:, 2], 0.0)
        return heights

    def worst(self, pieces: Pieces) -> float:
        """Return the largest missing distance on pieces, proved, m; at most 0 if the distance is kept.

        A path that starts outside of a closed mesh, and keeps away from all triangles, stays outside.
        """
        low, high = pieces.ctrl.min(axis=1), pieces.ctrl.max(axis=1)
        near = _those(within(self.surface, low, high, self.clearance), pieces)
        deep = 0.0 if self.mesh is None else float(self.lack(pieces.ctrl[:, 0]).max(initial=0.0))
        if not near.any():
            return deep
        bound = inf_distance(pieces.pick(near), self.surface, lambda _: CLOSED_M)
        return max(deep, self.clearance - bound.proven)

    def _slack(self, p: Array) -> Array:
        if self.mesh is not None:
            return self.mesh.slack(p)
        return nearest(self.surface, p, 2.0 * self.clearance).distance - self.clearance

    def _tops(self, p: Array) -> float:
        """Return z of the highest corner near places in the horizontal plane, or minus infinity."""
        if not len(p) or not len(self.surface):
            return -inf
        low, high = _rounded(p, self.clearance)
        key = (*low, *high)
        if key not in self._known:
            a, b = (np.array([corner], dtype=np.float64) * CELL_M for corner in (low, high))
            self._known[key] = _top(self.surface, a, b)
        return self._known[key]


Standing = OverTerrain | BesideSurface


def surfaces_of(mission: MissionIR, fleet: Fleet) -> tuple[Standing, ...]:
    """Return the terrain, scenes and buildings that a fleet must keep clear of."""
    return tuple(_surfaces(mission, fleet))


def _surfaces(mission: MissionIR, fleet: Fleet) -> Iterator[Standing]:
    rules, terrain = mission.rules, mission.terrain
    if terrain is not None:
        most = rules.max_height
        most = most if most is not None and isfinite(most) else None
        heights = heights_over(terrain.ground, rules.over_ground(fleet.radius), most)
        yield from map(OverTerrain, heights)
        yield BesideSurface(heights[0].owner, terrain.ground.surface, fleet.radius)
    for mesh in mission.meshes:
        owner, least = mesh_owner(mesh), rules.beside_obstacle(fleet.radius) + mesh.spacing
        yield BesideSurface(owner, mesh.surface, least, BesideMesh(owner, mesh, least))


def _rounded(p: Array, reach: float) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return the cells of the horizontal box of places, enlarged by ``reach``, m, and rounded outwards."""
    low = np.floor((p[:, :2].min(axis=0) - reach) / CELL_M)
    high = np.ceil((p[:, :2].max(axis=0) + reach) / CELL_M)
    return (int(low[0]), int(low[1])), (int(high[0]), int(high[1]))


def _those(pairs: Pairs, pieces: Pieces) -> Mask:
    """Return the mask of pieces that occur in pairs, (M,)."""
    mask = np.zeros(len(pieces), dtype=bool)
    mask[pairs.item] = True
    return mask


def _top(tree: Surface, low: Array, high: Array) -> float:
    triangles = in_plan(tree, low, high).triangle
    return float(tree.triangles[triangles][..., 2].max(initial=-inf))
