"""Where the centre of a drone is far enough from the triangles of a scene or of buildings."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.near import comes_within, within
from shotc.geom.surface.planes import Kept, Planes, half_spaces, separate
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.owners import Owner, part_owner

FAR_M = 4.0  # metres beyond the clearance to which distances are told: what is farther is infinitely far
CLOSED_M = 5e-7  # metres: gap to which distances of pieces are proved


@dataclass(frozen=True, slots=True, eq=False)
class BesideMesh:
    """A mesh from whose triangles the drone's centre keeps ``clearance`` metres.

    A way that begins outside of what is closed, and keeps away from all triangles, stays outside.
    """

    owner: Owner
    mesh: ObstacleMesh
    clearance: float

    def owner_at(self, p: Array) -> Owner:
        """Return the owner of what is nearest to a point (3,): a building, a part of a scene."""
        x, y, z = map(float, p)
        return part_owner(self.mesh, (x, y, z))

    def lowered(self, metres: float) -> BesideMesh:
        """Return the same with a clearance that much smaller, 0 at least."""
        return replace(self, clearance=max(0.0, self.clearance - metres))

    def slack(self, p: Array) -> Array:
        """Return how much farther than the clearance points (N, 3) are, metres, inf beyond FAR_M; (N,).

        Points inside of what is closed lack the clearance and their distance, up to FAR_M of it.
        """
        return self.mesh.signed_distance(p, self.clearance + FAR_M) - self.clearance

    def stops(self, a: Array, b: Array, margin: float) -> Mask:
        """Tell which segments a-b, shapes (N, 3), come too near; (N,).

        margin : metres kept beyond the clearance, less where an end is nearer (``free_space.margin_at``)
        """
        room = np.minimum(margin, 0.5 * np.maximum(np.minimum(self.slack(a), self.slack(b)), 0.0))
        near = comes_within(self.mesh.surface, a, b, self.clearance + room - 1e-9)
        return np.asarray(near | self.mesh.holds(a) | self.mesh.holds(b))

    def planes(self, hulls: Array, reach: float, kept: Kept) -> Planes:
        """Return half-spaces for the pieces that come within ``reach`` metres of the clearance.

        hulls : shape (P, m, 3); kept : the margin, given how much more than the clearance there is, metres
        """
        return half_spaces(self.mesh.surface, hulls, self.clearance, reach, kept)

    def lack(self, hulls: Array) -> Array:
        """Return by how much each piece, shape (P, m, 3), fails to prove its clearance; (P,), <= 0 is proved.

        Planes between the pieces and the triangles are quick; a piece that they do not prove is bounded.
        """
        pairs = within(self.mesh.surface, hulls.min(axis=1), hulls.max(axis=1), self.clearance)
        gap = np.full(len(hulls), np.inf)
        if len(pairs):
            _, its = separate(self.mesh.surface.triangles[pairs.triangle], hulls[pairs.item])
            np.minimum.at(gap, pairs.item, its)
        for i in np.flatnonzero(gap < self.clearance):
            piece = Pieces(np.zeros(1), np.ones(1), hulls[[i]])
            gap[i] = inf_distance(piece, self.mesh.surface, lambda _: CLOSED_M).proven
        return self.clearance - gap
