"""Homes and cameras beside scenes and buildings: outside of closed parts, and far enough from every triangle.

As with zones, what the user placed binds, and a generated path is an ideal that a plan may leave. Targets may
touch a scene or stand in it, because their models are often a part of it. This module needs numpy, as meshes
do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import cos, dist, pi, sin
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.surface.near import nearest, within
from shotc.geom.surface.triangles import segment_distances
from shotc.ir.drone import Drone
from shotc.ir.keyed import is_keyed
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.origin import KeyPath
from shotc.ir.owners import mesh_owner
from shotc.passes.resolve.checks.heights import Way, raised, way_of
from shotc.passes.resolve.checks.home import stands_free
from shotc.passes.resolve.checks.places import by_line
from shotc.planning.clearances import ROUNDING_M, clearances_of, move, outward
from shotc.rounding import at_least

PAD_RADIUS_RATIO = 1.5
"""Height above the home, over the body's radius, from which on nothing may be too near; below is its
support.
"""
WAY_DIRECTIONS = 24  # horizontal directions in which a free place is searched
REACHES_M = tuple(0.25 * 1.12**k for k in range(52))  # distances in each of them, up to 81 m
LIFTS_M = tuple(float(k) for k in range(1, 61))  # metres by which a path is raised
LARGE_M = 1_000.0  # metres of a scene that may be in another unit


class MeshClearance(NamedTuple):
    """The relation of a place to the mesh that leaves it the least clearance.

    away : metres from the nearest triangle, negative inside of closed parts
    lack : missing distance, metres; 0 or less where there is enough
    name : of the nearest part
    """

    mesh: ObstacleMesh
    away: float
    lack: float
    name: str


def check_homes_beside(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the homes inside of something, or below something that blocks the take-off."""
    for drone in mission.drones:
        near = next(
            (n for mesh in mission.meshes if (n := _over_pad(mission, drone, mesh)) is not None), None
        )
        if near is None:
            continue
        labels = (
            mission.origins.value((*drone.path, "home")),
            mission.origins.key(near.mesh.path, "the obstacle"),
        )
        inside = near.away < 0.0
        message = f"the home of `{drone.name}` is {'inside of' if inside else 'too near to'} {_words(near)}"
        how = (
            f"it is {-near.away:.2f} m deep in it"
            if inside
            else f"the take-off comes within {at_least(near.away + 0.0)} m"
        )
        note = f"{how}; {_needed(near.mesh, drone.radius, 0.0)} must be free"
        yield Diagnostic("G027", message, labels, (note, *_large(near.mesh)), _other_home(mission, drone))


def check_shot_beside(mission: MissionIR, shot: Shot, film: Way) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield where a shot's camera is too near to a mesh, with the key path."""
    if shot.ideal is None or is_keyed(shot):
        for path, keyframes in by_line(shot).items():
            fixed = [k.at for k in keyframes if k.beside is None or shot.ideal is None]
            yield from _blocked(mission, shot, (*path, "at"), fixed, bound=keyframes[0].placed)
        return
    places = [moment.at for moment in film]
    yield from _blocked(mission, shot, (*shot.path, "at"), places, bound=shot.ideal.placed)


