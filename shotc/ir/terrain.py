"""The terrain of a mission: ground as triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, isnan

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces
from shotc.geom.surface.ground import Ground, height_at
from shotc.geom.surface.height import least_where_ground
from shotc.geom.surface.near import nearest
from shotc.geom.surface.tree import in_plan, surface_of
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath

CLOSED_M = 1e-3
"""Tolerance of the least height of a way, metres."""
WAYS_AT_ONCE = 4_000


@dataclass(frozen=True, slots=True, eq=False)
class Terrain:
    """Ground of triangles, metres of W.

    file : its name, as the mission writes it; path : where that is written
    of_earth : whether its heights were altitudes; else they counted from the plane z = 0 already
    """

    ground: Ground
    file: str
    of_earth: bool = True
    path: KeyPath = ("world", "terrain", "file")

    def raised(self, metres: float) -> Terrain:
        """Return the same ground, higher by some metres."""
        tree = self.ground.surface
        higher = surface_of(tree.triangles + np.array([0.0, 0.0, metres]))
        return replace(self, ground=replace(self.ground, surface=higher))

    def span(self, low: Vec2, high: Vec2) -> Vec2:
        """Return the lowest and the highest z of the triangles over a box in the plan, metres; 0 without
        any.
        """
        tree = self.ground.surface
        z = tree.triangles[in_plan(tree, np.array([low]), np.array([high])).triangle][..., 2]
        return (float(z.min()), float(z.max())) if z.size else (0.0, 0.0)

    def beyond(self, x: float, y: float) -> float:
        """Return the distance of a place from the edge of the ground, metres."""
        return float(nearest(self.ground.edge, np.array([[x, y, 0.0]])).distance[0])

    def beyond_at(self, place: Vec2, by: float) -> str:
        """Return a sentence that a place is beyond the ground by so many metres."""
        return f"at [{place[0]:.1f}, {place[1]:.1f}] it is {by:.1f} m beyond the ground of `{self.file}`"

    def least_over(self, times: Sequence[float], points: Sequence[Vec3]) -> Vec2 | None:
        """Return the time and the value of the least height of a polyline above ground.

        times : seconds, rising; points : metres of W. The height is in metres, negative below the ground. The
        result is None if no part of the way is over ground.
        """
        t, p = np.array(times), np.array(points)
        lows: list[tuple[float, float]] = []
        for i in range(0, len(t) - 1, WAYS_AT_ONCE):
            which = slice(i, min(i + WAYS_AT_ONCE, len(t) - 1) + 1)
            start, end = p[which][:-1], p[which][1:]
            segments = Pieces(t[which][:-1], t[which][1:], np.stack([start, end], axis=1))
            least = least_where_ground(segments, self.ground, lambda _: CLOSED_M)
            lows.append((least.attained, least.at))
        over, at = min(lows, default=(inf, 0.0))
        return (at, over) if isfinite(over) else None

    def z(self, x: float, y: float) -> float:
        """Return z of the ground at a place, metres, 0 where there is none."""
        return self.height(x, y) or 0.0

    def height(self, x: float, y: float) -> float | None:
        """Return z of the ground at a place, metres; None where there is no ground."""
        height = float(height_at(self.ground, np.array([[x, y]]))[0])
        return None if isnan(height) else height


def ground_heights(mission: MissionIR, xy: Array) -> Array:
    """Return z of the ground at places (N, 2), metres of W, shape (N,).

    ``mission.ground`` does so for one.
    """
    if mission.terrain is None:
        return np.zeros(len(xy))
    return np.nan_to_num(height_at(mission.terrain.ground, xy))
