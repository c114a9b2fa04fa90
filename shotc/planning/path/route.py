"""The shortest polyline between two points around and over obstacles: A* on a visibility graph.

Obstacles are grown to convex prisms. The graph's nodes are the corners of the grown footprints at a few
heights. An edge is free if its segment misses every grown prism, which is decided exactly by clipping the
segment against half-spaces. Climbing and flight above an obstacle have a price, so that a drone flies beside
an obstacle if that is of similar length. Where meshes block the path, a voxel search finds it
(``planning.path.voxels``).
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush
from math import ceil, inf, pi

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import FAR_M, distances
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.geom.solids import Cylinder, Solid
from shotc.planning.free_space import MARGIN_M, FreeSpace, Obstacle, blocked, bounds_slack
from shotc.planning.path.voxels import route_through

ROUTE_MARGIN_M = 2 * MARGIN_M  # margin of the route, which the corridor needs
NODE_MARGIN_M = 2.4 * MARGIN_M  # nodes lie outside of the prisms against which edges are tested
ROOMY_RATIO = 10.0  # factor of these margins where there is free space for it
DETOUR_RATIO = 1.15  # largest ratio of lengths between a route with this factor and one without
SAME_PLACE_M = 1e-6  # metres
BOX_M = 1e-3  # metres by which the box about a footprint is larger
NARROW_SHARES = (0.2, 0.05)  # shares of these margins for narrow gaps, tried in turn
CLIMB_PRICE = 0.3  # extra length per metre of climb or descent
OVERFLIGHT_PRICE = 0.3  # extra length per metre above an obstacle


@dataclass(frozen=True, slots=True, eq=False)
class _Grown:
    """An obstacle's half-planes n.xy <= offset, shape (E, 2) and (E,), before growing, and its heights."""

    normals: Array
    offsets: Array
    bottom: float
    top: float
    clearance: float


def find_route(space: FreeSpace, start: Array, end: Array) -> Array | None:
    """Return the corners of the route, shape (K, 3), both ends included; None if there is none.

    Nodes come from the obstacles that block the straight line. Other obstacles are added when they block an
    edge, so that distant ones cost nothing.

    start, end : free points, shape (3,)
    """
    first = blocked(space, start[None], end[None], MARGIN_M)[0]
    if not first.any():
        return np.stack([start, end])
    solids = len(space.obstacles)
    line = None if first[solids:].any() else _round_solids(space, first[:solids], start, end)
    if not space.meshes or (line is not None and not blocked(space, line[:-1], line[1:])[:, solids:].any()):
        return line
    return route_through(space, start, end)


def _round_solids(space: FreeSpace, first: Mask, start: Array, end: Array) -> Array | None:
    """Return the route around solids, some of which block the straight line; meshes are ignored."""
    grown = [_grow(o) for o in space.obstacles]
    near = _search(_RouteSearch(space, grown, 1.0), first, start, end)
    if near is not None:
        longest = DETOUR_RATIO * length(near)
        roomy = _search(_RouteSearch(space, grown, ROOMY_RATIO, longest), first, start, end)
        if roomy is not None and length(roomy) <= longest:
            near = roomy
        return _level(space, near)
    for share in NARROW_SHARES:
        narrow = _search(_RouteSearch(space, grown, share), first, start, end)
        if narrow is not None:
            return narrow
    return None


