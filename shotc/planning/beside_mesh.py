"""The distance of a drone's centre from the triangles of a scene or of buildings."""

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

FAR_M = 4.0  # metres beyond the clearance, up to which distances are measured
CLOSED_M = 5e-7  # metres, gap of the proved distances of pieces


@dataclass(frozen=True, slots=True, eq=False)
class BesideMesh:
    """A mesh from whose triangles the drone's centre keeps ``clearance`` metres.

    A path that starts outside of closed parts, and keeps away from all triangles, stays outside.
    """

    owner: Owner
    mesh: ObstacleMesh
    clearance: float

    def owner_at(self, p: Array) -> Owner:
        """Return the owner of the part nearest to a point (3,): a building, or a part of a scene."""
        x, y, z = map(float, p)
        return part_owner(self.mesh, (x, y, z))

    def lowered(self, metres: float) -> BesideMesh:
        """Return the mesh with its clearance reduced by ``metres``, to 0 at least."""
        return replace(self, clearance=max(0.0, self.clearance - metres))

    def slack(self, p: Array) -> Array:
        """Return the slack of points (N, 3) over the clearance, metres, inf beyond FAR_M; (N,).

        Inside of closed parts the slack is minus the clearance and the distance to the surface, up to FAR_M
        of it.
        """
        return self.mesh.signed_distance(p, self.clearance + FAR_M) - self.clearance

    def stops(self, a: Array, b: Array, margin: float) -> Mask:
        """Return which segments a-b, shapes (N, 3), are too near; (N,).

        margin : metres kept beyond the clearance, less where an end is nearer (as in ``free_space.required``)
        """
        allowance = np.minimum(margin, 0.5 * np.maximum(np.minimum(self.slack(a), self.slack(b)), 0.0))
        near = comes_within(self.mesh.surface, a, b, self.clearance + allowance - 1e-9)
        return np.asarray(near | self.mesh.holds(a) | self.mesh.holds(b))

    def planes(self, hulls: Array, reach: float, margin: Kept) -> Planes:
        """Return half-spaces for the pieces that come within ``reach`` metres of the clearance.

        hulls : shape (P, m, 3)
        margin : margin as a function of the slack, metres
        """
        return half_spaces(self.mesh.surface, hulls, self.clearance, reach, margin)

    def lack(self, hulls: Array) -> Array:
        """Return the metres by which each piece, shape (P, m, 3), lacks its clearance; (P,), <= 0 is proved.

        Planes between the pieces and the triangles are tried first; pieces that they do not prove are bounded
        by branch and bound.
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
