"""Flights of fleets as arrays: all samples of a simulation, and the nearest pair of drones in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.apart import Distances
from shotc.geom.bernstein import Array
from shotc.simulation.fleets.near import ClosestPair, NearestSearch
from shotc.simulation.fleets.rehearse import Avoid, FleetConditions, flying


@dataclass(frozen=True, slots=True, eq=False)
class FlownFleet:
    """The simulated flight of a fleet, sampled every ``PERIOD_S``: times (T,), all else (n, T, 3).

    position, velocity : of the drones over ground
    planned : planned positions
    preferred : velocities that the controller asks for, before avoidance
    """

    times: Array
    position: Array
    velocity: Array
    planned: Array
    preferred: Array

    @property
    def error(self) -> Array:
        """Distance of each drone from its planned position at the same time, shape (n, T), metres."""
        return np.asarray(np.linalg.norm(self.position - self.planned, axis=2))

    @property
    def rmse(self) -> float:
        """Root mean square of the error over drones and times, metres."""
        return float(np.sqrt(np.mean(self.error**2)))


def fly(breaks: Array, coef: Array, conditions: FleetConditions, avoid: Avoid | None = None) -> FlownFleet:
    """Return all samples of ``flying`` together; a thousand drones take megabytes for each second."""
    moments = list(flying(breaks, coef, conditions, avoid))
    return FlownFleet(
        np.array([each.time for each in moments]),
        np.stack([each.position for each in moments], axis=1),
        np.stack([each.velocity for each in moments], axis=1),
        np.stack([each.planned for each in moments], axis=1),
        np.stack([each.preferred for each in moments], axis=1),
    )


def nearest(times: Array, position: Array, apart: Distances, limit: float) -> ClosestPair:
    """Return the nearest of all pairs.

    times : (T,), seconds, at least two
    position : (n, T, 3), metres, at least two drones
    limit : horizontal distance for ``ClosestPair.below``, metres
    """
    search = NearestSearch(apart, limit)
    for time, places in zip(times.tolist(), np.moveaxis(position, 1, 0), strict=True):
        search.add(time, places)
    return search.nearest()
