"""Obstacles at a camera's position, and occluders between it and its target. Plain Python, except for
missions with terrain, scenes or buildings.
"""

from collections.abc import Iterator, Sequence
from math import hypot

from shotc.geom.line_of_sight import crosses
from shotc.geom.shapes import bodies_of, touch
from shotc.geom.solids import Solid, convex_parts
from shotc.geom.vec import Vec3, minus, plus
from shotc.geom.viewpoint import KeptSolid
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import GROUND, Owner, mesh_owner, target_owner, zone_owner
from shotc.ir.target import Target

ROUNDING_M = 1e-6

HALF_SHARE = 0.5
"""Share of the outline: a target with a smaller free share counts as hidden in that frame.

It is also a share of the frames: a shot that hides its target in more of them does not show it (V050).
"""


def lacks(mission: MissionIR, drone: Drone, p: Vec3, t: float) -> Iterator[tuple[Owner, float]]:
    """Yield every owner that a drone at p, metres, is too near to at time t, and the lack, metres."""
    yield from _lacks_of_solids(mission, drone, p, t)
    if mission.terrain is not None:
        lack = mission.lowest(p, drone.radius) - p[2]
        if lack > ROUNDING_M:
            yield GROUND, lack
    for mesh in mission.meshes:
        (lack,) = mesh.lacks((p,), mission.rules.beside_obstacle(drone.radius))
        if lack > ROUNDING_M:
            yield mesh_owner(mesh), lack


def without_room(mission: MissionIR, drone: Drone, eyes: Sequence[tuple[float, Vec3]]) -> list[bool]:
    """Return for each time and place whether a drone is too near to anything there."""
    blocked = [any(True for _ in _lacks_of_solids(mission, drone, eye, t)) for t, eye in eyes]
    places = [eye for _, eye in eyes]
    if mission.terrain is not None:
        low = [mission.lowest(p, drone.radius) - p[2] > ROUNDING_M for p in places]
        blocked = [a or b for a, b in zip(blocked, low, strict=True)]
    for mesh in mission.meshes:
        lack = mesh.lacks(places, mission.rules.beside_obstacle(drone.radius))
        blocked = [a or by > ROUNDING_M for a, by in zip(blocked, lack, strict=True)]
    return blocked


def _lacks_of_solids(mission: MissionIR, drone: Drone, p: Vec3, t: float) -> Iterator[tuple[Owner, float]]:
    for owner, solid in _kept_solids(mission, drone, t):
        lack = solid.lack(p)
        if lack > ROUNDING_M:
            yield owner, lack


def kept_solids(mission: MissionIR, drone: Drone, t: float) -> tuple[KeptSolid, ...]:
    """Return the zones and targets that a drone keeps clear of at time t, with its distance from each."""
    return tuple(solid for _, solid in _kept_solids(mission, drone, t))


def _kept_solids(mission: MissionIR, drone: Drone, t: float) -> Iterator[tuple[Owner, KeptSolid]]:
    for zone in mission.zones:
        yield zone_owner(zone), KeptSolid(zone.solid, zone.keep == "in", drone.radius)
    need = mission.rules.beside_target(drone.radius)
    for target in mission.targets:
        yield target_owner(target), KeptSolid(target.kept_clear_at(t), False, need)


def hides(mission: MissionIR, name: str, eye: Vec3, t: float) -> str | None:
    """Return the name of an occluder between a camera and a target's middle or one of its sides, or None.

    Terrain, scenes and buildings count if they hide any of the points of ``hidden_by_surfaces``.
    """
    solid = next(
        (occluder for occluder in standing_before(mission, name, eye, t) if occluder is not None), None
    )
    if solid is not None:
        return solid
    return next((by for by, shares in _by_surfaces(mission, name, ((t, eye),)) if any(shares)), None)


def hidden_by_surfaces(mission: MissionIR, name: str, eyes: Sequence[tuple[float, Vec3]]) -> list[float]:
    """Return the share of a target that terrain, scenes and buildings hide, for each time and place.

    It is the largest share that one of them hides of the upright rectangle that stands in for the target in
    planning.
    """
    most = [0.0] * len(eyes)
    for _, shares in _by_surfaces(mission, name, eyes):
        most = list(map(max, most, shares))
    return most


def _by_surfaces(
    mission: MissionIR, name: str, eyes: Sequence[tuple[float, Vec3]]
) -> Iterator[tuple[str, Sequence[float]]]:
    """Yield the surfaces that may hide a target, with sort and name, and the hidden share from each place."""
    if not (mission.meshes or mission.terrain):
        return
    from shotc.ir.hiding_surfaces import shares_hidden_by

    yield from shares_hidden_by(mission, name, eyes)


def standing_before(mission: MissionIR, name: str, eye: Vec3, t: float) -> Iterator[str | None]:
    """Yield the name of the solid, or None, before a target's middle, one side and the other side.

    A target that overlaps or touches this one is a part of the same thing and hides nothing of it.
    """
    target = mission.target(name)
    x, y, z = target.at(t)
    solids = tuple(_occluding(mission, target, t))
    level = max(hypot(x - eye[0], y - eye[1]), 1e-9)
    across = (-(y - eye[1]) / level, (x - eye[0]) / level)
    width = target.shape_at(t).half_width(across)
    offset = (across[0] * width, across[1] * width)
    points = [(x, y, z), (x + offset[0], y + offset[1], z), (x - offset[0], y - offset[1], z)]
    for p in points:
        yield next((n for n, solid in solids if crosses(solid, eye, p)), None)


def occluders_of(mission: MissionIR, name: str, t: float) -> tuple[Solid, ...]:
    """Return the convex parts of the solids that may hide a target at time t."""
    solids = _occluding(mission, mission.target(name), t)
    return tuple(part for _, solid in solids for part in convex_parts(solid))


def _occluding(mission: MissionIR, target: Target, t: float) -> Iterator[tuple[str, Solid]]:
    """Yield the solids that may hide a target at time t, with their names."""
    yield from ((zone.name, zone.solid) for zone in mission.opaque_zones)
    one = mission.one_with(target.name)
    others = (o for o in mission.targets if o.name not in one and not _parts_of_one(o, target, t))
    yield from ((o.name, o.solid_at(t)) for o in others)


def _parts_of_one(a: Target, b: Target, t: float) -> bool:
    apart, own, other = minus(a.at(t), b.at(t)), bodies_of(a.shape_at(t)), bodies_of(b.shape_at(t))
    return any(
        bool(touch(p.shape, q.shape, minus(plus(apart, p.offset), q.offset))) for p in own for q in other
    )
