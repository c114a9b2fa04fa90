"""How near products that burn come to the ground, to scenes and to buildings, proved for every instant.

Over flat ground the distance is the height. Over terrain and beside meshes it is Euclidean: sparks fly in
every direction, so a slope or a wall beside a drone counts as the ground below it does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.proof import ProvedExtreme
from shotc.geom.surface.ground import height_at
from shotc.geom.surface.height import inf_height
from shotc.geom.surface.near import nearest
from shotc.ir.limits import Vec3
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.terrain import Terrain
from shotc.passes.verify.claims import gap, known
from shotc.passes.verify.fleets.flight import FleetFlight, Span
from shotc.passes.verify.fleets.surfaces import near_surface, once, outside_of_mesh

PYRO = "pyro "
"""Prefix of constraints on products."""

GROUND = "the ground"


@dataclass(frozen=True, slots=True)
class NearestToProduct:
    """The least distance from what is around of the drones with one product, while it burns.

    drone : the row of the drone that has it; position : where that is then, metres; None where it is not told
    """

    what: str
    bound: ProvedExtreme
    drone: int
    position: Vec3 | None = None


def near_surfaces(
    flight: FleetFlight, rows: Sequence[int], span: Span, least: float
) -> Iterator[NearestToProduct]:
    """Yield the least distances of drones from the ground, and from the meshes of the mission.

    rows : of the drones in the fleet; span : while their products burn in the air, s
    least : the limit, metres, which determines the gap of the bounds
    """
    flown = flight.flown
    burning = FleetPieces(flown.low, flown.high, flown.ctrl[list(rows)]).between([span])
    terrain = flight.mission.terrain
    if terrain is None:
        yield _over_flat_ground(burning, rows)
    else:
        of = _of_terrain(burning, terrain, least)
        yield _nearest_drone(flight, rows, (GROUND, of), lambda p: _from_terrain(terrain, p))
    for mesh in flight.mission.meshes:
        bound = outside_of_mesh(burning, (float(burning.low[0]), burning.ctrl[:, 0, 0]), mesh, least)
        yield _nearest_drone(flight, rows, (from_mesh(mesh), bound), mesh.signed_distance)


def from_mesh(mesh: ObstacleMesh) -> str:
    """Return what the distance from a mesh is called in claims."""
    return f"the {mesh.kind}"


def sampled_distances(flight: FleetFlight, p: Array) -> Array:
    """Return the distances of points (n, 3) from the ground and all meshes, the smaller, shape (n,)."""
    terrain = flight.mission.terrain
    distances = [p[:, 2] if terrain is None else _from_terrain(terrain, p)]
    distances += [mesh.signed_distance(p) - mesh.spacing for mesh in flight.mission.meshes]
    return np.asarray(np.min(distances, axis=0))


def _over_flat_ground(burning: FleetPieces, rows: Sequence[int]) -> NearestToProduct:
    heights = burning.ctrl[..., 2].min(axis=2)
    drone, lowest = np.unravel_index(int(heights.argmin()), heights.shape)
    height = float(heights[drone, lowest])
    return NearestToProduct(
        GROUND, ProvedExtreme(height, height, float(burning.low[lowest])), rows[int(drone)]
    )


def _of_terrain(burning: FleetPieces, terrain: Terrain, least: float) -> ProvedExtreme:
    """Bound the distance from terrain: below it the negative depth, beyond it minus infinity."""
    pieces = once(burning.bag())
    height = known(inf_height(pieces, terrain.ground, gap(least)), -inf)
    return height if height.proven < 0.0 else near_surface(pieces, terrain.ground.surface, gap(least))


def _from_terrain(terrain: Terrain, p: Array) -> Array:
    """Return the distances of points (n, 3) from terrain, signed as in ``_of_terrain``, shape (n,)."""
    height = p[:, 2] - height_at(terrain.ground, p[:, :2])
    above = np.where(height < 0.0, height, nearest(terrain.ground.surface, p).distance)
    return np.where(np.isnan(height), -inf, above)


def _nearest_drone(
    flight: FleetFlight, rows: Sequence[int], of: tuple[str, ProvedExtreme], value: Callable[[Array], Array]
) -> NearestToProduct:
    """Return a bound with the drone that has it, which a function from positions to distances finds."""
    what, bound = of
    at = flight.at(bound.at)[list(rows)]
    worst = int(np.argmin(value(at)))
    x, y, z = (float(c) for c in at[worst])
    return NearestToProduct(what, bound, rows[worst], (x, y, z))
