"""From keyframes to polylines: which keyframes bind, and how the path avoids the obstacles between them.

A keyframe that the user placed binds. A generated keyframe is an ideal: where it is too near to an obstacle
it is dropped, its neighbours only attract the path, and the path leads around the obstacle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import pi

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import FAR_M, support
from shotc.geom.vec import wrapped
from shotc.ir.keyframes import PlacedKeyframe
from shotc.planning.free_space import MARGIN_M, Breach, FreeSpace, blocked, bounds_slack, breaches
from shotc.planning.layered import VisibleSubject, led_round
from shotc.planning.path.over import over_ground
from shotc.planning.path.route import NODE_MARGIN_M, find_route

TURN_LENGTH_M_RAD = 2.0  # metres of path parameter per radian of a turn on the spot
SAME_PLACE_M = 1e-3  # metres
PACE_M_S = 3.0  # m/s, nominal speed between keyframes in the price of a deviation
RINGS_M = np.geomspace(0.1, 60.0, 33)  # metres around a place near a mesh, candidates of free places


@dataclass(frozen=True, slots=True, eq=False)
class Polyline:
    """A polyline with the path parameter at its corners.

    corners : shape (M, 3)
    s : shape (M,), not decreasing
    of : keyframe at each corner, or -1
    dropped : keyframes that the path leaves out
    moved : whether the first, and the last, keyframe is moved
    drawn : places that attract the path instead of generated keyframes, (K, 3); None where these do
    attractors : corners that attract ways between placed keyframes
    """

    corners: Array
    s: Array
    of: tuple[int, ...]
    dropped: tuple[int, ...] = ()
    moved: tuple[bool, bool] = (False, False)
    drawn: Array | None = None
    attractors: tuple[int, ...] = ()

    @property
    def loose(self) -> bool:
        """Whether generated keyframes only attract the path."""
        return bool(self.dropped) or self.drawn is not None


@dataclass(frozen=True, slots=True, eq=False)
class NoWay:
    """There is no free path from one point to the next.

    start, end : shape (3,)
    keyframes : their indices in the shot, or (-1, -1) outside shots
    """

    start: Array
    end: Array
    keyframes: tuple[int, int] = (-1, -1)


@dataclass(frozen=True, slots=True, eq=False)
class TooNear:
    """A point that binds but is nearer to an obstacle than its clearance."""

    point: Array
    keyframe: int
    breach: Breach


def straight_line(space: FreeSpace, start: Array, end: Array) -> Polyline | NoWay | TooNear:
    """Return the polyline of a transfer between two points of shape (3,)."""
    for p in (start, end):
        near = breaches(space, p)
        if near:
            return TooNear(p, -1, near[0])
    route = over_ground(space, find_route(space, start, end))
    if route is None:
        return NoWay(start, end)
    steps = np.linalg.norm(np.diff(route, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    return Polyline(route, s, tuple([-1] * len(route)))


def shot_line(
    space: FreeSpace, keyframes: tuple[PlacedKeyframe, ...], watched: VisibleSubject | None = None
) -> Polyline | NoWay | TooNear:
    """Return the polyline through a shot's keyframes.

    watched : the subject at the keyframes, to which generated keyframes are led; None without one
    """
    points = np.array([k.at for k in keyframes], dtype=np.float64)
    drawn = None if watched is None else _drawn(space, keyframes, points, watched)
    points = points if drawn is None else drawn
    chosen: list[int] = []
    last = len(keyframes) - 1
    moved = [False, False]
    for i, keyframe in enumerate(keyframes):
        near = breaches(space, points[i])
        if near and keyframe.placed:
            return TooNear(points[i], i, near[0])
        if near and i in {0, last}:
            free = _nearest_free(space, points[i])
            if free is None:
                return TooNear(points[i], i, near[0])
            points[i], moved[i == last] = free, True
            near = []
        if not near:
            chosen.append(i)
    polylines = _polylines(space, points, chosen)
    if isinstance(polylines, NoWay):
        return polylines
    dropped = tuple(i for i in range(len(keyframes)) if i not in chosen)
    line = _joined(keyframes, points[chosen[0]], chosen, polylines)
    return replace(line, dropped=dropped, moved=(moved[0], moved[1]), drawn=drawn)


def line_beside(
    space: FreeSpace, keyframes: tuple[PlacedKeyframe, ...], attractors: Sequence[Array]
) -> Polyline | NoWay:
    """Return the polyline through placed keyframes and places between them.

    attractors : for each keyframe but the last, places on the way to the next one, (N, 3)
    """
    points = np.array([k.at for k in keyframes], dtype=np.float64)
    places, of = [points[:1]], [0]
    for k, between in enumerate(attractors):
        places += [between, points[k + 1 : k + 2]]
        of += [-1] * len(between) + [k + 1]
    polylines = _polylines(space, np.concatenate(places), list(range(len(of))))
    if isinstance(polylines, NoWay):
        return polylines
    ends = np.cumsum([len(leg) - 1 for leg in polylines])
    drawing = tuple(int(end) for end, k in zip(ends, of[1:], strict=True) if k < 0)
    return replace(_joined(keyframes, points[0], of, polylines), attractors=drawing)


def _drawn(
    space: FreeSpace, keyframes: tuple[PlacedKeyframe, ...], points: Array, watched: VisibleSubject
) -> Array | None:
    """Return keyframes' places, (K, 3), with generated ones led to see the subject; None if none is moved.

    The ends and the keyframes of the author stay.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    held = np.array([k.placed for k in keyframes])
    held[[0, -1]] = True
    if held.all() or steps.min() < SAME_PLACE_M:
        return None
    times = np.concatenate([[0.0], np.cumsum(steps)]) / PACE_M_S
    course = led_round(space.bounds, (), (times, points), watched, held, joined=False)
    return course.places if course.for_sight.any() else None


