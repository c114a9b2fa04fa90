"""Simulates a fleet: splines in, positions over time out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.fleets.follow import FleetReference, Gains, preferred
from shotc.simulation.fleets.vehicle import FleetState, FleetVehicle, Gusts, moved
from shotc.simulation.vehicle import within

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
