"""How high a fleet is above the ground, which may rise, and how near its bodies come to it.

As for a filming drone (``verify.above_ground``), of all drones at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, isfinite

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces
from shotc.geom.proof import inf_channel, sup_convex
from shotc.geom.surface.ground import height_at
from shotc.geom.surface.height import inf_height, sup_height
from shotc.geom.surface.near import nearest
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, gap, known, less
from shotc.passes.verify.fleets.flight import FleetFlight, bounded
from shotc.passes.verify.fleets.surfaces import near_surface, once


def above_ground(flight: FleetFlight, free: FleetPieces) -> Iterator[Claim]:
    """Claim the ground clearance, the bodies' distance from terrain, and the greatest height above ground.

    free : the flight apart from take-off and landing
    """
    if not len(free.low):
        return
    rules, radius, terrain = flight.mission.rules, flight.fleet.radius, flight.mission.terrain
    limit = Limit("ground clearance", rules.ground_clearance, "m", ("rules", "ground_clearance"), upper=False)
    aim, every = gap(rules.ground_clearance + radius), free.bag()
    if terrain is None:
        yield bounded(flight, limit, less(inf_channel(every, 2, aim), radius), lambda p: p[:, 2])
    else:
        every = once(every)
        low = known(inf_height(every, terrain.ground, aim), -inf)
        yield bounded(flight, limit, less(low, radius), _over(terrain, -inf))
        yield _beside(flight, every, terrain)
    most = rules.max_height
    if most is None or not isfinite(most):
        return
    limit = Limit("height above ground", most, "m", ("rules", "max_height"))
    if terrain is None:
        high = sup_convex(every, lambda c: c[..., 2], gap(most))
        yield bounded(flight, limit, high, lambda p: p[:, 2])
    else:
        high = known(sup_height(every, terrain.ground, gap(most)), inf)
        yield bounded(flight, limit, high, _over(terrain, inf))


def _beside(flight: FleetFlight, every: Pieces, terrain: Terrain) -> Claim:
    radius, surface = flight.fleet.radius, terrain.ground.surface
    near = near_surface(every, surface, gap(radius))
    limit = Limit("distance from terrain", 0.0, "m", terrain.path, upper=False)
    return bounded(flight, limit, less(near, radius), lambda p: nearest(surface, p).distance)


def _over(terrain: Terrain, unknown: float) -> Callable[[Array], Array]:
    """Return a function that gives the heights of points above ground; unknown : where there is none."""

    def over(p: Array) -> Array:
        height = height_at(terrain.ground, p[:, :2])
        return np.where(np.isnan(height), unknown, p[:, 2] - np.nan_to_num(height))

    return over
