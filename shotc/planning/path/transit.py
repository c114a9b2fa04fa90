"""The position curve of an unfilmed leg, with the clearances of transfers from standing obstacles.

Where an end of the leg is nearer to an obstacle, the path leads from there to where the full clearance holds,
as short as the taper of the clearances allows (``geom.taper``); at the other end likewise. If no path has
these clearances, or only a much longer one, it keeps smaller ones, from as few obstacles as possible.
Verification reports what it is too near to, and refuses it where the mission states the clearances.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import distances
from shotc.geom.taper import TAPER_SLOPE
from shotc.geom.vec import Vec3
from shotc.ir.drone import Drone
from shotc.ir.owners import Owner
from shotc.planning.free_space import MARGIN_M, FreeSpace, Obstacle, blocked, bounds_slack, taper
from shotc.planning.obstacles import FreeSpaces
from shotc.planning.path.lines import NoWay, Polyline, TooNear, straight_line
from shotc.planning.path.over import over_ground
from shotc.planning.path.position import PolylineTask, solve_stretch
from shotc.planning.path.route import find_route, length
from shotc.planning.path.shots import Stuck

LONGER_RATIO, LONGER_M = (
    1.5,
    20.0,
)  # largest length of a path over that without the clearances: factor and metres
SHARE_HALVINGS = 4  # bisection steps for the share to which clearances are reduced
STEP_M = 0.2  # metres between samples of a ray
RAYS_PER_END = 24  # rays around an end
RISES_RAD = (0.0, 0.6, 1.2, -0.6)  # rad, elevations of rays
MOST_PLACES = 60  # intermediate places tried for a short path
PLAY_M = 3.0 * MARGIN_M  # metres beyond the clearances, at which the path out of an end stops
ROUNDING_M = 1e-6  # metres


def transit_curve(
    spaces: FreeSpaces, drone: Drone, a: Array, b: Array
) -> Piecewise | NoWay | TooNear | Stuck:
    """Return the position curve between two different places, shapes (3,), or why there is none."""
    near = straight_line(spaces.flight, a, b)
    if not isinstance(near, Polyline):
        return near
    for wide in _widest(spaces, near.corners):
        line = _line(spaces, wide, near.corners)
        if line is not None:
            curve = smooth(spaces.flight, drone, line, replace(wide, ends=_ends(near.corners)))
            if not isinstance(curve, Stuck):
                return curve
    return smooth(spaces.flight, drone, near)


def smooth(
    space: FreeSpace, drone: Drone, line: Polyline, wide: FreeSpace | None = None
) -> Piecewise | Stuck:
    """Return the position curve of an unfilmed leg along a polyline; wide : as in ``solve_stretch``."""
    none = np.zeros(0)
    ends = (0, len(line.corners) - 1)
    stretch = PolylineTask(line.corners, line.s, ends, none.reshape(0, 3), none, 1.0)
    solved = solve_stretch(space, stretch, drone.limits, wide)
    return Stuck(solved, line.corners, ()) if solved.curve is None else solved.curve


def _widest(spaces: FreeSpaces, near: Array) -> Iterator[FreeSpace]:
    """Yield free spaces with the full clearances first, then with as few reduced ones as possible.

    near : polyline without these clearances, shape (K, 3)
    """
    if spaces.transit == spaces.flight:
        return
    yield spaces.transit
    every = frozenset(spaces.transit.owners)
    for owners in dict.fromkeys((every - spaces.required, every)):
        share = _greatest(spaces, owners, near)
        if share is not None:
            yield _lessened(spaces, _needed(spaces, owners, share, near), share)


def _greatest(spaces: FreeSpaces, owners: frozenset[Owner], near: Array) -> float | None:
    """Return the greatest share of some owners' clearances for which there is a path; None if there
    is none.
    """
    low, high = 0.0, 1.0
    if not owners or _line(spaces, _lessened(spaces, owners, low), near) is None:
        return None
    for _ in range(SHARE_HALVINGS):
        middle = 0.5 * (low + high)
        feasible = _line(spaces, _lessened(spaces, owners, middle), near) is not None
        low, high = (middle, high) if feasible else (low, middle)
    return low


def _needed(spaces: FreeSpaces, owners: frozenset[Owner], share: float, near: Array) -> frozenset[Owner]:
    """Return those of some owners whose clearances have to be reduced for a path."""
    line = _line(spaces, _lessened(spaces, owners, share), near)
    assert line is not None
    less = owners & _passed_nearer(replace(spaces.transit, ends=_ends(near)), line.corners)
    for owner in sorted(less):
        if len(less) > 1 and _line(spaces, _lessened(spaces, less - {owner}, share), near) is not None:
            less = less - {owner}
    return less


def _lessened(spaces: FreeSpaces, owners: frozenset[Owner], share: float) -> FreeSpace:
    """Return the free space of transfers, with a share of some owners' additional clearance."""
    pairs = zip(spaces.flight.obstacles, spaces.transit.obstacles, strict=True)
    obstacles = tuple(
        replace(wide, clearance=own.clearance + share * (wide.clearance - own.clearance))
        if wide.owner in owners
        else wide
        for own, wide in pairs
    )
    return replace(spaces.transit, obstacles=obstacles)


def _passed_nearer(space: FreeSpace, corners: Array) -> frozenset[Owner]:
    points = _along(corners)
    return frozenset(
        o.owner for o in space.obstacles if (distances(o.part, points) < taper(space, o).needs(points)).any()
    )