def _blocked(
    mission: MissionIR, shot: Shot, path: KeyPath, places: Sequence[Vec3], *, bound: bool
) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the fault of places from one line of the mission; bound : whether the camera has to be there."""
    if not places:
        return
    drone = mission.drone(shot.drone)
    blocked = _nearest(mission, np.array(places), drone)
    lacking = [(near, at) for near, at in zip(blocked, places, strict=True) if near.lack > ROUNDING_M]
    if not lacking:
        return
    near, at = max(lacking, key=lambda pair: pair[0].lack)
    relation = f"is {'inside of' if near.away < 0.0 else 'too close to'} {_words(near)}"
    where = f"{-near.away:.2f} m deep in it" if near.away < 0.0 else f"{near.away:.2f} m away from it"
    need = _needed(near.mesh, drone.radius, mission.rules.obstacle_clearance)
    notes: tuple[str, ...] = (f"it is {where}; {need} must be free", *_large(near.mesh))
    if len(places) > 1:
        worst = ", ".join(f"{c:.1f}" for c in at)
        notes = (*notes, f"{len(lacking)} of {len(places)} points have this fault; the worst is [{worst}]")
    labels = (mission.origins.value(path), mission.origins.key(near.mesh.path, "the obstacle"))
    if bound:
        what = "the keyframe" if shot.kind == "keyframes" else "the camera"
        yield (
            path[:-1],
            Diagnostic("G028", f"{what} {relation}", labels, notes, _other_place(mission, drone, at)),
        )
        return
    higher = _higher(mission, shot, places)
    if len(lacking) == len(places):
        help_ = higher or "give the shot another distance or altitude"
        yield path[:-1], Diagnostic("G028", f"the path of this {shot.kind} {relation}", labels, notes, help_)
        return
    help_ = f"the plan will leave the ideal here{f'; to keep it, {higher}' if higher else ''}"
    message = f"the ideal path of this {shot.kind} {relation}"
    yield path[:-1], Diagnostic("G029", message, labels, notes, help_)


def _words(near: MeshClearance) -> str:
    return mesh_owner(near.mesh)._replace(name=near.name).words


def _large(mesh: ObstacleMesh) -> Iterator[str]:
    """Yield the size of a scene that may be in another unit than is written."""
    size = float(np.ptp(mesh.surface.triangles.reshape(-1, 3), axis=0).max())
    if mesh.kind == "scene" and size > LARGE_M:
        yield f"the scene measures {size:.0f} m: in millimetres (`units: mm`) it is {size / 1000:.2g} m large"


def _needed(mesh: ObstacleMesh, radius: float, clearance: float) -> str:
    parts = [f"the obstacle clearance of {clearance:.2f} m"] * (clearance > 0.0)
    parts += [f"half the spacing of its points, {mesh.spacing:.2f} m,"] * (mesh.spacing > 0.0)
    return " and ".join([*parts, f"the body radius of {radius:.2f} m"])


def _nearest(mission: MissionIR, p: Array, drone: Drone) -> list[MeshClearance]:
    """Return the relation of places (K, 3) to the meshes."""
    worst: list[MeshClearance] = []
    for mesh in mission.meshes:
        needed = mission.rules.beside_obstacle(drone.radius) + mesh.spacing
        held = mesh.holds(p)
        closest_points = nearest(mesh.surface, p, np.where(held, np.inf, needed))
        names = [mesh.name_at(int(mesh.surface.source[t])) if t >= 0 else "" for t in closest_points.triangle]
        distances = np.where(held, -closest_points.distance, closest_points.distance)
        near = [
            MeshClearance(mesh, float(a), needed - float(a), name)
            for a, name in zip(distances, names, strict=True)
        ]
        worst = [max(pair, key=lambda n: n.lack) for pair in zip(worst or near, near, strict=True)]
    return worst


def _over_pad(mission: MissionIR, drone: Drone, mesh: ObstacleMesh) -> MeshClearance | None:
    """Return the obstacle on the vertical above a home, if there is one."""
    home, body = np.array([drone.home]), drone.radius + mesh.spacing
    if mesh.holds(home)[0]:
        closest_points = nearest(mesh.surface, home)
        deep = float(closest_points.distance[0])
        return MeshClearance(
            mesh, -deep, body + deep, mesh.name_at(int(mesh.surface.source[closest_points.triangle[0]]))
        )
    x, y, z = drone.home
    low = z + PAD_RADIUS_RATIO * drone.radius + mesh.spacing
    a, b = np.array([[x, y, low]]), np.array([[x, y, max(low, mission.lowest(drone.home, drone.radius))]])
    pairs = within(mesh.surface, a, b, body)
    if not len(pairs):
        return None
    count = len(pairs)
    distances = segment_distances(
        mesh.surface.triangles[pairs.triangle], np.repeat(a, count, axis=0), np.repeat(b, count, axis=0)
    )
    k = int(distances.argmin())
    least = float(distances[k])
    name = mesh.name_at(int(mesh.surface.source[pairs.triangle[k]]))
    return MeshClearance(mesh, least, body - least, name) if least < body - ROUNDING_M else None


def _other_home(mission: MissionIR, drone: Drone) -> str:
    """Return the move to the nearest home with a free take-off, in words."""
    over = drone.home[2] - mission.ground(*drone.home[:2])

    def free(q: Vec3) -> bool:
        moved = drone._replace(home=q)
        beside = all(_over_pad(mission, moved, mesh) is None for mesh in mission.meshes)
        return beside and stands_free(mission, moved)

    def at(x: float, y: float, _: float) -> Vec3:
        return (x, y, mission.ground(x, y) + over)

    place = _first(drone.home, [at(*q) for q in _around(drone.home, steep=False)], free)
    return "move the home" if place is None else move(drone.home, place)


def _other_place(mission: MissionIR, drone: Drone, p: Vec3) -> str:
    """Return the move to the nearest place that is clear of everything, in words."""
    around = clearances_of(mission, drone)

    def free(q: Vec3) -> bool:
        if q[2] < mission.lowest(q, drone.radius) - ROUNDING_M or any(o.lack(q) > ROUNDING_M for o in around):
            return False
        return _nearest(mission, np.array([q]), drone)[0].lack <= ROUNDING_M

    places = list(_around(p, steep=True))
    is_free = [near.lack <= 0.0 for near in _nearest(mission, np.array(places), drone)]
    place = _first(p, [q for q, ok in zip(places, is_free, strict=True) if ok], free)
    return "move it to a free place" if place is None else move(p, place)


def _around(p: Vec3, *, steep: bool) -> Iterator[Vec3]:
    """Yield places around one: at its height, and if steep, also above, below and between."""
    x, y, z = p
    for reach in REACHES_M:
        for k in range(WAY_DIRECTIONS):
            east, north = reach * cos(2 * pi * k / WAY_DIRECTIONS), reach * sin(2 * pi * k / WAY_DIRECTIONS)
            yield (x + east, y + north, z)
            if steep:
                yield (x + 0.7 * east, y + 0.7 * north, z + 0.7 * reach)
        if steep:
            yield (x, y, z + reach)
            yield (x, y, z - reach)


def _first(p: Vec3, places: list[Vec3], free: Callable[[Vec3], bool]) -> Vec3 | None:
    """Return the nearest free place, rounded away from ``p``."""
    for q in sorted(places, key=lambda q: dist(p, q)):
        rounded = outward(p, q)
        if free(rounded):
            return rounded
    return None


def _higher(mission: MissionIR, shot: Shot, places: Sequence[Vec3]) -> str:
    """Return how to write the path raised above everything; empty where it has no altitude."""
    if (*shot.path, "altitude") not in mission.origins.values:
        return ""
    drone, p = mission.drone(shot.drone), np.array(places)
    for lift in LIFTS_M:
        if max(near.lack for near in _nearest(mission, p + np.array([0.0, 0.0, lift]), drone)) <= 0.0:
            return raised(mission, shot, way_of(mission, shot), lift)
    return ""
