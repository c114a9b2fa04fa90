"""The shortest way between two points round and over obstacles: A* on a visibility graph.

Where meshes are in the way, voxels tell it (``planning.path.voxels``).

Obstacles are grown into convex prisms; the graph's nodes are the corners of the grown footprints at a
few heights; an edge is free where the segment misses every grown prism, which clipping a segment
against half-spaces decides exactly. Climbing and flying over an obstacle cost extra, so that what can
be passed beside at a similar length is not flown over.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush
from math import ceil, pi

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import FAR_M, distances
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.geom.solids import Cylinder, Solid
from shotc.planning.free_space import MARGIN_M, FreeSpace, Obstacle, blocked, bounds_slack
from shotc.planning.path.voxels import route_through

ROUTE_MARGIN_M = 2 * MARGIN_M  # the route leaves the corridor some play
NODE_MARGIN_M = 2.4 * MARGIN_M  # nodes stand clear of the prisms that edges are tested against
ROOMY_RATIO = 10.0  # times these margins where there is room for it
DETOUR_RATIO = 1.15  # how much longer a roomy way may be than one that scrapes past
SAME_PLACE_M = 1e-6  # metres
NARROW_SHARES = (0.2, 0.05)  # of these margins, tried in turn: a narrow gap is better than no way
CLIMB_PRICE = 0.3  # extra length for each metre up or down
OVERFLIGHT_PRICE = 0.3  # extra length for each metre above an obstacle


@dataclass(frozen=True, slots=True, eq=False)
class _Grown:
    """An obstacle's half-planes n.xy <= offset, shape (E, 2) and (E,), before growing, and its heights."""

    normals: Array
    offsets: Array
    bottom: float
    top: float
    clearance: float


def find_route(space: FreeSpace, start: Array, end: Array) -> Array | None:
    """Return the corners of the way from start to end, shape (K, 3), both included; None if there is none.

    Both points must themselves be free. Nodes come from the obstacles in the way; more obstacles join
    as they turn out to block, so far ones cost nothing.
    """
    first = blocked(space, start[None], end[None], MARGIN_M)[0]
    if not first.any():
        return np.stack([start, end])
    solids = len(space.obstacles)
    way = None if first[solids:].any() else _round_solids(space, first[:solids], start, end)
    if not space.meshes or (way is not None and not blocked(space, way[:-1], way[1:])[:, solids:].any()):
        return way
    return route_through(space, start, end)


def _round_solids(space: FreeSpace, first: Mask, start: Array, end: Array) -> Array | None:
    """Return the way round solids, some of which stop the straight one; meshes may be in its way."""
    grown = [_grow(o) for o in space.obstacles]
    near = _search(_Scene(space, grown, 1.0), first, start, end)
    if near is not None:
        roomy = _search(_Scene(space, grown, ROOMY_RATIO), first, start, end)
        if roomy is not None and length(roomy) <= DETOUR_RATIO * length(near):
            near = roomy
        return _level(space, near)
    for share in NARROW_SHARES:
        narrow = _search(_Scene(space, grown, share), first, start, end)
        if narrow is not None:
            return narrow
    return None


