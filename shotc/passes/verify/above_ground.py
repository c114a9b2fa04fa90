"""The height of a flight above the ground, and the distance of its body from terrain.

Above flat ground both are the z of its lowest point. Above terrain the height is vertical, as in air traffic
rules, and the distance is Euclidean, because a cliff is beside a drone and not below it.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite

from shotc.geom.pieces import Pieces, cut
from shotc.geom.proof import inf_channel, sup_convex
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.height import inf_height, sup_height
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap, known, less


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
