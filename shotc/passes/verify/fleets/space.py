"""Check the positions of a fleet: zones, the ground, targets, and vertical motion above its pads.

The rules are those of a drone with a camera (``verify.space``). Most of a fleet is far from any one solid:
drones whose boxes are farther away than the nearest drone found so far are skipped.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces, cut, join
from shotc.geom.proof import ProvedExtreme, box_gap, inf_distance, norm, sup_convex, sup_outside
from shotc.geom.solid_arrays.points import separation, signed_distance
from shotc.geom.solids import Solid, convex_parts
from shotc.geom.track_array import places
from shotc.ir.mission import Zone
from shotc.ir.origin import KeyPath
from shotc.ir.sampling import beside
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, gap, less
from shotc.passes.verify.fleets.flight import FleetFlight, Span, bounded, of_drone, worse
from shotc.passes.verify.fleets.surfaces import Upright, above_ground, beside_meshes
from shotc.passes.verify.space import DRIFT_M

SEED_PIECES = 256
"""Number of pieces, the nearest by their boxes, for the first bound."""

BATCH_PIECES = 50_000
"""Most pieces that are checked against a keep-in zone at once; its footprint may have a thousand corners."""

Gap = Callable[[float], float]


def space(flight: FleetFlight) -> Iterator[Claim]:
    """Yield claims on zones, ground and target clearance, and vertical motion at the pads."""
    free = flight.flown.between(flight.free())
    upright = [(flight.flown.between(spans), pads) for spans, pads in flight.verticals()]
    for zone in flight.mission.zones:
        if zone.keep == "out":
            limit = _clear(f"zone {zone.name}", 0.0, zone.path)
            yield from _keep_out(flight, limit, zone.solid, (free, upright))
        else:
            yield _keep_in(flight, zone, free, [pieces for pieces, _ in upright])
    yield from above_ground(flight, free)
    yield from beside_meshes(flight, free, upright)
    rules = flight.mission.rules
    for target in flight.mission.targets:
        limit = _clear(f"target {target.name}", rules.target_clearance, ("rules", "target_clearance"))
        if target.track is None:
            yield from _keep_out(flight, limit, target.kept_clear, (free, upright))
        else:
            yield from _keep_from(flight, limit, target)
    if upright:
        yield from _vertical(flight, upright)


def _clear(name: str, clearance: float, path: KeyPath) -> Limit:
    return Limit(name, clearance, "m", path, upper=False)


def _keep_out(
    flight: FleetFlight, limit: Limit, solid: Solid, parts: tuple[FleetPieces, Upright]
) -> Iterator[Claim]:
    free, upright = parts
    radius = flight.fleet.radius
    if len(free.low):
        bound = nearest(free.bag(), solid, gap(radius + limit.value))
        yield bounded(flight, limit, less(bound, radius), lambda p: signed_distance(solid, p))
    if upright:
        limit = _clear(f"{limit.constraint} at home", 0.0, limit.path)
        yield worse(limit, [_at_home(flight, limit, solid, part) for part in upright])


def _at_home(flight: FleetFlight, limit: Limit, solid: Solid, part: tuple[FleetPieces, Array]) -> Claim:
    """Return the claim that no drone is nearer to a solid on its vertical than on its pad."""
    upright, pads = part
    radius = flight.fleet.radius
    near = np.minimum(radius, np.min([separation(s, pads)[0] for s in convex_parts(solid)], axis=0))
    clear = near >= radius
    bounds = []
    if clear.any():
        some = FleetPieces(upright.low, upright.high, upright.ctrl[clear])
        bounds.append(less(nearest(some.bag(), solid, gap(radius)), radius))
    for drone in np.flatnonzero(~clear):
        bound = inf_distance(upright.of(int(drone)), solid, gap(near[drone]))
        bounds.append(less(bound, float(near[drone])))
    worst = min(bounds, key=lambda bound: bound.proven)
    return bounded(flight, limit, worst, lambda p: signed_distance(solid, p) - near)


def nearest(pieces: Pieces, solid: Solid, gap: Gap) -> ProvedExtreme:
    """Return a bound on the distance of many pieces from a solid, as ``inf_distance`` does."""
    if len(pieces) > SEED_PIECES:
        apart = box_gap(pieces.ctrl, solid)
        seeds = np.zeros(len(pieces), dtype=bool)
        seeds[np.argpartition(apart, SEED_PIECES)[:SEED_PIECES]] = True
        reached = inf_distance(pieces.pick(seeds), solid, gap).attained
        pieces = pieces.pick(apart <= max(reached, 0.0))
    return inf_distance(pieces, solid, gap)


def _keep_from(flight: FleetFlight, limit: Limit, target: Target) -> Iterator[Claim]:
    """Yield claims on the distance from a moving target; on its vertical a drone may be as near as at
    time 0.
    """
    radius, spans = flight.fleet.radius, flight.free()
    if spans:
        near = np.full(len(flight.pads), radius + limit.value)
        yield _from_moving(flight, limit, (target, spans), near)
    limit = _clear(f"{limit.constraint} at home", 0.0, limit.path)
    bounds = [
        _from_moving(flight, limit, (target, upright), np.minimum(radius, _off(target, pads)))
        for upright, pads in flight.verticals()
    ]
    if bounds:
        yield worse(limit, bounds)


def _off(target: Target, points: Array) -> Array:
    """Return the distances of points from a target at time 0; 0 inside."""
    return np.maximum(signed_distance(target.kept_clear, points), 0.0)


def _from_moving(flight: FleetFlight, limit: Limit, of: tuple[Target, list[Span]], near: Array) -> Claim:
    """Return the claim on the distance from a moving target minus each drone's clearance.

    Drones are bounded one by one, the nearest boxes first, until the boxes exclude all others.
    """
    target, spans = of
    apart = _boxes_apart(flight.flown.between(spans), target) - near
    worst, nearest = ProvedExtreme(inf, inf, 0.0), 0
    for drone in np.argsort(apart, kind="stable"):
        if apart[drone] > worst.attained:
            break
        curve = beside(Piecewise(flight.track.breaks, flight.flown.ctrl[drone]), target)
        parts = join([cut(curve, *span) for span in spans])
        keep = float(near[drone])
        bound = less(inf_distance(parts, target.kept_clear, gap(keep)), keep)
        if bound.proven < worst.proven:
            worst, nearest = bound, int(drone)
    return of_drone(flight, limit, (worst.proven + limit.value, worst.at), nearest, "bounded")


def _boxes_apart(flown: FleetPieces, target: Target) -> Array:
    """Return the least distance of each drone's boxes from a moving target's box at the time, shape (n,)."""
    assert target.track is not None
    rows = np.array(target.track.times)
    half = np.array([target.radius, target.radius, target.height / 2])
    best = np.full(len(flown.ctrl), inf)
    for k, (low, high) in enumerate(zip(flown.low, flown.high, strict=True)):
        inside = rows[(rows > low) & (rows < high)]
        positions = places(target.track, np.concatenate([[low], inside, [high]]))
        least, most = positions.min(axis=0) - half, positions.max(axis=0) + half
        hulls = flown.ctrl[:, k]
        gaps = np.maximum(np.maximum(hulls.min(axis=1) - most, least - hulls.max(axis=1)), 0.0)
        best = np.minimum(best, norm(gaps))
    return best


def _keep_in(flight: FleetFlight, zone: Zone, free: FleetPieces, upright: list[FleetPieces]) -> Claim:
    radius = flight.fleet.radius
    worst, floor = ProvedExtreme(-inf, -inf, 0.0), True
    for parts, with_floor in ((free, True), *((part, False) for part in upright)):
        for pieces in _batches(parts.bag()):
            bound = sup_outside(pieces, zone.solid, gap(-radius), floor=with_floor)
            if bound.proven > worst.proven:
                worst, floor = bound, with_floor
    solid = zone.solid if floor else zone.solid._replace(bottom=-inf)
    margin = ProvedExtreme(-worst.proven, -worst.attained, worst.at)
    limit = _clear(f"zone {zone.name}", 0.0, zone.path)
    return bounded(flight, limit, less(margin, radius), lambda p: -signed_distance(solid, p))


def _batches(pieces: Pieces) -> Iterator[Pieces]:
    for k in range(0, len(pieces), BATCH_PIECES):
        part = slice(k, k + BATCH_PIECES)
        yield Pieces(pieces.low[part], pieces.high[part], pieces.ctrl[part])


def _vertical(flight: FleetFlight, upright: Upright) -> Iterator[Claim]:
    path = flight.key("layout")
    limit = Limit("drift from the vertical", DRIFT_M, "m", path)
    below = Limit("depth below home", 0.0, "m", path)
    yield worse(limit, [_drift(flight, limit, part) for part in upright])
    yield worse(below, [_sunk(flight, below, part) for part in upright])


def _drift(flight: FleetFlight, limit: Limit, part: tuple[FleetPieces, Array]) -> Claim:
    pads = part[1]
    bound = sup_convex(_from_pads(*part).channels(0, 1), norm, gap(DRIFT_M))
    return bounded(flight, limit, bound, lambda p: norm((p - pads)[:, :2]))


def _sunk(flight: FleetFlight, limit: Limit, part: tuple[FleetPieces, Array]) -> Claim:
    pads = part[1]
    bound = sup_convex(_from_pads(*part), lambda c: -c[..., 2], gap(0.0))
    return bounded(flight, limit, bound, lambda p: (pads - p)[:, 2])


def _from_pads(upright: FleetPieces, pads: Array) -> Pieces:
    return FleetPieces(upright.low, upright.high, upright.ctrl - pads[:, None, None]).bag()
