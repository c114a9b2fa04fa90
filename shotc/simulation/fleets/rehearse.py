"""Simulates a fleet, splines in and positions over time out: distances from the plan, and separation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from math import hypot

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Fleet
from shotc.planning.on_pads import standing as standing_in
from shotc.planning.take_off import bodies_of
from shotc.simulation.fleets.follow import FleetReference, Gains, preferred
from shotc.simulation.fleets.near import ClosestPair, NearestSearch
from shotc.simulation.fleets.vehicle import FleetState, FleetVehicle, Gusts, moved
from shotc.simulation.vehicle import within

HEADROOM_RATIO = 2.0
"""Factor of the drones' acceleration over the limit of plans, as in the paper's simulation."""


PERIOD_S = 0.05
"""Seconds between commands."""

Avoid = Callable[[Array, Array, Array], Array]
"""Maps positions, velocities and preferred velocities, (n, 3) each, to commanded velocities, (n, 3)."""


@dataclass(frozen=True, slots=True)
class FleetConditions:
    """The conditions in which a fleet flies.

    seed : of the gusts
    """

    vehicle: FleetVehicle = field(default_factory=FleetVehicle)
    gains: Gains = field(default_factory=Gains)
    gusts: Gusts = field(default_factory=Gusts)
    seed: int | tuple[int, ...] = 0


@dataclass(frozen=True, slots=True, eq=False)
class FleetSample:
    """One time of a simulated flight, seconds; all else of shape (n, 3).

    position, velocity : of the drones over ground
    planned : planned positions
    preferred : velocities that the controller asks for, before avoidance
    """

    time: float
    position: Array
    velocity: Array
    planned: Array
    preferred: Array


def flying(
    breaks: Array, coef: Array, conditions: FleetConditions, avoid: Avoid | None = None
) -> Iterator[FleetSample]:
    """Yield the samples of a fleet that flies along splines (``geom.fleet_spline``), from rest at their
    start.

    breaks, coef : shapes (P + 1,) and (n, P + 3, 3)
    avoid : may change the preferred velocities; None leaves them
    """
    reference = FleetReference.of(breaks, coef)
    rng = np.random.default_rng(conditions.seed)
    position = reference.together(breaks[:1])[:, 0]
    still = np.zeros_like(position)
    state = FleetState(position, still, still, conditions.gusts.at_first(len(position), rng))
    for now in (np.arange(round((breaks[-1] - breaks[0]) / PERIOD_S) + 1) * PERIOD_S + breaks[0]).tolist():
        ask = preferred(reference, conditions.gains, now, state.position, state.over_ground)
        planned = reference.together(np.array([now]))[:, 0]
        yield FleetSample(now, state.position, state.over_ground, planned, ask)
        if avoid is not None:
            ask = avoid(state.position, state.over_ground, within(ask, conditions.vehicle.speed))
        state = moved(conditions.vehicle, state, ask, PERIOD_S)
        state = replace(state, gust=conditions.gusts.after(state.gust, PERIOD_S, rng))


@dataclass(frozen=True, slots=True)
class FleetRehearsal:
    """The result of one fleet's run, metres.

    rmse : root mean square of the stray
    usual : 99 % quantile of the drones' largest strays
    farthest : largest stray
    drone, time : row and time in seconds of the largest stray
    near : the nearest pair, horizontal distance as in ``geom.separation``; None for one drone; in the air for
        a fleet that takes off in layers
    beside : the nearest pair while one drone stands on its pad; None for fleets that rise all at once
    """

    rmse: float
    usual: float
    farthest: float
    drone: int
    time: float
    near: ClosestPair | None
    beside: ClosestPair | None = None


class FleetRecord:
    """Accumulates the results of a fleet while it flies."""

    def __init__(self, fleet: Fleet, flight: FleetTrajectory) -> None:
        self._flight, count = flight, len(flight.coef)
        self._search = NearestSearch(fleet.apart, fleet.apart.horizontal)
        bodies = bodies_of(fleet)._replace(margin=0.0)
        self._beside = NearestSearch(bodies, bodies.across)
        self._standing = standing_in(fleet, flight.coef) if count > 1 else None
        self._largest, self._when = np.zeros(count), np.zeros(count)
        self._squares, self._count = 0.0, 0

    def add(self, moment: FleetSample) -> Array:
        """Add a later sample; return the positions of the drones, shape (n, 3), metres.

        In a fleet that takes off in layers, a drone that stands on its pad stays there.
        """
        position, aloft = moment.position, None
        if self._standing is not None:
            piece = int(np.searchsorted(self._flight.breaks, moment.time)) - 1
            stands = self._standing[:, max(piece, 0)]
            position, aloft = np.where(stands[:, None], moment.planned, position), ~stands
            self._beside.add(moment.time, position, np.full(len(stands), stands.any()))
        error = np.linalg.norm(position - moment.planned, axis=1)
        self._when = np.where(error > self._largest, moment.time, self._when)
        self._largest = np.maximum(self._largest, error)
        self._squares, self._count = self._squares + float(error @ error), self._count + len(error)
        if len(position) > 1:
            self._search.add(moment.time, position, aloft)
        return position

    def result(self) -> FleetRehearsal:
        """Return the result so far."""
        drone = int(np.argmax(self._largest))
        return FleetRehearsal(
            rmse=float(np.sqrt(self._squares / self._count)),
            usual=float(np.quantile(self._largest, 0.99)),
            farthest=float(self._largest[drone]),
            drone=drone,
            time=float(self._when[drone]),
            near=self._search.nearest() if len(self._largest) > 1 else None,
            beside=None if self._standing is None else self._beside.nearest(),
        )


def moments(
    fleet: Fleet, flight: FleetTrajectory, gusts: Gusts, seed: int | tuple[int, ...]
) -> Iterator[FleetSample]:
    """Return the samples of a fleet's flight with lag and gusts; the same seed gives the same flight."""
    limits = fleet.limits
    fastest = hypot(limits.speed, max(limits.climb, limits.descent))
    vehicle = FleetVehicle(acceleration=HEADROOM_RATIO * limits.acceleration, speed=fastest)
    return flying(flight.breaks, flight.coef, FleetConditions(vehicle, gusts=gusts, seed=seed))
