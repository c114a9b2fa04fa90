"""The distance of the body from scenes and buildings, proved at every instant.

The distance is Euclidean without a sign. A flight that starts outside of closed parts, and never touches
their triangles, is never inside.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces
from shotc.geom.proof import ProvedExtreme
from shotc.geom.surface.distance import inf_distance
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap, less


def beside_meshes(flight: JudgedFlight, free: Pieces, upright: Pieces) -> Iterator[Claim]:
    """Yield claims on the distance from scenes and buildings, in flight and during take-off and landing.

    A point of a cloud represents a ball of half its spacing, which is subtracted from the distance.

    free : the flight without take-off and landing
    upright : take-off and landing
    """
    radius, home = flight.drone.radius, np.array([flight.drone.home])
    least = flight.mission.rules.obstacle_clearance
    for mesh in flight.mission.meshes:
        name, body = f"distance from {mesh.kind}", radius + mesh.spacing
        if len(free):
            bound = _signed(inf_distance(free, mesh.surface, gap(body + least)), mesh, home)
            limit = Limit(name, least, "m", ("rules", "obstacle_clearance"), upper=False)
            yield bounded(flight, limit, less(bound, body))
        if len(upright):
            # The body may be as near as on its pad, but no nearer.
            near = min(body, float(abs(mesh.signed_distance(home)[0])))
            bound = inf_distance(upright, mesh.surface, gap(near))
            limit = Limit(f"{name} at home", near - body, "m", mesh.path, upper=False)
            yield bounded(flight, limit, less(bound, body))


def _signed(bound: ProvedExtreme, mesh: ObstacleMesh, home: Array) -> ProvedExtreme:
    """Return a bound of the distance; negative if the flight starts inside of a closed part."""
    return ProvedExtreme(-bound.attained, -bound.attained, bound.at) if mesh.holds(home)[0] else bound
