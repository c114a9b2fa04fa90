"""Polylines led above rising ground, and below the greatest height above it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.planning.free_space import MARGIN_M, FreeSpace, blocked, bounds_slack
from shotc.planning.vertical_section import Section, cut, fewer, taut

STEP_M = 1.0  # metres between samples of the ground below a path
STRIP_M = 3.0  # metres on either side of a path in which the ground counts
ROOM_M = 0.5  # metres kept beyond the clearance and its margin
GROWTH_PER_M = 0.1  # growth of ROOM_M per metre from an end; five times that for the strip
APART_M = 8.0  # metres, nearer corners are merged where there is free space
LONGEST_M = 15.0  # metres of a leg; on short pieces ground far away does not count
PROVED_M = 1e-6  # metres, tolerance of the proof for a straight leg


def over_ground(space: FreeSpace, route: Array | None) -> Array | None:
    """Return a polyline, corners (K, 3), within its heights above ground; None if obstacles block it."""
    if route is None or not space.terrain:
        return route
    legs = [_leg(space, a, b) for a, b in pairwise(route)]
    if all(len(leg) == 2 for leg in legs):
        return route
    line = np.concatenate([route[:1], *(leg[1:] for leg in legs)])
    inside = bounds_slack(space, line[1:-1]).min(initial=0.0) >= 0.0
    return line if inside and not blocked(space, line[:-1], line[1:]).any() else None


def _leg(space: FreeSpace, a: Array, b: Array) -> Array:
    """Return the corners of a leg, straight in plan: the shortest that keeps the heights."""
    straight = np.stack([a, b])
    flat = float(np.linalg.norm(b[:2] - a[:2]))
    if flat < 2.0 * STEP_M or max(g.lack(straight[None])[0] for g in space.terrain) <= PROVED_M:
        return straight
    section = _section(space, a, b)
    corners = cut(fewer(section, taut(section), APART_M), LONGEST_M)
    line = a + corners[:, :1] / flat * (b - a)
    line[:, 2] = corners[:, 1]
    line[0], line[-1] = a, b
    return np.asarray(line)


def _section(space: FreeSpace, a: Array, b: Array) -> Section:
    """Return the bounds of the height along a leg, from a strip that is narrow at its ends."""
    flat = float(np.linalg.norm(b[:2] - a[:2]))
    along = np.linspace(0.0, flat, int(np.ceil(flat / STEP_M)) + 1)
    place = a[:2] + (along / flat)[:, None] * (b[:2] - a[:2])
    left = np.array([a[1] - b[1], b[0] - a[0]]) / flat
    allowance = np.minimum(ROOM_M, GROWTH_PER_M * np.minimum(along, flat - along))
    wide = np.minimum(STRIP_M, 5.0 * allowance)[:, None] * left
    strip, margin = [place - wide, place, place + wide], MARGIN_M + allowance
    low = np.max([space.terrain[0].lowest(p) for p in strip], axis=0) + margin
    high = np.full(len(along), np.inf)
    for ground in space.terrain[1:]:
        high = np.min([high, *(ground.highest(p) - margin for p in strip)], axis=0)
    for wall in space.walls:
        if wall.normal[2] < 0.0 and wall.normal[0] == wall.normal[1] == 0.0:
            high = np.minimum(high, wall.offset / wall.normal[2] - margin)
    low[1:-1] = np.max([low[:-2], low[1:-1], low[2:]], axis=0)
    high[1:-1] = np.min([high[:-2], high[1:-1], high[2:]], axis=0)
    low[[0, -1]] = high[[0, -1]] = a[2], b[2]
    return Section(along, low, high)
