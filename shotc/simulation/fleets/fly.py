"""A fleet flown in simulation: arrays in, where its drones were out."""

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
"""From positions, velocities and preferred velocities, (n, 3) each, to those that are commanded."""


@dataclass(frozen=True, slots=True)
class FleetConditions:
    """How a fleet flies; seed : of the gusts."""

    vehicle: FleetVehicle = field(default_factory=FleetVehicle)
    gains: Gains = field(default_factory=Gains)
    gusts: Gusts = field(default_factory=Gusts)
    seed: int | tuple[int, ...] = 0


@dataclass(frozen=True, slots=True, eq=False)
class FleetRun:
    """What came of it, every ``PERIOD_S``; times : (T,), the rest (n, T, 3).

    position, velocity : of the drones over ground; wanted : where they should be
    preferred : velocity that the controller asks for, before avoidance
    """

    times: Array
    position: Array
    velocity: Array
    wanted: Array
    preferred: Array

    @property
    def error(self) -> Array:
        """Distance of each drone from where it should be at the same time, shape (n, T), m."""
        return np.asarray(np.linalg.norm(self.position - self.wanted, axis=2))

    @property
    def rmse(self) -> float:
        """Root of the mean square of the error, over drones and times, m."""
        return float(np.sqrt(np.mean(self.error**2)))


@dataclass(frozen=True, slots=True, eq=False)
class FleetSample:
    """One row of ``FleetRun``: the time, and (n, 3) each of the rest."""

    time: float
    position: Array
    velocity: Array
    wanted: Array
    preferred: Array


def flying(
    breaks: Array, coef: Array, conditions: FleetConditions, avoid: Avoid | None = None
) -> Iterator[FleetSample]:
    """Fly a fleet along splines (``geom.fleet_spline``) from rest at their start to their end.

    avoid : what may change the preferred velocities; None flies them as they are
    """
    reference = FleetReference.of(breaks, coef)
    rng = np.random.default_rng(conditions.seed)
    position = reference.together(breaks[:1])[:, 0]
    still = np.zeros_like(position)
    state = FleetState(position, still, still, conditions.gusts.at_first(len(position), rng))
    for now in (np.arange(round((breaks[-1] - breaks[0]) / PERIOD_S) + 1) * PERIOD_S + breaks[0]).tolist():
        ask = preferred(reference, conditions.gains, now, state.position, state.over_ground)
        wanted = reference.together(np.array([now]))[:, 0]
        yield FleetSample(now, state.position, state.over_ground, wanted, ask)
        if avoid is not None:
            ask = avoid(state.position, state.over_ground, within(ask, conditions.vehicle.speed))
        state = moved(conditions.vehicle, state, ask, PERIOD_S)
        state = replace(state, gust=conditions.gusts.after(state.gust, PERIOD_S, rng))


def fly(breaks: Array, coef: Array, conditions: FleetConditions, avoid: Avoid | None = None) -> FleetRun:
    """Return all moments of ``flying`` together, which for a thousand drones is megabytes a second."""
    moments = list(flying(breaks, coef, conditions, avoid))
    return FleetRun(
        np.array([each.time for each in moments]),
        np.stack([each.position for each in moments], axis=1),
        np.stack([each.velocity for each in moments], axis=1),
        np.stack([each.wanted for each in moments], axis=1),
        np.stack([each.preferred for each in moments], axis=1),
    )