def _line(spaces: FreeSpaces, wide: FreeSpace, near: Array) -> Polyline | None:
    """Return a polyline with clearances that taper towards its ends; None where none is short enough.

    near : polyline with the clearances of all phases, shape (K, 3)
    """
    a, b, flight = near[0], near[-1], spaces.flight
    full, wide = _settled(wide, near[[0, -1]]), replace(wide, ends=_ends(near))
    if _keeps_clearances(wide, near):
        return _of(near)
    short = length(near) <= 2.0 * max(o.clearance for o in wide.obstacles) / TAPER_SLOPE
    bent = _bent(flight, wide, a, b) if short else None
    lines = [bent] if bent is not None else []
    out, back = (_outside(flight, replace(full, ends=wide.ends), *pair) for pair in ((a, b), (b, a)))
    route = None if out is None or back is None else find_route(full, out, back)
    if route is not None:
        lines.append(_joined(a, route, b))
    lines = [line for line in (over_ground(flight, line) for line in lines) if line is not None]
    lines = [line for line in lines if not blocked(flight.bounds, line[:-1], line[1:]).any()]
    best = min(lines, key=length, default=None)
    most = inf if spaces.required else LONGER_RATIO * length(near) + LONGER_M
    return None if best is None or length(best) > most else _of(best)


def _joined(a: Array, route: Array, b: Array) -> Array:
    """Return a route with its ends a and b; points that differ from these by rounding are left out."""
    between = [p for p in route if min(np.linalg.norm(p - a), np.linalg.norm(p - b)) > ROUNDING_M]
    return np.array([a, *between, b])


def _settled(space: FreeSpace, ends: Array) -> FreeSpace:
    """Return the free space with clearances reduced to an end's distance, where it lacks only a little."""

    def settled(o: Obstacle) -> Obstacle:
        gap = float(distances(o.part, ends).min())
        return replace(o, clearance=gap) if o.clearance - PLAY_M <= gap < o.clearance else o

    return replace(space, obstacles=tuple(map(settled, space.obstacles)))


def _of(corners: Array) -> Polyline:
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    return Polyline(corners, s, tuple([-1] * len(corners)))


def _keeps_clearances(space: FreeSpace, corners: Array) -> bool:
    """Return whether a polyline keeps tapered clearances."""
    points = _along(corners)
    return bool(_keeps(space, points).all())


def _along(corners: Array) -> Array:
    """Return places along a polyline, at most STEP_M apart."""
    parts = [
        p + np.linspace(0.0, 1.0, 1 + int(np.ceil(np.linalg.norm(q - p) / STEP_M)) + 1)[:, None] * (q - p)
        for p, q in pairwise(corners)
    ]
    return np.concatenate(parts)


def _keeps(space: FreeSpace, points: Array, more: float = -ROUNDING_M) -> Mask:
    """Return which places (..., 3) keep their tapered clearances, and ``more`` metres beyond them."""
    fine = np.ones(points.shape[:-1], dtype=np.bool_)
    for o in space.obstacles:
        fine &= distances(o.part, points) >= taper(space, o).needs(points) + more
    return fine


def _outside(flight: FreeSpace, wide: FreeSpace, end: Array, goal: Array) -> Array | None:
    """Return where a straight ray from an end first has the full clearances, nearest to a goal.

    The end itself where it has them; None where no ray is clear.
    """
    lack = max((o.clearance - float(distances(o.part, end)) for o in wide.obstacles), default=0.0)
    if lack <= 0.0:
        return end
    # The needed distance grows by the slope at least, until it is reached.
    reach = np.arange(STEP_M, (lack + PLAY_M) / TAPER_SLOPE + 2.0 * STEP_M, STEP_M)
    points = end + reach[:, None] * directions(RAYS_PER_END, RISES_RAD)[:, None, :]
    fine = _keeps(wide, points)
    inside = bounds_slack(flight, points.reshape(-1, 3)).reshape(fine.shape) >= MARGIN_M
    there = np.logical_and.accumulate(fine & inside, axis=1) & _keeps(replace(wide, ends=()), points, PLAY_M)
    first = points[np.arange(len(there)), there.argmax(axis=1)][there.any(axis=1)]
    return _shortest(end, first, goal)


def _bent(flight: FreeSpace, wide: FreeSpace, a: Array, b: Array) -> Array | None:
    """Return the shortest path over one place beside the middle that keeps clearances; None if there is none.

    Between two ends that are near, the tapered clearances do not reach the full ones, so that a shorter
    detour is enough.
    """
    apart = float(np.linalg.norm(b - a))
    reach = np.arange(STEP_M, 0.5 * apart + 2.0 * STEP_M, STEP_M)
    places = (0.5 * (a + b) + reach[:, None] * directions(RAYS_PER_END, RISES_RAD)[:, None, :]).reshape(-1, 3)
    places = places[_keeps(wide, places) & (bounds_slack(flight, places) >= MARGIN_M)]
    order = np.argsort(np.linalg.norm(places - a, axis=1) + np.linalg.norm(places - b, axis=1), kind="stable")
    polylines = (np.stack([a, place, b]) for place in places[order[:MOST_PLACES]])
    return next((corners for corners in polylines if _keeps_clearances(wide, corners)), None)


def _shortest(a: Array, places: Array, b: Array) -> Array | None:
    """Return the place, of shape (N, 3), that gives the shortest path from a over it to b."""
    lengths = np.linalg.norm(places - a, axis=1) + np.linalg.norm(places - b, axis=1)
    return None if not len(places) else np.asarray(places[int(lengths.argmin())])


def _ends(line: Array) -> tuple[Vec3, Vec3]:
    (ax, ay, az), (bx, by, bz) = line[[0, -1]].tolist()
    return (ax, ay, az), (bx, by, bz)