def length(route: Array) -> float:
    """Return the length of a polyline, shape (K, 3), metres."""
    return float(np.linalg.norm(np.diff(route, axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, eq=False)
class _Scene:
    """What a search runs in; ``share`` is the part of the usual margins that it keeps."""

    space: FreeSpace
    grown: list[_Grown]
    share: float

    def reach(self, j: int) -> float:
        """Return how far obstacle j is grown for testing edges, metres."""
        return self.grown[j].clearance + self.share * ROUTE_MARGIN_M

    def node_reach(self, j: int) -> float:
        """Return how far obstacle j is grown for placing nodes, metres."""
        return self.grown[j].clearance + self.share * NODE_MARGIN_M


def _search(scene: _Scene, first: Mask, start: Array, end: Array) -> Array | None:
    active = first
    best: Array | None = None
    for _ in range(len(scene.grown) + 1):
        graph = _Graph(scene, np.flatnonzero(active), start, end)
        best, touched = graph.search()
        if (touched <= active).all():
            break
        active = active | touched
    return best


class _Graph:
    """One search: nodes from some obstacles, edges tested against all of them."""

    def __init__(self, scene: _Scene, active: IntArray, start: Array, end: Array) -> None:
        self.scene = scene
        corners = [_nodes(scene, j, active, start, end) for j in active]
        nodes = np.concatenate([np.stack([start, end]), *corners])
        free = bounds_slack(scene.space, nodes) >= scene.share * MARGIN_M
        for j, g in enumerate(scene.grown):
            free &= ~_inside(g, nodes, scene.reach(j))
        free[:2] = True
        self.nodes: Array = nodes[free]
        self.touched = np.zeros(len(scene.grown), dtype=bool)

    def search(self) -> tuple[Array | None, Mask]:
        """Return the cheapest way found, and which obstacles stopped an edge."""
        nodes = self.nodes
        cost = np.full(len(nodes), np.inf)
        cost[0] = 0.0
        parent = np.zeros(len(nodes), dtype=np.intp)
        done = np.zeros(len(nodes), dtype=bool)
        ahead = np.linalg.norm(nodes - nodes[1], axis=1)
        queue = [(float(ahead[0]), 0)]
        while queue:
            _, i = heappop(queue)
            if done[i]:
                continue
            done[i] = True
            if i == 1:
                return self._trace(parent), self.touched
            others = np.flatnonzero(~done)
            reach = cost[i] + self._prices(i, others)
            better = reach < cost[others]
            for k, value in zip(others[better], reach[better], strict=True):
                cost[k], parent[k] = value, i
                heappush(queue, (float(value + ahead[k]), int(k)))
        return None, self.touched

    def _trace(self, parent: IntArray) -> Array:
        path = [1]
        while path[-1] != 0:
            path.append(int(parent[path[-1]]))
        return np.asarray(self.nodes[path[::-1]])

    def _prices(self, i: int, others: IntArray) -> Array:
        a = np.broadcast_to(self.nodes[i], (len(others), 3))
        b = self.nodes[others]
        stride = np.linalg.norm(b - a, axis=1)
        price = stride + CLIMB_PRICE * np.abs(b[:, 2] - a[:, 2])
        for j, g in enumerate(self.scene.grown):
            enter, leave = _clip(g, a, b, self.scene.reach(j))
            over = np.maximum(leave - enter, 0.0)
            if g.top < FAR_M:
                price = price + OVERFLIGHT_PRICE * over * stride
            hit = self._hits(j, a, b, enter, leave)
            exact = self._close(j, i, others)
            if exact.any():
                hit[exact] = self._near(j, a[exact], b[exact])
            self.touched[j] |= bool(hit.any())
            price[hit] = np.inf
        return np.asarray(price)

    def _hits(self, j: int, a: Array, b: Array, enter: Array, leave: Array) -> Mask:
        """Edges that cut the grown prism, given where they are above or below its footprint."""
        g, reach = self.scene.grown[j], self.scene.reach(j)
        low, high = _clip_heights(a[:, 2], b[:, 2] - a[:, 2], g.bottom - reach, g.top + reach)
        return np.asarray(np.maximum(enter, low) < np.minimum(leave, high) - 1e-9)

    def _close(self, j: int, i: int, others: IntArray) -> Mask:
        """Edges whose start or end point of the whole way stands inside the grown prism."""
        inside = _inside(self.scene.grown[j], self.nodes[:2], self.scene.reach(j) + 1e-6)
        if i <= 1 and inside[i]:
            return np.ones(len(others), dtype=np.bool_)
        return np.asarray((others == 1) & inside[1])

    def _near(self, j: int, a: Array, b: Array) -> Mask:
        o = self.scene.space.obstacles[j]
        own = np.minimum(distances(o.part, a), distances(o.part, b)) - o.clearance
        need = o.clearance + np.minimum(self.scene.share * MARGIN_M, 0.5 * np.maximum(own, 0.0))
        return np.asarray(segment_distances(o.part, a, b) < need - 1e-9)


def _grow(obstacle: Obstacle) -> _Grown:
    part = obstacle.part
    normals, offsets = _sides(part, obstacle.clearance)
    return _Grown(normals, offsets, part.bottom, part.top, obstacle.clearance)


def _sides(part: Solid, clearance: float) -> tuple[Array, Array]:
    if isinstance(part, Cylinder):
        # Circumscribed so that no corner sticks out by more than a quarter of a metre.
        sides = min(32, max(8, ceil(pi / np.sqrt(0.5 / (part.radius + clearance + 0.5)))))
        angle = 2 * pi * np.arange(sides) / sides
        normals = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return normals, normals @ np.array(part.centre) + part.radius
    corners = np.array(part.points, dtype=np.float64)
    along = np.roll(corners, -1, axis=0) - corners
    along = along[np.linalg.norm(along, axis=1) > 1e-9]
    normals = np.stack([along[:, 1], -along[:, 0]], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    bevels = normals + np.roll(normals, 1, axis=0)
    length = np.linalg.norm(bevels, axis=1, keepdims=True)
    normals = np.concatenate([normals, (bevels / np.maximum(length, 1e-9))[length[:, 0] > 1e-6]])
    return normals, (normals @ corners.T).max(axis=1)


def _corners(g: _Grown, growth: float) -> Array:
    """Return the corners of the grown footprint, shape (E, 2)."""
    order = np.argsort(np.arctan2(g.normals[:, 1], g.normals[:, 0]))
    n, d = g.normals[order], g.offsets[order] + growth
    distinct = np.linalg.norm(n - np.roll(n, 1, axis=0), axis=1) > 1e-6
    n, d = n[distinct], d[distinct]
    m, e = np.roll(n, -1, axis=0), np.roll(d, -1)
    det = n[:, 0] * m[:, 1] - n[:, 1] * m[:, 0]
    x = (d * m[:, 1] - e * n[:, 1]) / det
    y = (n[:, 0] * e - m[:, 0] * d) / det
    return np.stack([x, y], axis=1)


def _nodes(scene: _Scene, j: int, active: IntArray, start: Array, end: Array) -> Array:
    """Corners of one grown obstacle at the heights a way may want to pass them."""
    xy = _corners(scene.grown[j], scene.node_reach(j))
    way = end[:2] - start[:2]
    progress = np.clip((xy - start[:2]) @ way / max(float(way @ way), 1e-9), 0.0, 1.0)
    levels = [start[2] + progress * (end[2] - start[2])]
    heights = [float(start[2]), float(end[2])]
    for k in active:
        g, reach = scene.grown[k], scene.node_reach(k)
        heights += [h for h in (g.top + reach, g.bottom - reach) if abs(h) < FAR_M / 2]
    levels += [np.full(len(xy), h) for h in sorted(set(heights))]
    corners = [np.column_stack([xy, z]) for z in levels]
    return np.concatenate([*corners, *_crossings(scene, j, xy, start, end)])


def _crossings(scene: _Scene, j: int, xy: Array, start: Array, end: Array) -> list[Array]:
    """Places to pass over or under an obstacle: where the direct way meets its rim, and along its sides."""
    g, reach = scene.grown[j], scene.node_reach(j)
    enter, leave = _clip(g, start[None], end[None], reach)
    rim = [0.5 * (xy + np.roll(xy, -1, axis=0))]
    if enter[0] < leave[0]:
        rim.append(start[:2] + np.stack([enter, leave]) * (end[:2] - start[:2]))
    over = np.concatenate(rim)
    heights = [h for h in (g.top + reach, g.bottom - reach) if abs(h) < FAR_M / 2]
    return [np.column_stack([over, np.full(len(over), h)]) for h in heights]


def _inside(g: _Grown, p: Array, reach: float) -> Mask:
    flat = (p[:, :2] @ g.normals.T <= g.offsets + reach - 1e-9).all(axis=1)
    return np.asarray(flat & (p[:, 2] < g.top + reach - 1e-9) & (p[:, 2] > g.bottom - reach + 1e-9))


def _clip(g: _Grown, a: Array, b: Array, reach: float) -> tuple[Array, Array]:
    """Clip segments to the grown footprint (Cyrus-Beck); returns the stretch [enter, leave] of [0, 1]."""
    rate = (b[:, :2] - a[:, :2]) @ g.normals.T
    space = g.offsets + reach - a[:, :2] @ g.normals.T
    with np.errstate(divide="ignore", invalid="ignore"):
        t = space / rate
    enter = np.where(rate < -1e-12, t, -np.inf).max(axis=1)
    leave = np.where(rate > 1e-12, t, np.inf).min(axis=1)
    outside = ((np.abs(rate) <= 1e-12) & (space < 0)).any(axis=1)
    enter, leave = np.maximum(enter, 0.0), np.minimum(leave, 1.0)
    return np.where(outside, 1.0, enter), np.where(outside, 0.0, leave)


def _clip_heights(z: Array, rise: Array, low: float, high: float) -> tuple[Array, Array]:
    flat = np.abs(rise) < 1e-12
    safe = np.where(flat, 1.0, rise)
    t1, t2 = (low - z) / safe, (high - z) / safe
    inside = (z > low + 1e-9) & (z < high - 1e-9)
    enter = np.where(flat, np.where(inside, 0.0, 2.0), np.minimum(t1, t2))
    leave = np.where(flat, np.where(inside, 1.0, -1.0), np.maximum(t1, t2))
    return enter, leave


def _level(space: FreeSpace, path: Array) -> Array:
    """Let the height change evenly along the way where that is still free."""
    if len(path) < 3:
        return path
    flat = np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(flat)])
    if along[-1] < 1e-6:
        return path
    even = path.copy()
    even[:, 2] = path[0, 2] + along / along[-1] * (path[-1, 2] - path[0, 2])
    inside = bounds_slack(space, even[1:-1]) >= MARGIN_M
    free = not blocked(space, even[:-1], even[1:], ROUTE_MARGIN_M).any()
    return _apart(even) if inside.all() and free else path


def _apart(path: Array) -> Array:
    """Leave out corners that stand where the next one does: corners above one another that were levelled."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return np.asarray(path[np.append(steps > SAME_PLACE_M, True)])
