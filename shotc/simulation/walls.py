"""Half-spaces beside the plan that a drone flies, which keep its next plan clear of terrain and meshes."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import signed_distance
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING, GROUND
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.clearances import clearances_of, from_parked
from shotc.planning.obstacles import flight_space
from shotc.planning.over_ground import OverGround
from shotc.plugin_api.replanner import NO_WALLS, Keeping, Plan, Walls

MOST_HALF_SPACES = 8
"""Most half-spaces of a stage, the nearest ones; a plan renewed twice a second needs no more."""

REACH_M = 8.0
"""Distance from the plan in addition to the clearance, above which surfaces are ignored, metres. A drone at 3
m/s^2 deviates that much in 2.3 s, in which it replans four times.
"""

UP = np.array([0.0, 0.0, 1.0])
FAR_M = 1e6
"""Metres below everything that is flown."""


def keeping_of(mission: MissionIR, drone: Drone, half_angle: float | None = None) -> Keeping:
    """Return the limits and clearances that a drone keeps as it flies.

    half_angle : of the cone about its camera's axis without other drones, rad; None for no cone
    """
    rules, terrain = mission.rules, mission.terrain
    return Keeping(
        limits=drone.limits,
        pitch=drone.gimbal.pitch,
        zones=(*clearances_of(mission, drone), *from_parked(mission, drone)),
        floor=rules.over_ground(drone.radius) if terrain is None else -inf,
        ceiling=rules.max_height or inf if terrain is None else inf,
        separation=rules.separation,
        half_angle=half_angle,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """The standing obstacles of a drone.

    surfaces : obstacles made of triangles: terrain, scenes, buildings
    keeping : zones, and the limits with which the drone stops
    """

    surfaces: tuple[OverGround | BesideMesh, ...]
    keeping: Keeping

    @staticmethod
    def of(mission: MissionIR, drone: Drone, keeping: Keeping) -> Standing:
        """Return the standing obstacles of a mission."""
        if mission.terrain is None and not mission.meshes:
            return Standing((), keeping)
        return Standing(flight_space(mission, drone).surfaces, keeping)

    def lacks(self, places: Array) -> Array:
        """Return the missing clearance of a drone's centre from each of K obstacles at positions (M, 3),
        shape (K, M), metres.

        It is at most 0 where the clearance holds. The last two are the floor and the ceiling.
        """
        lacks = [-each.slack(places) for each in self.surfaces]
        for zone in self.keeping.zones:
            gap = signed_distance(zone.solid, places)
            lacks.append(zone.metres + (gap if zone.inside else -gap))
        lacks += [self.keeping.floor - places[:, 2], places[:, 2] - self.keeping.ceiling]
        return np.array(lacks)

    def name(self, obstacle: int, place: Array) -> str:
        """Return the name in plans of one of the K obstacles; place : (3,), the part near it is named."""
        owners = [each.owner_at(place) for each in self.surfaces]
        owners += [zone.owner for zone in self.keeping.zones]
        return str([*owners, GROUND, CEILING][obstacle])

    def beside(self, last: Plan, stages: Array) -> Walls:
        """Return half-spaces beside a plan at stages (N + 1,), mission times; after its end the
        drone stops.
        """
        if not self.surfaces:
            return NO_WALLS
        hulls = _hulls(last, stages, self.keeping)
        planes = [surface.planes(hulls, REACH_M, np.zeros_like) for surface in self.surfaces]
        piece = np.concatenate([each.piece for each in planes])
        normal = np.concatenate([each.normal for each in planes])
        offset = np.concatenate([each.offset for each in planes])
        slack = np.einsum("rmd,rd->rm", hulls[piece], normal).min(axis=1) - offset
        shape = (len(hulls), MOST_HALF_SPACES)
        normals, offsets = np.tile(UP, (*shape, 1)), np.full(shape, -FAR_M)
        order = np.lexsort((slack, piece))
        rank = np.arange(len(order)) - np.searchsorted(piece[order], piece[order])
        chosen = rank < MOST_HALF_SPACES
        normals[piece[order][chosen], rank[chosen]] = normal[order][chosen]
        offsets[piece[order][chosen], rank[chosen]] = offset[order][chosen]
        return Walls(normals, offsets)


def followed(last: Plan, stages: Array, keeping: Keeping) -> Array:
    """Return the positions of a plan at stages (N + 1,), and last the one where it stops after its end,
    (N + 2, 3), metres.
    """
    at = np.column_stack([np.interp(stages, last.times, column) for column in last.places.T])
    v = last.velocities[-1]
    seconds = keeping.reaction + float(np.linalg.norm(v)) / (2.0 * keeping.limits.usable_acceleration)
    past = np.clip(stages - last.times[-1], 0.0, seconds)[:, None]
    return np.vstack([at + past * v, last.places[-1] + seconds * v])


def _hulls(last: Plan, stages: Array, keeping: Keeping) -> Array:
    """Return the points of each stage with its neighbours, and of the stopping path, (N + 1, 3,
    3), metres.
    """
    *_, end, stands = at = followed(last, stages, keeping)
    after = np.concatenate([at[2:-1], at[-2:-1]])
    around = np.stack([at[:-2], at[1:-1], after], axis=1)
    return np.concatenate([around, np.stack([end, 0.5 * (end + stands), stands])[None]])
