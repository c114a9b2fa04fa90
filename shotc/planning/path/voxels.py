"""The route around, above and through meshes: Dijkstra over free voxels, then shortcuts.

Two free voxels do not prove the edge between them. Therefore the edges of the route are tested exactly; those
that fail are removed, and the search is repeated (lazy search, Bohlin and Kavraki 2000).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import distances
from shotc.geom.surface.near import nearest, within
from shotc.geom.surface.triangles import halved
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.free_space import MARGIN_M, FreeSpace, blocked, bounds_slack

AROUND_M = (15.0, 45.0, 135.0)  # metres around both ends in which a route is searched, in turn
FINEST_M = 1.0  # least side of a voxel
MOST_VOXELS = (120_000, 600_000)  # most voxels of one search, in turn
MOST_SEARCHES = 60  # searches in one grid, after edges that failed
ROOM_M = 1.0  # metres beyond a clearance within which a route has a higher price
NEAR_PRICE = 1.0  # additional price over length, at the clearance itself
UNSURE_RATIO = 1.5  # price factor of an edge that its voxels do not prove
CLIMB_PRICE = 0.3  # extra length per metre of climb or descent
REMOVED_PRICE = 1e9  # price of an edge that failed
SHORTCUTS_AT_ONCE = 16
LONGEST_M = 15.0  # metres of a leg; short pieces need few half-spaces
ROOMY_M, ROUTE_MARGIN_M = 0.5, 2.0 * MARGIN_M  # metres kept beyond clearances by shortcuts, in turn
DETOUR_RATIO = 1.15  # largest ratio of lengths between a route with ROOMY_M and one without
_IN_VOXEL_SIDES = 0.5 * 3.0**0.5  # sides: largest distance of a point of a voxel from its middle
_IN_TRIANGLE_EDGES = 3.0**-0.5  # longest edges: largest distance in a triangle from the nearest corner
_STEPS = np.array(
    [[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) > (0, 0, 0)]
)
"""Half of the 26 neighbours of a voxel."""


@dataclass(frozen=True, slots=True, eq=False)
class _VoxelGrid:
    """A grid of voxels around two places.

    low : middle of the first voxel in W, metres
    side : metres
    shape : number of voxels along each axis
    """

    low: Array
    side: float
    shape: tuple[int, int, int]

    def middles(self, index: IntArray) -> Array:
        """Return the middles of voxels by their flat indices, shape (N, 3)."""
        return np.asarray(self.low + self.side * np.column_stack(np.unravel_index(index, self.shape)))


def route_through(space: FreeSpace, start: Array, end: Array) -> Array | None:
    """Return the corners of a route, shape (K, 3), both ends included; None if none was found.

    start, end : free points, shape (3,)
    """
    sides = set[tuple[float, float]]()
    for around in AROUND_M:
        for most in MOST_VOXELS:
            grid = _grid(space, (start, end), around, most)
            if (around, grid.side) in sides:
                continue
            sides.add((around, grid.side))
            route = _VoxelGraph(space, grid, start, end).route()
            if route is not None:
                return _in_short_legs(_pulled(space, route))
    return None


def _grid(space: FreeSpace, ends: tuple[Array, Array], around: float, most: int) -> _VoxelGrid:
    """Return a grid around two places, such that the first is the middle of a voxel."""
    low, high = np.minimum(*ends) - around, np.maximum(*ends) + around
    floors = [wall.offset for wall in space.walls if wall.normal == (0.0, 0.0, 1.0)]
    ceilings = [-wall.offset for wall in space.walls if wall.normal == (0.0, 0.0, -1.0)]
    low[2], high[2] = max([low[2], *floors]), min([high[2], *ceilings])
    side = max(FINEST_M, float(np.prod(high - low) / most) ** (1.0 / 3.0))
    before = np.floor((ends[0] - low) / side)
    count = (before + np.floor((high - ends[0]) / side) + 1).astype(int)
    return _VoxelGrid(ends[0] - before * side, side, (int(count[0]), int(count[1]), int(count[2])))


class _VoxelGraph:
    """The free voxels of a grid as a graph, with the two ends as its first nodes."""

    def __init__(self, space: FreeSpace, grid: _VoxelGrid, start: Array, end: Array) -> None:
        self.space = space
        free, slack = _free_voxels(space, grid)
        voxels = np.flatnonzero(free)
        self.nodes: Array = np.concatenate([np.stack([start, end]), grid.middles(voxels)])
        slack = np.concatenate([np.zeros(2), slack[voxels]])
        pairs = np.concatenate([_neighbours(grid, free), _to_ends(self.nodes, grid.side)])
        a, b = pairs.T
        leap = self.nodes[b] - self.nodes[a]
        length = np.linalg.norm(leap, axis=1)
        least = np.minimum(slack[a], slack[b])
        price = length * (1.0 + NEAR_PRICE * np.clip(1.0 - least / ROOM_M, 0.0, 1.0))
        price[slack[a] + slack[b] < length] *= UNSURE_RATIO
        price += CLIMB_PRICE * np.abs(leap[:, 2])
        count = len(self.nodes)
        self.graph = csr_array(coo_array((price, (np.minimum(a, b), np.maximum(a, b))), shape=(count, count)))

    def route(self) -> Array | None:
        """Return the cheapest route whose edges are all free, shape (K, 3); None if there is none."""
        for _ in range(MOST_SEARCHES):
            cost, before = dijkstra(self.graph, directed=False, indices=0, return_predecessors=True)
            if not cost[1] < REMOVED_PRICE:
                return None
            nodes = [1]
            while nodes[-1] != 0:
                nodes.append(int(before[nodes[-1]]))
            nodes.reverse()
            points = self.nodes[nodes]
            failed = np.flatnonzero(stopped(self.space, points[:-1], points[1:], MARGIN_M))
            if not len(failed):
                return np.asarray(points)
            for k in failed:
                self._remove(*sorted(nodes[k : k + 2]))
        return None

    def _remove(self, a: int, b: int) -> None:
        row = slice(self.graph.indptr[a], self.graph.indptr[a + 1])
        self.graph.data[row][self.graph.indices[row] == b] = REMOVED_PRICE


def stopped(space: FreeSpace, a: Array, b: Array, margin: float) -> Mask:
    """Return which segments a-b, shapes (N, 3), between free places are too near to an obstacle, (N,)."""
    shut: Mask = np.any(blocked(space, a, b, margin), axis=1)
    for ground in space.terrain:
        some = np.flatnonzero(~shut)
        if len(some):
            shut[some] = ground.lack(np.stack([a[some], b[some]], axis=1)) > 0.0
    return shut


def _free_voxels(space: FreeSpace, grid: _VoxelGrid) -> tuple[Mask, Array]:
    """Return which voxels' middles are free, and lower bounds of their slack beyond a margin, metres."""
    every = np.arange(int(np.prod(grid.shape)))
    slack = np.full(len(every), ROOM_M)
    for mesh in space.meshes:
        slack = np.minimum(slack, _beside(mesh, grid))
    middles = grid.middles(every)
    slack = np.minimum(slack, bounds_slack(replace(space, meshes=()), middles))
    for o in space.obstacles:
        some = np.flatnonzero(slack >= MARGIN_M)
        slack[some] = np.minimum(slack[some], distances(o.part, middles[some]) - o.clearance)
    slack -= MARGIN_M
    return slack >= 0.0, slack


