"""How near the body comes to the triangles of scenes and buildings, proved for every instant.

The distance is Euclidean and has no sign. A flight that begins outside of what is closed, and never touches
its triangles, never is inside of it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces
from shotc.geom.proof import Bound
from shotc.geom.surface.distance import inf_distance
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Flight, Limit, bounded, gap, less


def beside_meshes(flight: Flight, free: Pieces, upright: Pieces) -> Iterator[Claim]:
    """Claim the distance of the body from scenes and buildings, and that on take-off and landing.

    free : the flight apart from take-off and landing; upright : those
    A point of a cloud stands for a ball of half its spacing, which is taken off the distance.
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
            # The body may stand as near as its pad does, but no nearer.
            near = min(body, float(abs(mesh.signed_distance(home)[0])))
            bound = inf_distance(upright, mesh.surface, gap(near))
            limit = Limit(f"{name} at home", near - body, "m", mesh.path, upper=False)
            yield bounded(flight, limit, less(bound, body))


def _signed(bound: Bound, mesh: ObstacleMesh, home: Array) -> Bound:
    """Return a bound of the distance, negative for a flight that begins inside of what is closed."""
    return Bound(-bound.attained, -bound.attained, bound.at) if mesh.holds(home)[0] else bound
