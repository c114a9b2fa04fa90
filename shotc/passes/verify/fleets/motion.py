"""Speed, acceleration and jerk of every drone of a fleet, at every instant."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import rates, velocity
from shotc.geom.proof import norm, sup_channel, sup_convex
from shotc.ir.thrust import lean, thrust_to_weight
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, gap
from shotc.passes.verify.fleets.flight import FleetFlight, bounded, of_drone


def motion(flight: FleetFlight) -> Iterator[Claim]:
    """Yield claims on the limits of the fleet's drones over the whole flight.

    Velocity is quadratic on a piece and is bounded by hulls. Acceleration is linear there, so its norm is
    largest at a break; jerk is constant.
    """
    limits = flight.fleet.limits
    rate = velocity(flight.track.breaks, flight.track.coef).bag()
    fastest = sup_convex(rate.channels(0, 1), norm, gap(limits.speed))
    yield bounded(flight, _limit(flight, "speed", "m/s"), fastest, lambda v: norm(v[:, :2]), 1)
    rising = sup_channel(rate, 2, gap(limits.climb))
    yield bounded(flight, _limit(flight, "climb", "m/s"), rising, lambda v: v[:, 2], 1)
    falling = sup_convex(rate, lambda v: -v[..., 2], gap(limits.descent))
    yield bounded(flight, _limit(flight, "descent", "m/s"), falling, lambda v: -v[:, 2], 1)
    for order, name, unit in ((2, "acceleration", "m/s^2"), (3, "jerk", "m/s^3")):
        size = norm(rates(flight.track.breaks, flight.track.coef, order))
        yield _largest(flight, _limit(flight, name, unit), size)
    yield from _thrust(flight)


def _thrust(flight: FleetFlight) -> Iterator[Claim]:
    """Yield claims on tilt and thrust where they are limited; both are largest at a break."""
    limits, acceleration = flight.fleet.limits, rates(flight.track.breaks, flight.track.coef, 2)
    if limits.tilt < inf:
        yield _largest(flight, _limit(flight, "tilt", "rad"), lean(acceleration))
    if limits.thrust_to_weight < inf:
        limit = _limit(flight, "thrust_to_weight", "times the weight")
        yield _largest(flight, limit, thrust_to_weight(acceleration))


def _limit(flight: FleetFlight, name: str, unit: str) -> Limit:
    return Limit(name.replace("_", " "), getattr(flight.fleet.limits, name), unit, flight.key("limits", name))


def _largest(flight: FleetFlight, limit: Limit, size: Array) -> Claim:
    """Return the claim on the largest of values (n, m) at the first m breaks, or on the pieces after them."""
    drone, k = np.unravel_index(int(np.argmax(size)), size.shape)
    worst = float(size[drone, k]), float(flight.track.breaks[k])
    return of_drone(flight, limit, worst, int(drone), "bounded")
