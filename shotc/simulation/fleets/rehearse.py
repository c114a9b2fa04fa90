"""A planned fleet rehearsed: how far its drones stray, and what that leaves of their separation."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

import numpy as np

from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Fleet
from shotc.planning.on_pads import standing as standing_in
from shotc.planning.take_off import bodies_of
from shotc.simulation.fleets.fly import FleetConditions, flying
from shotc.simulation.fleets.near import Near, Search
from shotc.simulation.fleets.vehicle import Gusts, Vehicle

HEADROOM = 2.0
"""Acceleration that drones have over what plans may ask of them, as in the paper's simulation."""


@dataclass(frozen=True, slots=True)
class Rehearsal:
    """What came of one fleet, metres.

    rmse : of the distance from where each drone should be; usual : what 99 % of the largest distances of each
        drone do not exceed; farthest : the largest; drone, time : whose, a row, and when, s
    near : the nearest that two came, horizontal distance as in ``geom.separation``, or None for one drone;
        of a fleet that takes off in layers, two in the air
    beside : the nearest that two came while one stood on its pad, m; None for fleets that rise all at once
    """

    rmse: float
    usual: float
    farthest: float
    drone: int
    time: float
    near: Near | None
    beside: Near | None = None


def rehearse(fleet: Fleet, flight: FleetTrajectory, gusts: Gusts, seed: int | tuple[int, ...]) -> Rehearsal:
    """Fly a fleet with lag and gusts; the same seed gives the same flight.

    Of a fleet that takes off in layers, whoever stands on its pad stays there.
    """
    limits = fleet.limits
    fastest = hypot(limits.speed, max(limits.climb, limits.descent))
    vehicle = Vehicle(acceleration=HEADROOM * limits.acceleration, speed=fastest)
    several = len(flight.coef) > 1
    search = Search(fleet.apart, fleet.apart.horizontal)
    bodies = bodies_of(fleet)._replace(margin=0.0)
    beside = Search(bodies, bodies.across)
    standing = standing_in(fleet, flight.coef) if several else None
    largest, when = np.zeros(len(flight.coef)), np.zeros(len(flight.coef))
    squares, count = 0.0, 0
    for moment in flying(flight.breaks, flight.coef, FleetConditions(vehicle, gusts=gusts, seed=seed)):
        position, aloft = moment.position, None
        if standing is not None:
            piece = int(np.searchsorted(flight.breaks, moment.time)) - 1
            stands = standing[:, max(piece, 0)]
            position, aloft = np.where(stands[:, None], moment.wanted, position), ~stands
            beside.add(moment.time, position, np.full(len(stands), stands.any()))
        error = np.linalg.norm(position - moment.wanted, axis=1)
        when = np.where(error > largest, moment.time, when)
        largest = np.maximum(largest, error)
        squares, count = squares + float(error @ error), count + len(error)
        if several:
            search.add(moment.time, position, aloft)
    drone = int(np.argmax(largest))
    return Rehearsal(
        rmse=float(np.sqrt(squares / count)),
        usual=float(np.quantile(largest, 0.99)),
        farthest=float(largest[drone]),
        drone=drone,
        time=float(when[drone]),
        near=search.found() if several else None,
        beside=None if standing is None else beside.found(),
    )
