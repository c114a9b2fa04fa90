"""Distances of the drones' bodies from everything else in a run, at its frames.

Take-off and landing over a drone's own pad are left out, as in verification.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.surface.ground import height_at
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT
from shotc.ir.trajectory import DroneTrajectory
from shotc.simulation.flight import DroneRuns
from shotc.simulation.world import World, at_times

MESH_LIMIT_M = 20.0
"""Metres, above which the distance from a mesh is not computed."""


class ClosestApproach(NamedTuple):
    """The least distance of a drone's body from an obstacle.

    to : the obstacle's name in plans, or "drone NAME"
    distance : metres, negative inside
    time : seconds
    """

    to: str
    distance: float
    time: float


def free_of_pad(track: DroneTrajectory, times: Array) -> Array:
    """Return those of times (M,) at which a drone neither takes off nor lands, shape (K,)."""
    inside = np.zeros(len(times), dtype=bool)
    for phase in track.phases:
        if phase.name not in UPRIGHT:
            inside |= (times >= phase.start) & (times <= phase.end)
    return times[inside]


def nearest(
    world: World, flown: DroneRuns, track: DroneTrajectory, times: Array
) -> list[tuple[ClosestApproach, ...]]:
    """Return for every run the least distance of a drone from each obstacle and each target.

    times : at which it is measured, (M,), seconds
    """
    drone, mission = world.mission.drone(flown.drone), world.mission
    free = free_of_pad(track, times)
    if not len(free):
        return [()] * len(world.runs)
    places = at_times(flown.position, flown.times, free)
    flat = places.reshape(-1, 3)
    shape = places.shape[:2]
    rows = [(name, distances.reshape(shape)) for name, distances in _standing(mission, drone, flat)]
    for target in mission.targets:
        really = at_times(world.places[target.name], world.times, free)
        moved = (places - (really - np.array(target.centre))).reshape(-1, 3)
        distances = signed_distance(target.kept_clear, moved) - drone.radius
        rows.append((f"target {target.name}", distances.reshape(shape)))
    return [tuple(_least(name, distances[:, r], free) for name, distances in rows) for r in range(shape[1])]


def between(mission: MissionIR, one: DroneRuns, other: DroneRuns, times: Array) -> list[ClosestApproach]:
    """Return for every run the least distance of two drones' bodies at times (M,); a drone that has
    landed is on its pad.
    """
    a, b = (at_times(f.position, f.times, times) for f in (one, other))
    reach = mission.drone(one.drone).radius + mission.drone(other.drone).radius
    distances = np.linalg.norm(a - b, axis=2) - reach
    return [_least(f"drone {other.drone}", distances[:, r], times) for r in range(distances.shape[1])]


def _standing(mission: MissionIR, drone: Drone, flat: Array) -> Iterator[tuple[str, Array]]:
    for zone in mission.zones:
        distances = signed_distance(zone.solid, flat)
        yield f"zone {zone.name}", (distances if zone.keep == "out" else -distances) - drone.radius
    terrain = mission.terrain
    ground = 0.0 if terrain is None else height_at(terrain.ground, flat[:, :2])
    yield "ground", flat[:, 2] - np.nan_to_num(ground) - drone.radius
    for mesh in mission.meshes:
        distances = mesh.signed_distance(flat, MESH_LIMIT_M)
        yield mesh.kind, distances - mesh.spacing - drone.radius
    for pad in mission.parked:
        distances = np.linalg.norm(flat - np.array(pad.home), axis=1)
        yield f"drone {pad.name}", distances - drone.radius - pad.radius


def _least(name: str, distances: Array, times: Array) -> ClosestApproach:
    k = int(np.argmin(distances))
    return ClosestApproach(name, float(distances[k]), float(times[k]))
