"""How near the bodies of a fleet come to the triangles of scenes and buildings, proved for every instant.

As for a filming drone (``verify.beside_meshes``), of all drones at once. A drone that begins outside of what
is closed, and never touches its triangles, never is inside of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.proof import ProvedExtreme
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, gap, less
from shotc.passes.verify.fleets.flight import FleetFlight, bounded, worse
from shotc.passes.verify.fleets.surfaces import near_surface, once, outside_of_mesh

Upright = list[tuple[FleetPieces, Array]]


def beside_meshes(flight: FleetFlight, free: FleetPieces, upright: Upright) -> Iterator[Claim]:
    """Claim the distance of the bodies from scenes and buildings, and that on take-off and landing.

    free : the flight apart from take-off and landing; upright : those, with the pads that they are above
    A point of a cloud stands for a ball of half its spacing, which is taken off the distance.
    """
    least = flight.mission.rules.obstacle_clearance
    for mesh in flight.mission.meshes:
        name, body = f"distance from {mesh.kind}", flight.fleet.radius + mesh.spacing
        if len(free.low):
            limit = Limit(name, least, "m", ("rules", "obstacle_clearance"), upper=False)
            yield _clear(flight, limit, mesh, free)
        if upright:
            limit = Limit(f"{name} at home", 0.0, "m", mesh.path, upper=False)
            yield worse(limit, [_at_home(flight, limit, (mesh, body), part) for part in upright])


def _clear(flight: FleetFlight, limit: Limit, mesh: ObstacleMesh, free: FleetPieces) -> Claim:
    """Claim a distance of all drones; one that begins inside of something is inside of it."""
    start = float(flight.track.breaks[0]), flight.pads
    radius = flight.fleet.radius
    bound = outside_of_mesh(free, start, mesh, radius + limit.value)
    return bounded(flight, limit, less(bound, radius), mesh.signed_distance)


def _at_home(
    flight: FleetFlight, limit: Limit, of: tuple[ObstacleMesh, float], part: tuple[FleetPieces, Array]
) -> Claim:
    """Claim that no drone comes nearer on its vertical than its body is on its pad."""
    (mesh, body), (upright, pads) = of, part
    near = np.minimum(body, np.abs(mesh.signed_distance(pads)))
    clear = near >= body
    worst = ProvedExtreme(inf, inf, 0.0)
    if clear.any():
        some = FleetPieces(upright.low, upright.high, upright.ctrl[clear])
        worst = less(near_surface(once(some.bag()), mesh.surface, gap(body)), body)
    for drone in np.flatnonzero(~clear):
        keep = float(near[drone])
        bound = less(near_surface(once(upright.of(int(drone))), mesh.surface, gap(keep)), keep)
        worst = bound if bound.proven < worst.proven else worst
    return bounded(flight, limit, worst, partial(_beyond, mesh, near))


def _beyond(mesh: ObstacleMesh, near: Array, p: Array) -> Array:
    """Return how much farther from a mesh drones are than on their pads, shape (n,)."""
    return np.asarray(np.abs(mesh.signed_distance(p)) - near)
