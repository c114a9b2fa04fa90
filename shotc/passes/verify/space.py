"""Check the positions of the drone: zones, the ground, targets, and vertical motion at home.

Take-off and landing are vertical at home. There neither clearances nor the floors of keep-in zones apply, and
the body may be as near to a solid as it is on its pad, but no nearer.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from shotc.geom.pieces import Pieces, cut, join
from shotc.geom.proof import ProvedExtreme, inf_distance, norm, sup_convex, sup_outside
from shotc.geom.solids import Solid, distance
from shotc.ir.mission import Zone
from shotc.ir.phases import UPRIGHT
from shotc.ir.sampling import beside
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap, less
from shotc.passes.verify.surfaces import above_ground, beside_meshes

DRIFT_M = 1e-6
"""Largest deviation of take-off and landing from the vertical, metres."""


def space(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield claims on zones, ground and target clearance, and vertical motion at home."""
    free, upright = _split(flight)
    for zone in flight.mission.zones:
        if zone.keep == "out":
            limit = Limit(f"zone {zone.name}", 0.0, "m", zone.path, upper=False)
            yield from _keep_out(flight, limit, zone.solid, (free, upright))
        else:
            yield _keep_in(flight, zone, free, upright)
    rules = flight.mission.rules
    yield from above_ground(flight, free) if len(free) else ()
    yield from beside_meshes(flight, free, upright)
    for target in flight.mission.targets:
        near = (free, upright) if target.track is None else _split(flight, target)
        path = ("rules", "target_clearance")
        limit = Limit(f"target {target.name}", rules.target_clearance, "m", path, upper=False)
        yield from _keep_out(flight, limit, target.kept_clear, near)
    if len(upright):
        yield from _vertical(flight, upright)


def _split(flight: JudgedFlight, target: Target | None = None) -> tuple[Pieces, Pieces]:
    """Return the flight without take-off and landing, and these; relative to a target if one is given."""
    curve = flight.track.curve.channels(0, 1, 2)
    if target is not None:
        curve = beside(curve, target)
    empty = [cut(curve, curve.start, curve.start)]
    phases = flight.track.phases
    free = [cut(curve, p.start, p.end) for p in phases if p.name not in UPRIGHT]
    upright = [cut(curve, p.start, p.end) for p in phases if p.name in UPRIGHT]
    return join(empty + free), join(empty + upright)


def _keep_out(
    flight: JudgedFlight, limit: Limit, solid: Solid, parts: tuple[Pieces, Pieces]
) -> Iterator[Claim]:
    """Yield claims on the distance from a solid; parts : as of ``_split``."""
    free, upright = parts
    radius = flight.drone.radius
    if len(free):
        bound = inf_distance(free, solid, gap(radius + limit.value))
        yield bounded(flight, limit, less(bound, radius))
    if len(upright):
        near = min(radius, distance(solid, flight.drone.home))
        bound = inf_distance(upright, solid, gap(near))
        at_home = replace(limit, constraint=f"{limit.constraint} at home", value=near - radius)
        yield bounded(flight, at_home, less(bound, radius))


def _keep_in(flight: JudgedFlight, zone: Zone, free: Pieces, upright: Pieces) -> Claim:
    radius = flight.drone.radius
    bounds = [
        sup_outside(pieces, zone.solid, gap(-radius), floor=floor)
        for pieces, floor in ((free, True), (upright, False))
    ]
    worst = max(bounds, key=lambda bound: bound.proven)
    margin = ProvedExtreme(-worst.proven, -worst.attained, worst.at)
    return bounded(flight, Limit(f"zone {zone.name}", 0.0, "m", zone.path, upper=False), less(margin, radius))


def _vertical(flight: JudgedFlight, upright: Pieces) -> Iterator[Claim]:
    home, path = np.array(flight.drone.home), (*flight.drone.path, "home")
    drift = sup_convex(upright, lambda c: norm(c[..., :2] - home[:2]), gap(DRIFT_M))
    yield bounded(flight, Limit("drift from the vertical", DRIFT_M, "m", path), drift)
    sunk = sup_convex(upright, lambda c: home[2] - c[..., 2], gap(0.0))
    yield bounded(flight, Limit("depth below home", 0.0, "m", path), sunk)
