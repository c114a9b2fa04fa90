"""From a mission's zones, targets and rules to the room of one drone's centre."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, inf
from typing import NamedTuple

from shotc.geom.convex import bounded
from shotc.geom.corridor import MARGIN, Disc, Obstacle, Room, Wall
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts, edges, hull_and_pockets, point
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.transits import Apart, from_target, from_zones

GROUND = "ground"


class Rooms(NamedTuple):
    """Where a drone may be: with the clearances of all phases, and with those of ways between shots.

    required : owners whose clearances on ways the mission writes down
    """

    flight: Room
    transit: Room
    required: frozenset[str] = frozenset()


def flight_room(mission: MissionIR, drone: Drone) -> Room:
    """Return the room of every phase but take-off and landing, as far as it stands.

    A drone that films nothing stands on its pad; those that fly are no part of a room.
    """
    obstacles = _keep_outs(mission, drone)
    for target in (t for t in mission.targets if t.track is None):
        half = target.height / 2
        x, y, z = target.centre
        part = Cylinder((x, y), target.radius, z - half, z + half)
        clearance = drone.radius + mission.rules.target_clearance
        obstacles.append(Obstacle(f"target {target.name}", part, clearance))
    obstacles += _parked(mission, drone)
    over_ground = mission.rules.ground_clearance + drone.radius
    walls = [Wall(GROUND, (0.0, 0.0, 1.0), over_ground, over_ground)]
    return _with_keep_ins(mission, drone, (obstacles, walls), floors=True)


def rooms_of(mission: MissionIR, drone: Drone) -> Rooms:
    """Return the room of flight, and the same with the clearances that are kept on ways between shots."""
    room, wide = flight_room(mission, drone), _kept_on_ways(mission)

    def widened(obstacle: Obstacle) -> Obstacle:
        apart = wide.get(obstacle.owner)
        return (
            obstacle if apart is None else replace(obstacle, clearance=drone.radius + apart.metres + MARGIN)
        )

    required = frozenset(owner for owner, apart in wide.items() if apart is not None and apart.required)
    return Rooms(room, replace(room, obstacles=tuple(map(widened, room.obstacles))), required)


def _kept_on_ways(mission: MissionIR) -> dict[str, Apart | None]:
    zones = from_zones(mission)
    kept = {f"zone {z.name}": zones for z in mission.zones if z.keep == "out"}
    return kept | {f"target {t.name}": from_target(mission, t.name) for t in mission.targets}


def pad_room(mission: MissionIR, drone: Drone) -> Room:
    """Return the room of take-off and landing: no clearances, no ground, no keep-in floors.

    Zones and the targets' own bodies still bind, and so does the separation from parked drones.
    """
    obstacles = _keep_outs(mission, drone)
    for target in (t for t in mission.targets if t.track is None):
        half = target.height / 2
        x, y, z = target.centre
        part = Cylinder((x, y), target.radius, z - half, z + half)
        obstacles.append(Obstacle(f"target {target.name}", part, drone.radius))
    obstacles += _parked(mission, drone)
    return _with_keep_ins(mission, drone, (obstacles, []), floors=False)


def owner_path(mission: MissionIR, owner: str) -> KeyPath:
    """Return where the mission file writes down an obstacle's or a wall's owner."""
    for zone in mission.zones:
        if owner == f"zone {zone.name}":
            return zone.path
    for target in mission.targets:
        if owner == f"target {target.name}":
            return target.path
    for drone in mission.drones:
        if owner == f"drone {drone.name}":
            return drone.path
    return ("rules", "ground_clearance")


def named(owner: str) -> str:
    """Write an owner for people: zone `tree` instead of zone tree."""
    kind, _, name = owner.partition(" ")
    return (
        f"{kind} `{name}`"
        if kind in {"zone", "target", "drone"}
        else owner
        if owner != GROUND
        else "the ground"
    )


def _keep_outs(mission: MissionIR, drone: Drone) -> list[Obstacle]:
    return [
        Obstacle(f"zone {zone.name}", bounded(part), drone.radius)
        for zone in mission.zones
        if zone.keep == "out"
        for part in convex_parts(zone.solid)
    ]


def _parked(mission: MissionIR, drone: Drone) -> list[Obstacle]:
    return [
        Obstacle(f"drone {other.name}", point(other.home), mission.rules.separation)
        for other in mission.parked
        if other.name != drone.name
    ]


def _with_keep_ins(
    mission: MissionIR, drone: Drone, found: tuple[list[Obstacle], list[Wall]], *, floors: bool
) -> Room:
    obstacles, walls = found
    discs: list[Disc] = []
    for zone in mission.zones:
        if zone.keep == "out":
            continue
        owner = f"zone {zone.name}"
        walls += _lids(owner, zone.solid, drone.radius, floors=floors)
        if isinstance(zone.solid, Cylinder):
            discs.append(Disc(owner, zone.solid.centre, zone.solid.radius - drone.radius))
            continue
        hull, pockets = hull_and_pockets(zone.solid)
        walls += _sides(owner, hull, drone.radius)
        obstacles += [Obstacle(owner, bounded(pocket), drone.radius) for pocket in pockets]
    return Room(tuple(obstacles), tuple(walls), tuple(discs))


def _lids(owner: str, solid: Solid, radius: float, *, floors: bool) -> list[Wall]:
    lids = []
    if floors and solid.bottom > -inf:
        lids.append(Wall(owner, (0.0, 0.0, 1.0), solid.bottom + radius, radius))
    if solid.top < inf:
        lids.append(Wall(owner, (0.0, 0.0, -1.0), radius - solid.top, radius))
    return lids


def _sides(owner: str, hull: Prism, radius: float) -> list[Wall]:
    sides = []
    for (ax, ay), (bx, by) in edges(hull.points):
        length = hypot(bx - ax, by - ay)
        n = ((ay - by) / length, (bx - ax) / length)
        sides.append(Wall(owner, (n[0], n[1], 0.0), n[0] * ax + n[1] * ay + radius, radius))
    return sides
