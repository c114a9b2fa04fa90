"""The free space of one drone's centre, from a mission's zones, targets and rules."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import hypot, inf, isfinite
from typing import NamedTuple

from shotc.geom.solid_arrays.points import bounded
from shotc.geom.solids import Cylinder, Prism, convex_parts, edges, hull_and_pockets
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING, GROUND, Owner, mesh_owner, target_owner, zone_owner
from shotc.ir.transits import SolidClearance, from_target, from_zones
from shotc.planning.beside_mesh import BesideMesh
from shotc.planning.clearances import Clearance, clearances_of, from_parked
from shotc.planning.free_space import MARGIN_M, Disc, FreeSpace, Obstacle, Wall
from shotc.planning.over_ground import heights_over


class FreeSpaces(NamedTuple):
    """The free spaces of a drone: with the clearances of all phases, and with those of transfers.

    required : owners whose clearances on transfers the mission states
    """

    flight: FreeSpace
    transit: FreeSpace
    required: frozenset[Owner] = frozenset()


def flight_space(mission: MissionIR, drone: Drone) -> FreeSpace:
    """Return the free space of every phase except take-off and landing, from standing obstacles only.

    Parked drones are part of it; drones that fly are not.
    """
    over_ground, terrain = mission.rules.over_ground(drone.radius), mission.terrain
    most = mission.rules.max_height or inf
    walls = [] if terrain else [Wall(GROUND, (0.0, 0.0, 1.0), over_ground, over_ground)]
    if isfinite(most) and terrain is None:
        walls.append(Wall(CEILING, (0.0, 0.0, -1.0), -most, 0.0))
    space = _space((*clearances_of(mission, drone), *from_parked(mission, drone)), walls, floors=True)
    space = replace(space, meshes=_beside_meshes(mission, mission.rules.beside_obstacle(drone.radius)))
    if terrain is None:
        return space
    heights = heights_over(terrain.ground, over_ground, most if isfinite(most) else None)
    return replace(space, terrain=heights)


def _beside_meshes(mission: MissionIR, clearance: float) -> tuple[BesideMesh, ...]:
    return tuple(BesideMesh(mesh_owner(m), m, clearance + m.spacing) for m in mission.meshes)


def free_spaces_of(mission: MissionIR, drone: Drone) -> FreeSpaces:
    """Return the free space of flight, and the one with the clearances of transfers."""
    space, wide = flight_space(mission, drone), _kept_on_ways(mission)

    def widened(obstacle: Obstacle) -> Obstacle:
        apart = wide.get(obstacle.owner)
        return (
            obstacle if apart is None else replace(obstacle, clearance=drone.radius + apart.metres + MARGIN_M)
        )

    required = frozenset(owner for owner, apart in wide.items() if apart is not None and apart.required)
    return FreeSpaces(space, replace(space, obstacles=tuple(map(widened, space.obstacles))), required)


def _kept_on_ways(mission: MissionIR) -> dict[Owner, SolidClearance | None]:
    zones = from_zones(mission)
    solids = {zone_owner(z): zones for z in mission.zones if z.keep == "out"}
    return solids | {target_owner(t): from_target(mission, t.name) for t in mission.targets}


def pad_space(mission: MissionIR, drone: Drone) -> FreeSpace:
    """Return the free space of take-off and landing.

    It has no clearances beyond the radius, no ground and no floors of keep-in zones. Zones, meshes, the
    bodies of targets and the separation from parked drones still hold.
    """
    around = (*clearances_of(mission, drone, at_pad=True), *from_parked(mission, drone))
    space = _space(around, [], floors=False)
    return replace(space, meshes=_beside_meshes(mission, drone.radius))


def _space(around: Iterable[Clearance], walls: list[Wall], *, floors: bool) -> FreeSpace:
    """Return clearances as a free space.

    walls : half-spaces that come first
    floors : whether the floors of keep-in zones hold
    """
    solids = list(around)
    obstacles = [
        Obstacle(c.owner, bounded(part), c.metres)
        for c in solids
        if not c.inside
        for part in convex_parts(c.solid)
    ]
    discs: list[Disc] = []
    for c in solids:
        if not c.inside:
            continue
        walls += _lids(c, floors=floors)
        if isinstance(c.solid, Cylinder):
            discs.append(Disc(c.owner, c.solid.centre, c.solid.radius - c.metres))
            continue
        hull, pockets = hull_and_pockets(c.solid)
        walls += _sides(c.owner, hull, c.metres)
        obstacles += [Obstacle(c.owner, bounded(pocket), c.metres) for pocket in pockets]
    return FreeSpace(tuple(obstacles), tuple(walls), tuple(discs))


def _lids(zone: Clearance, *, floors: bool) -> list[Wall]:
    lids = []
    if floors and zone.solid.bottom > -inf:
        lids.append(Wall(zone.owner, (0.0, 0.0, 1.0), zone.solid.bottom + zone.metres, zone.metres))
    if zone.solid.top < inf:
        lids.append(Wall(zone.owner, (0.0, 0.0, -1.0), zone.metres - zone.solid.top, zone.metres))
    return lids


def _sides(owner: Owner, hull: Prism, radius: float) -> list[Wall]:
    sides = []
    for (ax, ay), (bx, by) in edges(hull.points):
        length = hypot(bx - ax, by - ay)
        n = ((ay - by) / length, (bx - ax) / length)
        sides.append(Wall(owner, (n[0], n[1], 0.0), n[0] * ax + n[1] * ay + radius, radius))
    return sides
