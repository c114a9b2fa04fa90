"""Pairs of drones that would collide without a clock, because their paths come nearer than the separation."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product
from math import ceil
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.emit.waypoints.clearance import shortfall
from shotc.emit.waypoints.track import SAMPLE_STEP_S
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.owners import target_owner
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clearances import Clearance

TRACK_STEP_S = 0.5  # seconds between positions of a moving target
STEP_M = 0.5  # metres between positions of a path; at 3 m a distance is at most 0.02 m too large
ROUNDING_M = 0.05  # metres of a separation that rounding may take


class WaysTooNear(NamedTuple):
    """Two drones by name, and the distance of their paths, metres."""

    names: tuple[str, str]
    distance: float


def kept_apart_by_time(
    mission: MissionIR, positions: dict[str, Array], others: Sequence[DroneTrajectory]
) -> list[WaysTooNear]:
    """Return the pairs of drones whose paths come nearer than the separation, at whatever times.

    positions : (n, 3) of each drone without a clock, metres; those above its pad are added
    others : flights of drones with a clock; pairs of these are not examined
    """
    trees = {
        name: cKDTree(np.concatenate([path, *_columns(mission, name, path)]))
        for name, path in positions.items()
    }
    clocked = {flight.drone: cKDTree(evenly(_places(flight))) for flight in others}
    pairs = [*combinations(trees, 2), *product(trees, clocked)]
    trees |= clocked
    too_near_pairs: list[WaysTooNear] = []
    for one, other in pairs:
        distance = float(trees[one].query(trees[other].data)[0].min())
        if distance < mission.rules.separation - ROUNDING_M:
            too_near_pairs.append(WaysTooNear((one, other), distance))
    return too_near_pairs


def too_near(mission: MissionIR, flight: DroneTrajectory, path: Array, name: str) -> float:
    """Return the missing clearance of a path (n, 3) from a moving target, wherever it is on its track,
    metres.
    """
    target, drone = mission.target(name), mission.drone(flight.drone)
    metres = mission.rules.beside_target(drone.radius)
    times = np.arange(flight.curve.start, flight.curve.end + TRACK_STEP_S, TRACK_STEP_S)
    bodies = (Clearance(target_owner(target), target.solid_at(t), metres) for t in times.tolist())
    return max(float(shortfall(body, path).max()) for body in bodies)


def evenly(path: Array) -> Array:
    """Return positions (k, 3) every STEP_M along a path through positions (n, 3), both ends included."""
    lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    at = np.linspace(0.0, lengths[-1], max(2, ceil(lengths[-1] / STEP_M) + 1))
    return np.stack([np.interp(at, lengths, axis) for axis in path.T], axis=1)


def _places(flight: DroneTrajectory) -> Array:
    """Return the positions of a flight from pad to pad, (n, 3)."""
    curve = flight.curve
    return curve(np.arange(curve.start, curve.end + SAMPLE_STEP_S, SAMPLE_STEP_S))[:, :3]


def _columns(mission: MissionIR, name: str, path: Array) -> list[Array]:
    """Return positions between the pad and both ends of a path, (k, 3) each."""
    home = np.array(mission.drone(name).home)
    return [evenly(np.stack([home, end])) for end in (path[0], path[-1])]
