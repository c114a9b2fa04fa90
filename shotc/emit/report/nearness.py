"""How near the nearest two drones of a fleet are over time: samples for a plot, not the proof."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Apart, Fleet
from shotc.ir.trajectory import TrajectoryIR
from shotc.planning.on_pads import standing_at

SAMPLES = 240
NEIGHBOURS = 12
"""Of a drone that are looked at where the nearest by the plain distance need not be the one that counts."""


class Nearness(NamedTuple):
    """A fleet's nearest pair over time; metres of horizontal distance, as its separation counts them.

    times, distances : shape (T,), of two in the air where a fleet takes off in layers
    needed : what its drones keep
    """

    fleet: str
    times: Array
    distances: Array
    needed: float


def nearness(flown: TrajectoryIR) -> tuple[Nearness, ...]:
    """Return the nearest pairs of every fleet of two drones or more."""
    mission = flown.keyframes.mission
    return tuple(_of(mission.fleet(flight.fleet), flight) for flight in flown.fleets if len(flight.coef) > 1)


def _of(fleet: Fleet, flight: FleetTrajectory) -> Nearness:
    times = np.linspace(flight.breaks[0], flight.breaks[-1], SAMPLES + 1)
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    standing = standing_at(fleet, flight, times)
    several = (~standing).sum(axis=0) > 1
    times, aloft = times[several], ~standing[:, several]
    least = [
        _least(places(flight.breaks, flight.coef, times[[k]])[aloft[:, k], 0] * scale, fleet.apart)
        for k in range(len(times))
    ]
    return Nearness(fleet.name, times, np.array(least), fleet.apart.across)


def _least(points: Array, apart: Apart) -> float:
    """Return how near the nearest two of points (n, 3) are, in stretched space."""
    tree = cKDTree(points)
    if apart.shape == "ellipsoid":
        return float(tree.query(points, k=2)[0][:, 1].min())
    _, near = tree.query(points, k=min(NEIGHBOURS, len(points)))
    away = points[:, None] - points[near[:, 1:]]
    return float(np.maximum(np.hypot(away[..., 0], away[..., 1]), np.abs(away[..., 2])).min())
