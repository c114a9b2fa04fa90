"""The height of a flight above the ground, and the distance of its body from terrain, scenes and buildings.

Above flat ground both are the z of its lowest point. Above terrain the height is vertical, as in air traffic
rules, and the distance is Euclidean, because a cliff is beside a drone and not below it. The distance from
scenes and buildings has no sign: a flight that starts outside of closed parts, and never touches their
triangles, is never inside.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces, cut
from shotc.geom.proof import ProvedExtreme, inf_channel, sup_convex
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.height import inf_height, sup_height
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap, known, less


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


def above_ground(flight: JudgedFlight, free: Pieces) -> Iterator[Claim]:
    """Yield claims on ground clearance, distance from terrain, and greatest height above ground.

    free : the flight without take-off and landing
    """
    rules, radius, terrain = flight.mission.rules, flight.drone.radius, flight.mission.terrain
    path = ("rules", "ground_clearance")
    limit = Limit("ground clearance", rules.ground_clearance, "m", path, upper=False)
    aim = gap(rules.ground_clearance + radius)
    if terrain is None:
        yield bounded(flight, limit, less(inf_channel(free, 2, aim), radius))
    else:
        low = inf_height(free, terrain.ground, aim)
        yield bounded(flight, limit, less(known(low, -inf), radius))
        near = inf_distance(free, terrain.ground.surface, gap(radius))
        body = Limit("distance from terrain", 0.0, "m", terrain.path, upper=False)
        yield bounded(flight, body, less(near, radius))
    if rules.max_height is None or not isfinite(rules.max_height):
        return
    whole = flight.track.curve.channels(0, 1, 2)
    pieces, most = cut(whole, whole.start, whole.end), gap(rules.max_height)
    limit = Limit("height above ground", rules.max_height, "m", ("rules", "max_height"))
    if terrain is None:
        high = sup_convex(pieces, lambda c: c[..., 2], most)
    else:
        high = known(sup_height(pieces, terrain.ground, most), inf)
    yield bounded(flight, limit, high)
