"""The height of a fleet above the ground, and the distance of its bodies from terrain, scenes and buildings.

The claims are those of a filming drone (``verify.surfaces``), for all drones at once. Pieces that boxes prove
to be far from a surface are not examined again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import inf, isfinite

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces
from shotc.geom.proof import ProvedExtreme, inf_channel, sup_convex
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.ground import height_at
from shotc.geom.surface.height import inf_height, sup_height
from shotc.geom.surface.near import nearest, some_distance
from shotc.geom.surface.tree import Surface, box_distances
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, gap, known, less
from shotc.passes.verify.fleets.flight import FleetFlight, bounded, worse

SEED_PIECES = 64
"""Pieces, the likeliest by their middles, of which the nearest place is found first."""
Upright = list[tuple[FleetPieces, Array]]


def once(pieces: Pieces) -> Pieces:
    """Return pieces of which those that stand are there once: a drone stands for many pieces in a row."""
    still = (pieces.ctrl == pieces.ctrl[:, :1]).all(axis=(1, 2))
    same = np.zeros(len(pieces), dtype=bool)
    same[1:] = still[1:] & still[:-1] & (pieces.ctrl[1:, 0] == pieces.ctrl[:-1, 0]).all(axis=1)
    return pieces.pick(~same)


def outside_of_mesh(
    flown: FleetPieces, start: tuple[float, Array], mesh: ObstacleMesh, least: float
) -> ProvedExtreme:
    """Bound the distance of a fleet's centres from a mesh, negative if one starts inside a closed body.

    A drone that starts outside, and never touches a triangle, stays outside. A point of a cloud stands for a
    ball of half its spacing, which is subtracted from the distance.

    start : the time, s, and the places then, shape (n, 3); flown : from then on
    least : the limit, metres, which determines the gap of the bound
    """
    time, places = start
    if mesh.holds(places).any():
        deep = float(mesh.signed_distance(places).min()) - mesh.spacing
        return ProvedExtreme(deep, deep, time)
    bound = near_surface(once(flown.bag()), mesh.surface, gap(least + mesh.spacing))
    return less(bound, mesh.spacing)


def near_surface(pieces: Pieces, surface: Surface, closed: Callable[[float], float]) -> ProvedExtreme:
    """Bound the infimum of the distance from a surface along many pieces, as ``inf_distance`` does."""
    if len(pieces) <= SEED_PIECES or not len(surface):
        return inf_distance(pieces, surface, closed)
    some = some_distance(surface, pieces.ctrl.mean(axis=1))
    seeds = np.zeros(len(pieces), dtype=bool)
    seeds[np.argpartition(some, SEED_PIECES)[:SEED_PIECES]] = True
    first_bound = inf_distance(pieces.pick(seeds), surface, closed)
    low, high = pieces.ctrl.min(axis=1), pieces.ctrl.max(axis=1)
    least = np.full(len(pieces), np.inf)
    for its_low, its_high in zip(surface.low[-1], surface.high[-1], strict=True):
        boxes = np.broadcast_to(its_low, low.shape), np.broadcast_to(its_high, high.shape)
        least = np.minimum(least, box_distances(low, high, *boxes))
    rest = ~seeds & (least < first_bound.attained)
    if not rest.any():
        return first_bound
    other = inf_distance(pieces.pick(rest), surface, closed)
    return min(first_bound, other, key=lambda bound: bound.proven)


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