def _beside(beside: BesideMesh, grid: _VoxelGrid) -> Array:
    """Return lower bounds of the slack of voxels' middles from a mesh, metres, at most about ROOM_M.

    The distance from the nearest voxel with a corner of a small triangle gives a rough bound. Where that is
    not enough, the distance is measured.
    """
    side, shape, surface = grid.side, grid.shape, beside.mesh.surface
    reach = beside.clearance + ROOM_M + (_IN_VOXEL_SIDES + _IN_TRIANGLE_EDGES) * side
    high = grid.low + side * (np.array(shape) - 1)
    near = within(surface, grid.low[None], high[None], reach)
    small = halved(surface.triangles[near.triangle], side).triangles.reshape(-1, 3)
    pad = int(np.ceil(reach / side)) + 1
    index = np.rint((small - grid.low) / side).astype(int) + pad
    wide = tuple(n + 2 * pad for n in shape)
    index = index[((index >= 0) & (index < wide)).all(axis=1)]
    if not len(index):
        return np.full(int(np.prod(shape)), ROOM_M)
    empty = np.ones(wide, dtype=bool)
    empty[tuple(index.T)] = False
    rough = side * distance_transform_edt(empty)
    rough = rough[tuple(slice(pad, pad + n) for n in shape)].ravel()
    slack = rough - (_IN_VOXEL_SIDES + _IN_TRIANGLE_EDGES) * side - beside.clearance
    doubtful = np.flatnonzero((slack < ROOM_M) & (rough + _IN_VOXEL_SIDES * side >= beside.clearance))
    closest_points = nearest(surface, grid.middles(doubtful), beside.clearance + ROOM_M)
    slack[doubtful] = np.minimum(closest_points.distance - beside.clearance, ROOM_M)
    return np.asarray(slack)