def length(route: Array) -> float:
    """Return the length of a polyline, shape (K, 3), metres."""
    return float(np.linalg.norm(np.diff(route, axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, eq=False)
class _RouteSearch:
    """The input of a search.

    share : of the usual margins, which it keeps
    longest : length of a route that is still of use, metres
    """

    space: FreeSpace
    grown: list[_Grown]
    share: float
    longest: float = inf

    def reach(self, j: int) -> float:
        """Return how far obstacle j is grown for the test of edges, metres."""
        return self.grown[j].clearance + self.share * ROUTE_MARGIN_M

    def node_reach(self, j: int) -> float:
        """Return how far obstacle j is grown for its nodes, metres."""
        return self.grown[j].clearance + self.share * NODE_MARGIN_M


def _search(scene: _RouteSearch, first: Mask, start: Array, end: Array) -> Array | None:
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

    def __init__(self, scene: _RouteSearch, active: IntArray, start: Array, end: Array) -> None:
        self.scene = scene
        corners = [_nodes(scene, j, active, start, end) for j in active]
        nodes = np.concatenate([np.stack([start, end]), *corners])
        free = bounds_slack(scene.space, nodes) >= scene.share * MARGIN_M
        free &= sum(np.linalg.norm(nodes - p, axis=1) for p in (start, end)) <= scene.longest
        for j, g in enumerate(scene.grown):
            free &= ~_inside(g, nodes, scene.reach(j))
        free[:2] = True
        self.nodes: Array = nodes[free]
        self.touched = np.zeros(len(scene.grown), dtype=bool)
        self.footprints = [_footprint_box(g, scene.reach(j)) for j, g in enumerate(scene.grown)]
        self.from_start = [self._near_end(j, 0) for j in range(len(scene.grown))]
        self.to_end = [self._near_end(j, 1) for j in range(len(scene.grown))]

    def search(self) -> tuple[Array | None, Mask]:
        """Return the cheapest route, and which obstacles blocked an edge."""
        nodes = self.nodes
        cost = np.full(len(nodes), np.inf)
        cost[0] = 0.0
        parent = np.zeros(len(nodes), dtype=np.intp)
        closed = np.zeros(len(nodes), dtype=bool)
        ahead = np.linalg.norm(nodes - nodes[1], axis=1)
        queue = [(float(ahead[0]), 0)]
        while queue:
            _, i = heappop(queue)
            if closed[i]:
                continue
            closed[i] = True
            if i == 1:
                return self._trace(parent), self.touched
            least = cost[i] + self._least_prices(i)
            # An edge that cannot make the route cheaper is not tested: most lead to distant obstacles.
            others = np.flatnonzero(~closed & (least < cost) & (least + ahead <= cost[1]))
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

    def _least_prices(self, i: int) -> Array:
        """Return the prices of the edges from a node to all nodes if nothing is in the way, shape (N,)."""
        step = self.nodes - self.nodes[i]
        return np.asarray(np.linalg.norm(step, axis=1) + CLIMB_PRICE * np.abs(step[:, 2]))

    def _prices(self, i: int, others: IntArray) -> Array:
        a = np.broadcast_to(self.nodes[i], (len(others), 3))
        b = self.nodes[others]
        stride = np.linalg.norm(b - a, axis=1)
        price = stride + CLIMB_PRICE * np.abs(b[:, 2] - a[:, 2])
        low, high = np.minimum(a, b)[:, :2], np.maximum(a, b)[:, :2]
        for j, g in enumerate(self.scene.grown):
            least, most = self.footprints[j]
            near = np.flatnonzero(((high >= least) & (low <= most)).all(axis=1))
            enter, leave = _clip(g, a[near], b[near], self.scene.reach(j))
            over = np.maximum(leave - enter, 0.0)
            if g.top < FAR_M:
                price[near] += OVERFLIGHT_PRICE * over * stride[near]
            hit = np.zeros(len(others), dtype=bool)
            hit[near] = self._hits(j, a[near], b[near], enter, leave)
            from_start, to_end = self.from_start[j], self.to_end[j]
            if i == 0 and from_start is not None:
                hit = from_start[others]
            elif to_end is not None:
                hit[others == 1] = to_end[i]
            self.touched[j] |= bool(hit.any())
            price[hit] = np.inf
        return np.asarray(price)

    def _hits(self, j: int, a: Array, b: Array, enter: Array, leave: Array) -> Mask:
        """Return which edges cut the grown prism; enter, leave : interval above its footprint."""
        g, reach = self.scene.grown[j], self.scene.reach(j)
        low, high = _clip_heights(a[:, 2], b[:, 2] - a[:, 2], g.bottom - reach, g.top + reach)
        return np.asarray(np.maximum(enter, low) < np.minimum(leave, high) - 1e-9)

    def _near_end(self, j: int, end: int) -> Mask | None:
        """Return which edges between an end of the route, 0 or 1, and each node come too near to obstacle j;
        None if the end lies outside of the grown prism, which then decides.
        """
        place = self.nodes[end : end + 1]
        if not _inside(self.scene.grown[j], place, self.scene.reach(j) + 1e-6)[0]:
            return None
        a, b = np.broadcast_to(place, self.nodes.shape), self.nodes
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
        # A circumscribed polygon whose corners stick out by at most 0.25 m.
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


def _footprint_box(g: _Grown, growth: float) -> tuple[Array, Array]:
    """Return the least and the largest x and y of a grown footprint, shapes (2,), metres."""
    corners = _corners(g, growth)
    return corners.min(axis=0) - BOX_M, corners.max(axis=0) + BOX_M


def _nodes(scene: _RouteSearch, j: int, active: IntArray, start: Array, end: Array) -> Array:
    """Return the corners of one grown obstacle at the candidate heights, shape (N, 3)."""
    xy = _corners(scene.grown[j], scene.node_reach(j))
    chord = end[:2] - start[:2]
    progress = np.clip((xy - start[:2]) @ chord / max(float(chord @ chord), 1e-9), 0.0, 1.0)
    levels = [start[2] + progress * (end[2] - start[2])]
    heights = [float(start[2]), float(end[2])]
    for k in active:
        g, reach = scene.grown[k], scene.node_reach(k)
        heights += [h for h in (g.top + reach, g.bottom - reach) if abs(h) < FAR_M / 2]
    levels += [np.full(len(xy), h) for h in sorted(set(heights))]
    corners = [np.column_stack([xy, z]) for z in levels]
    return np.concatenate([*corners, *_crossings(scene, j, xy, start, end)])


def _crossings(scene: _RouteSearch, j: int, xy: Array, start: Array, end: Array) -> list[Array]:
    """Return nodes above or below an obstacle: where the straight line crosses its rim, and along its
    sides.
    """
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
    """Clip segments to the grown footprint (Cyrus-Beck); return the interval [enter, leave] of [0, 1]."""
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
    """Return the route with its height linear in length, where that is still free."""
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
    """Return the route without corners that coincide with the next one after levelling."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return np.asarray(path[np.append(steps > SAME_PLACE_M, True)])