def _polylines(space: FreeSpace, points: Array, numbers: list[int]) -> list[Array] | NoWay:
    a, b = points[numbers[:-1]], points[numbers[1:]]
    polylines = []
    shut = blocked(space, a, b)
    for k in range(len(numbers) - 1):
        straight = np.stack([a[k], b[k]])
        route = over_ground(space, find_route(space, a[k], b[k]) if shut[k].any() else straight)
        if route is None:
            return NoWay(a[k], b[k], (numbers[k], numbers[k + 1]))
        polylines.append(route)
    return polylines


def _joined(
    keyframes: tuple[PlacedKeyframe, ...], start: Array, nodes: list[int], polylines: list[Array]
) -> Polyline:
    """Return the polyline of the ways from node to node; nodes : keyframe of each node, or -1."""
    corners, s, of = [start], [0.0], [nodes[0]]
    for (i, j), leg in zip(pairwise(nodes), polylines, strict=True):
        if len(leg) == 2 and np.linalg.norm(leg[1] - leg[0]) < SAME_PLACE_M:
            steps = np.array([_turn_length(keyframes[i], keyframes[j])])
            corners.append(corners[-1])
        else:
            steps = np.linalg.norm(np.diff(leg, axis=0), axis=1)
            corners += list(leg[1:])
        s += list(s[-1] + np.cumsum(steps))
        of += [-1] * (len(leg) - 2) + [j]
    return Polyline(np.array(corners), np.array(s), tuple(of))


def _turn_length(a: PlacedKeyframe, b: PlacedKeyframe) -> float:
    turn = abs(wrapped(b.yaw - a.yaw) if b.turn is None else b.turn)
    length = TURN_LENGTH_M_RAD * max(turn, abs(b.pitch - a.pitch), abs(b.hfov - a.hfov))
    return length if length >= SAME_PLACE_M else 0.0


def _nearest_free(space: FreeSpace, p: Array) -> Array | None:
    """Return a free point near one that is not, moved sideways or up out of each obstacle."""
    tries = [p]
    for o in space.obstacles:
        reach = o.clearance + NODE_MARGIN_M
        angle = np.linspace(0.0, 2 * pi, 32, endpoint=False)
        rays = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(32)])
        # Distance out along each ray: the support of the solid relative to p, plus the clearance.
        out = support(o.part, rays) - rays @ p + reach
        tries += list(p + rays[out > 0] * out[out > 0, None])
        if o.part.top < FAR_M:
            tries.append(np.array([p[0], p[1], o.part.top + reach]))
    if any(mesh.slack(p[None])[0] < MARGIN_M for mesh in space.meshes):
        tries += list((p + RINGS_M[:, None, None] * directions(32, (0.0, 0.5, 1.0))).reshape(-1, 3))
    for ground in space.terrain[:1]:
        below = MARGIN_M - ground.slack(np.array(tries))
        tries += [q + np.array([0.0, 0.0, lack]) for q, lack in zip(tries, below, strict=True) if lack > 0.0]
    for wall in space.walls:
        lack = wall.offset + MARGIN_M - float(p @ np.array(wall.normal))
        if lack > 0:
            tries += [q + lack * np.array(wall.normal) for q in list(tries)]
    candidates = np.array(tries)
    free = bounds_slack(space, candidates) >= 0
    order = np.argsort(np.linalg.norm(candidates - p, axis=1), kind="stable")
    for i in order:
        if free[i] and not breaches(space, candidates[i]):
            return np.asarray(candidates[i])
    return None
