"""The distance of the nearest two drones of a fleet over time: samples for a plot, which prove nothing."""

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

SAMPLED_TIMES = 240
NEIGHBOUR_COUNT = 12
"""Neighbours of a drone that are examined for the cylinder's measure, because the Euclidean nearest drone
need not be the nearest by that measure.
"""


class Nearness(NamedTuple):
    """Distance of a fleet's nearest pair over time, metres, in the measure of its separation.

    times, distances : shape (T,); where a fleet takes off in layers, between drones in the air
    needed : the separation
    """

    fleet: str
    times: Array
    distances: Array
    needed: float


def nearness(flown: TrajectoryIR) -> tuple[Nearness, ...]:
    """Return the distances of the nearest pairs of every fleet of at least two drones."""
    mission = flown.keyframes.mission
    return tuple(_of(mission.fleet(flight.fleet), flight) for flight in flown.fleets if len(flight.coef) > 1)


def _of(fleet: Fleet, flight: FleetTrajectory) -> Nearness:
    times = np.linspace(flight.breaks[0], flight.breaks[-1], SAMPLED_TIMES + 1)
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
    """Return the distance of the nearest two of points (n, 3), in space scaled by ``stretch``, metres."""
    tree = cKDTree(points)
    if apart.shape == "ellipsoid":
        return float(tree.query(points, k=2)[0][:, 1].min())
    _, near = tree.query(points, k=min(NEIGHBOUR_COUNT, len(points)))
    offset = points[:, None] - points[near[:, 1:]]
    return float(np.maximum(np.hypot(offset[..., 0], offset[..., 1]), np.abs(offset[..., 2])).min())