def _neighbours(grid: _VoxelGrid, free: Mask) -> IntArray:
    """Return pairs of nodes, shape (K, 2), of free voxels that touch; nodes 0 and 1 are the ends."""
    number = np.full(len(free), -1)
    number[free] = 2 + np.arange(int(free.sum()))
    number = number.reshape(grid.shape)
    pairs = []
    for step in _STEPS:
        here = tuple(slice(max(0, -d), n - max(0, d)) for d, n in zip(step, grid.shape, strict=True))
        there = tuple(slice(max(0, d), n + min(0, d)) for d, n in zip(step, grid.shape, strict=True))
        a, b = number[here].ravel(), number[there].ravel()
        both = (a >= 0) & (b >= 0)
        pairs.append(np.column_stack([a[both], b[both]]))
    return np.concatenate(pairs)


def _to_ends(nodes: Array, side: float) -> IntArray:
    """Return pairs of the two ends, nodes 0 and 1, and the nodes near them."""
    pairs = []
    for end in (0, 1):
        distances = np.linalg.norm(nodes[2:] - nodes[end], axis=1)
        near = 2 + np.flatnonzero(distances < 2.0 * side)
        pairs.append(np.column_stack([np.full(len(near), end), near]))
    return np.concatenate(pairs).astype(np.intp)


def _pulled(space: FreeSpace, route: Array) -> Array:
    """Return a route with shortcuts, with a large margin where that is hardly longer."""
    roomy, close = (_taut(space, route, margin) for margin in (ROOMY_M, ROUTE_MARGIN_M))
    return roomy if _length(roomy) <= DETOUR_RATIO * _length(close) else close


def _taut(space: FreeSpace, route: Array, margin: float) -> Array:
    """Return the corners that remain after the longest shortcuts that keep a margin."""
    corners, i, last = [0], 0, len(route) - 1
    while i < last:
        i = _farthest(space, route, i, margin)
        corners.append(i)
    return np.asarray(route[corners])


def _farthest(space: FreeSpace, route: Array, i: int, margin: float) -> int:
    """Return the last corner with a free segment from corner i; at least the next one."""
    for high in range(len(route), i + 1, -SHORTCUTS_AT_ONCE):
        some = np.arange(high - 1, max(i + 1, high - 1 - SHORTCUTS_AT_ONCE), -1)
        if not len(some):
            break
        shut = stopped(space, np.tile(route[i], (len(some), 1)), route[some], margin)
        if not shut.all():
            return int(some[int(np.argmin(shut))])
    return i + 1


def _length(route: Array) -> float:
    return float(np.linalg.norm(np.diff(route, axis=0), axis=1).sum())


def _in_short_legs(route: Array) -> Array:
    """Return a route with more corners, so that no leg is longer than LONGEST_M."""
    parts = [route[:1]]
    for a, b in pairwise(route):
        count = int(np.ceil(np.linalg.norm(b - a) / LONGEST_M))
        parts.append(a + np.arange(1, count + 1)[:, None] / count * (b - a))
    return np.concatenate(parts)
