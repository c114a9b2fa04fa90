"""Terrain as a part of a drone's free space: the least height above it, and the greatest.

Heights are vertical: from the ground below the drone's centre to the centre. The greatest height is
implemented as the least height over the ground turned upside down.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.surface.ground import Ground, NoGround, height_at
from shotc.geom.surface.ground_planes import ground_planes
from shotc.geom.surface.height import inf_height
from shotc.geom.surface.planes import Kept, Planes
from shotc.geom.surface.tree import in_plan, surface_of
from shotc.ir.owners import CEILING, GROUND, Owner

OUTSIDE_M = 1e3  # metres of lack where there is no ground
WIDTH_M, WIDTH_SHARE = 1.0, 0.1  # metres, plus a share of the reach: ground around a piece below its plane
NARROWER_M = (0.3, 0.0)
"""The same if the plane would exclude a piece as it is, for instance between slopes on both sides."""
FITS_M = 1e-9  # metres, tolerance of a piece below its plane
CLOSED_M = 5e-7  # metres, gap of the proved heights of pieces
_UPSIDE_DOWN = np.array([1.0, 1.0, -1.0])


@dataclass(frozen=True, slots=True, eq=False)
class OverGround:
    """A bound on the height of a drone's centre above ground; the greatest height, where all is upside down.

    owner : of the rule that states it
    clearance : vertical distance from the ground, metres
    flipped : whether ground and clearance are given upside down, z for -z
    """

    owner: Owner
    ground: Ground
    clearance: float
    flipped: bool = False

    def owner_at(self, _: Array) -> Owner:
        """Return the owner, which is the same at every place, shape (3,)."""
        return self.owner

    def lowered(self, metres: float) -> OverGround:
        """Return the bound with its clearance reduced by ``metres``."""
        return replace(self, clearance=self.clearance - metres)

    def lowest(self, xy: Array) -> Array:
        """Return the least heights at places (N, 2), metres of W; unreachable ones without ground.

        The ground must not be flipped.
        """
        height = height_at(self.ground, xy)
        return np.where(np.isnan(height), OUTSIDE_M, height) + self.clearance

    def highest(self, xy: Array) -> Array:
        """Return the greatest heights at places (N, 2), metres of W; infinite without ground.

        The ground must be flipped.
        """
        height = height_at(self.ground, xy)
        return np.where(np.isnan(height), np.inf, -height - self.clearance)

    def slack(self, p: Array) -> Array:
        """Return the slack of points (N, 3) over the bound, metres; shape (N,)."""
        height, z = height_at(self.ground, p[:, :2]), self._turned(p)[:, 2]
        return np.where(np.isnan(height), -OUTSIDE_M, z - height - self.clearance)

    def planes(self, hulls: Array, reach: float, margin: Kept) -> Planes:
        """Return half-spaces for the pieces that come within ``reach`` metres of the bound.

        hulls : shape (P, m, 3)
        margin : margin as a function of the slack, metres
        """
        hulls, parts = self._turned(hulls), []
        left = np.arange(len(hulls))
        for width in (WIDTH_M + WIDTH_SHARE * reach, *NARROWER_M):
            planes = ground_planes(self.ground, hulls[left], width, self.clearance, margin)
            planes = replace(planes, piece=left[planes.piece])
            slack = np.einsum("rmd,rd->rm", hulls[planes.piece], planes.normal).min(axis=1) - planes.offset
            fits = (slack >= -FITS_M) | (width == NARROWER_M[-1])
            parts.append(_picked(planes, fits & (slack < reach)))
            left = planes.piece[~fits]
            if not len(left):
                break
        return Planes(
            np.concatenate([part.piece for part in parts]),
            np.concatenate([part.triangle for part in parts]),
            self._turned(np.concatenate([part.normal for part in parts])),
            np.concatenate([part.offset for part in parts]),
            np.zeros(len(hulls), dtype=bool),
        )

    def lack(self, hulls: Array) -> Array:
        """Return the metres by which each piece, shape (P, m, 3), lacks its clearance; (P,), <= 0 is proved.

        A plane above the ground below a piece is tried first; pieces that it does not prove are bounded by
        branch and bound.
        """
        hulls = self._turned(hulls)
        planes = ground_planes(self.ground, hulls, 0.0, self.clearance, np.zeros_like)
        lack = np.full(len(hulls), OUTSIDE_M)
        lack[planes.piece] = planes.offset - np.einsum("rmd,rd->rm", hulls[planes.piece], planes.normal).min(
            axis=1
        )
        for i in np.flatnonzero((lack > 0.0) | self._ends_below(hulls)):
            piece = Pieces(np.zeros(1), np.ones(1), hulls[[i]])
            bound = inf_height(piece, self.ground, lambda _: CLOSED_M)
            lack[i] = OUTSIDE_M if isinstance(bound, NoGround) else self.clearance - bound.proven
        return lack

    def _ends_below(self, hulls: Array) -> Mask:
        """Return whether the ground may end below pieces, shape (P, m, 3): an edge is in their box."""
        low, high = hulls[..., :2].min(axis=1), hulls[..., :2].max(axis=1)
        below = np.zeros(len(hulls), dtype=bool)
        below[in_plan(self.ground.edge, low, high).item] = True
        return below

    def _turned(self, p: Array) -> Array:
        return p * _UPSIDE_DOWN if self.flipped else p


def heights_over(ground: Ground, least: float, greatest: float | None) -> tuple[OverGround, ...]:
    """Return the bounds of the height of a drone's centre above ground, metres; the greatest only if
    given.
    """
    low = OverGround(GROUND, ground, least)
    if greatest is None:
        return (low,)
    return low, OverGround(CEILING, _upside_down(ground), -greatest, flipped=True)


@lru_cache(maxsize=2)
def _upside_down(ground: Ground) -> Ground:
    """Return ground upside down; cached, because a mission asks for it often and its tree takes time."""
    return replace(ground, surface=surface_of(ground.surface.triangles * _UPSIDE_DOWN))


def _picked(planes: Planes, which: Mask) -> Planes:
    return Planes(
        planes.piece[which],
        planes.triangle[which],
        planes.normal[which],
        planes.offset[which],
        planes.crowded,
    )
