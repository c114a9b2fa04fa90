"""Terrain as a part of a drone's free space: the least height above it, and the greatest.

Both are upright: the centre of the drone is so many metres above the ground below it. The greatest height is
the least one upside down.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces
from shotc.geom.surface.ground import Ground, NoGround, height_at
from shotc.geom.surface.ground_planes import ground_planes
from shotc.geom.surface.height import inf_height
from shotc.geom.surface.planes import Kept, Planes
from shotc.geom.surface.tree import surface_of
from shotc.ir.owners import CEILING, GROUND, Owner

OUTSIDE_M = 1e3  # what is lacking where there is no ground
WIDTH_M, WIDTH_SHARE = 1.0, 0.1  # and of the reach: how far beyond a piece's box its plane is above ground
CLOSED_M = 5e-7  # gap to which heights of pieces are proved
STEP_M = 2.0  # between the places at which the ground below a way is looked at
STRIP_M = 3.0  # to either side of a way in which the ground counts
_UPSIDE_DOWN = np.array([1.0, 1.0, -1.0])
CORNERS_M = 15.0  # between corners of a way over the ground, at least


@dataclass(frozen=True, slots=True, eq=False)
class OverGround:
    """Where the centre of a drone is high enough above ground, or low enough where all is upside down.

    owner : of the rule that asks for it; clearance : metres above the ground, upright
    flipped : whether the ground is given upside down, z for -z, and the clearance with it
    """

    owner: Owner
    ground: Ground
    clearance: float
    flipped: bool = False

    def lowered(self, metres: float) -> OverGround:
        """Return the same with a clearance that much smaller."""
        return replace(self, clearance=self.clearance - metres)

    def lowest(self, xy: Array) -> Array:
        """Return the least heights at places (N, 2), metres of W; where there is no ground, out of reach.

        Of ground that is not flipped.
        """
        height = height_at(self.ground, xy)
        return np.where(np.isnan(height), OUTSIDE_M, height) + self.clearance

    def slack(self, p: Array) -> Array:
        """Return how far points (N, 3) are within the height that is asked, metres; shape (N,)."""
        height, z = height_at(self.ground, p[:, :2]), self._turned(p)[:, 2]
        return np.where(np.isnan(height), -OUTSIDE_M, z - height - self.clearance)

    def planes(self, hulls: Array, reach: float, kept: Kept) -> Planes:
        """Return half-spaces for the pieces that come within ``reach`` metres of the height that is asked.

        hulls : shape (P, m, 3); kept : the margin, given how much more than the clearance there is, metres
        """
        hulls = self._turned(hulls)
        found = ground_planes(self.ground, hulls, WIDTH_M + WIDTH_SHARE * reach, self.clearance, kept)
        slack = np.einsum("rmd,rd->rm", hulls[found.piece], found.normal).min(axis=1) - found.offset
        near = slack < reach
        return Planes(
            found.piece[near],
            found.triangle[near],
            self._turned(found.normal[near]),
            found.offset[near],
            found.crowded,
        )

    def lack(self, hulls: Array) -> Array:
        """Return by how much each piece, shape (P, m, 3), fails to prove its clearance; (P,), <= 0 is proved.

        A plane above the ground below a piece is quick; where it does not prove it, the piece is bounded.
        """
        hulls = self._turned(hulls)
        found = ground_planes(self.ground, hulls, 0.0, self.clearance, np.zeros_like)
        lack = np.full(len(hulls), OUTSIDE_M)
        lack[found.piece] = found.offset - np.einsum("rmd,rd->rm", hulls[found.piece], found.normal).min(
            axis=1
        )
        for i in np.flatnonzero(lack > 0.0):
            piece = Pieces(np.zeros(1), np.ones(1), hulls[[i]])
            bound = inf_height(piece, self.ground, lambda _: CLOSED_M)
            lack[i] = OUTSIDE_M if isinstance(bound, NoGround) else self.clearance - bound.proven
        return lack

    def _turned(self, p: Array) -> Array:
        return p * _UPSIDE_DOWN if self.flipped else p

    def over(self, way: Array, margin: float) -> Array:
        """Return a way, corners (K, 3), raised to where it keeps the clearance and a margin, metres.

        Over each of its legs it follows the upper hull of the heights that are needed along it.
        """
        legs = [self._leg(a, b, margin) for a, b in pairwise(way)]
        return np.concatenate([way[:1], *(leg[1:] for leg in legs)])

    def _leg(self, a: Array, b: Array, margin: float) -> Array:
        flat = float(np.linalg.norm(b[:2] - a[:2]))
        count = int(np.ceil(flat / STEP_M))
        if count < 2:
            return np.stack([a, b])
        share = np.linspace(0.0, 1.0, count + 1)
        straight = a + share[:, None] * (b - a)
        aside = np.array([a[1] - b[1], b[0] - a[0]]) / flat * STRIP_M
        strip = [self.lowest(straight[:, :2] + k * aside) for k in (-1.0, 0.0, 1.0)]
        needed = np.max(strip, axis=0) + margin
        if (needed[1:-1] <= straight[1:-1, 2]).all():
            return np.stack([a, b])
        nodes = np.linspace(0.0, 1.0, max(2, int(flat / CORNERS_M)) + 1)
        apart = float(nodes[1])
        heights = [needed[np.abs(share - node) <= apart].max() for node in nodes]
        heights[0], heights[-1] = a[2], b[2]
        corners = np.array(_upper_hull(nodes, np.array(heights)))
        way = a + nodes[corners, None] * (b - a)
        way[:, 2] = np.array(heights)[corners]
        return np.asarray(way)


def heights_over(ground: Ground, least: float, greatest: float | None) -> tuple[OverGround, ...]:
    """Return the least height of a drone's centre above ground, and the greatest, if there is one, metres."""
    low = OverGround(GROUND, ground, least)
    if greatest is None:
        return (low,)
    down = surface_of(ground.surface.triangles * _UPSIDE_DOWN)
    return low, OverGround(CEILING, replace(ground, surface=down), -greatest, flipped=True)


def _upper_hull(along: Array, height: Array) -> list[int]:
    """Return the indices of the upper hull of heights along a way."""
    hull: list[int] = []
    for i in range(len(along)):
        while len(hull) > 1 and _below(along, height, (hull[-2], hull[-1], i)):
            hull.pop()
        hull.append(i)
    return hull


def _below(along: Array, height: Array, points: tuple[int, int, int]) -> bool:
    """Tell whether the middle one of three points is on or below the line through the others."""
    i, j, k = points
    rise = (height[k] - height[i]) * (along[j] - along[i])
    return bool((height[j] - height[i]) * (along[k] - along[i]) <= rise)
