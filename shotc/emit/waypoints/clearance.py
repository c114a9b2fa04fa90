"""Missing clearance of points and curves beside obstacles, vectorised."""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, bernstein_basis, split_half
from shotc.geom.solid_arrays.points import footprint_distances, signed_distance
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING, GROUND, Owner
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.clearances import Clearance, clearances_of, from_parked
from shotc.planning.obstacles import flight_space
from shotc.planning.over_ground import OverGround

CLOSED_M = 1e-4  # metres, size of a curve, below which it is not subdivided further
SHARES = np.linspace(0.0, 1.0, 65)  # parameters of a curve at which its worst point is sought


class Level(NamedTuple):
    """Flat ground, or the greatest height above it if ``upper``.

    height : z of the drone's centre at the limit, metres
    """

    owner: Owner
    height: float
    upper: bool


Obstacle = Clearance | OverGround | BesideMesh | Level
"""An obstacle that a file's legs might come nearer to than the plan does."""


def bounds(mission: MissionIR, drone: Drone) -> tuple[Obstacle, ...]:
    """Return all standing limits of a flight: keep-outs, keep-in zones, ground and greatest height."""
    inside = tuple(each for each in clearances_of(mission, drone) if each.inside)
    flat: list[Level] = []
    if mission.terrain is None:
        flat.append(Level(GROUND, mission.rules.over_ground(drone.radius), upper=False))
        most = mission.rules.max_height
        if most is not None and isfinite(most):
            flat.append(Level(CEILING, most, upper=True))
    return (*keep_outs(mission, drone), *inside, *flat)


def keep_outs(mission: MissionIR, drone: Drone) -> tuple[Obstacle, ...]:
    """Return zones, standing targets, parked drones, terrain and meshes, with their clearances."""
    around = (*clearances_of(mission, drone), *from_parked(mission, drone))
    return (*(each for each in around if not each.inside), *flight_space(mission, drone).surfaces)


def owner_of(obstacle: Obstacle, place: Array) -> Owner:
    """Return the owner of the limit nearest to a position (3,), metres."""
    return obstacle.owner_at(place) if isinstance(obstacle, OverGround | BesideMesh) else obstacle.owner


def shortfall(obstacle: Obstacle, points: Array) -> Array:
    """Return the missing clearance of points, metres, shape (n,); it is negative where there is slack.

    points : shape (n, 3), W, metres
    """
    if isinstance(obstacle, Level):
        return points[:, 2] - obstacle.height if obstacle.upper else obstacle.height - points[:, 2]
    if not isinstance(obstacle, Clearance):
        return -obstacle.slack(points)
    solid = obstacle.solid
    if obstacle.inside:
        return np.asarray(obstacle.metres + signed_distance(solid, points))
    across = footprint_distances(solid, points[:, :2])
    above = np.maximum(np.maximum(solid.bottom - points[:, 2], points[:, 2] - solid.top), 0.0)
    return np.asarray(obstacle.metres - np.hypot(across, above))


def nearer_between(obstacle: Obstacle, curves: Array, allowed: float) -> tuple[Array, float] | None:
    """Return the position where curves are nearer to an obstacle than allowed, and the lack there, metres.

    The result is None if the curves are proved to keep the clearance everywhere. The proof uses two facts: a
    curve's midpoint is at most as far from its other points as from its control points, and the lack changes
    at most as much as the position. The second does not hold for terrain and meshes, which have proofs of
    their own.

    curves : Bernstein control points, shape (k, n, 3), metres
    allowed : metres that they may lack
    """
    if isinstance(obstacle, OverGround | BesideMesh):
        curves = curves[obstacle.lowered(allowed).lack(curves) > 0.0]
        if not len(curves):
            return None
        places = np.einsum("tk,nkd->ntd", bernstein_basis(curves.shape[1] - 1, SHARES), curves).reshape(-1, 3)
        lacks = shortfall(obstacle, places)
        k = int(lacks.argmax())
        return places[k], max(float(lacks[k]), allowed)
    while len(curves):
        left, right = split_half(curves)
        middle = left[:, -1]
        lacks = shortfall(obstacle, middle)
        reach = np.linalg.norm(curves - middle[:, None], axis=2).max(axis=1)
        unclear = lacks + reach > allowed
        settled = (lacks > allowed) | (unclear & (reach < CLOSED_M))
        if settled.any():
            k = int(np.where(settled, lacks, -np.inf).argmax())
            return middle[k], max(float(lacks[k]), allowed)
        curves = np.concatenate([left[unclear], right[unclear]])
    return None
