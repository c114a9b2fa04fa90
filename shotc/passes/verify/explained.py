"""Bounds of a shot's deviation from its ideal, recomputed from the mission.

A plan states how far it leaves the ideal of a shot, and why. This is accepted only as far as the mission
explains it, so that no entry in a file explains an arbitrary distance:

- An obstacle, standing or moving, explains the detour around it: its width or height and twice the
  clearance. A keep-in zone and the ground explain how far the ideal is beyond them. A cause that names
  an obstacle nowhere near the ideal explains nothing.
- The picture, its own and those of other drones, explains a share of the distance to the subject.
- The drone's limits explain its stopping distance, and what its speed lacks against the ideal's.
- Smoothing beyond the normal one explains the distance that is flown in that additional time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse.csgraph import connected_components

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solids import Cylinder, Solid
from shotc.geom.surface.near import nearest
from shotc.ir.bodies import flying, moved
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.owners import mesh_owner
from shotc.ir.path import Deviation
from shotc.ir.preference import MOST_MOVED_SHARE, PICTURE_SHARE, UNWATCHED_M
from shotc.ir.smoothing import NORMAL_S
from shotc.ir.target import Target
from shotc.passes.verify.claims import JudgedFlight

NEAR_M = 1.0
"""Metres beyond its clearances within which an obstacle counts."""

THINGS = ("zone ", "target ", "drone ", "ground", "scene", "building")
"""Prefixes of causes that name an obstacle."""


class ExpectedPlaces(NamedTuple):
    """Ideal positions of a shot, shape (M, 3), and their mission times (M,), None where these are free."""

    places: Array
    times: Array | None


def in_the_way(flight: JudgedFlight, course: ExpectedPlaces, *, placed: bool = False) -> dict[str, float]:
    """Return what blocks a course, named as in causes, and the length of the detour around each, metres.

    placed : whether the author gave the place, which then is left only for moving obstacles
    """
    stands = () if placed else (*_zones(flight, course), *_meshes(flight, course))
    detours = (*stands, *_targets(flight, course, placed=placed), *_drones(flight, course))
    return {name: detour for name, detour in detours if detour > 0.0}


def believed(deviations: Iterable[Deviation], blocks: dict[str, float]) -> list[float]:
    """Return the deviations whose reported cause is possible, the largest first, metres."""
    distances = (
        d.distance for d in deviations if _thing(d.cause) in blocks or not d.cause.startswith(THINGS)
    )
    return sorted(distances, reverse=True)


def _thing(cause: str) -> str:
    """Return a cause without the name of its building, or of its part of a scene."""
    kind, named, _ = cause.partition(" ")
    return {"building": "buildings", "scene": "scene"}.get(kind, cause) if named else cause


def for_the_picture(mission: MissionIR, distance: float, *, placed: bool) -> float:
    """Return how far a picture may move a shot, metres; distance : to the subject.

    placed : whether the author gave the place, which only the pictures of other drones may move
    """
    if not placed:
        return PICTURE_SHARE * distance
    if mission.rules.visibility == "off" or len(mission.drones) == 1:
        return 0.0
    return (PICTURE_SHARE if mission.rules.visibility == "require" else MOST_MOVED_SHARE) * distance


def for_its_limits(flight: JudgedFlight, course: ExpectedPlaces, smoothing: float) -> float:
    """Return how far a drone falls behind a course, metres: where that is too fast, and while it stops.

    smoothing : seconds; the time beyond the normal one adds a distance at the same speed
    """
    assert course.times is not None
    limits, steps = flight.drone.limits, np.diff(course.times)
    rates = np.diff(course.places, axis=0) / steps[:, None]
    level = np.hypot(rates[:, 0], rates[:, 1])
    rise = np.maximum(rates[:, 2] - limits.climb, -rates[:, 2] - limits.descent)
    airspeed = np.hypot(rates[:, 0] - limits.wind[0], rates[:, 1] - limits.wind[1])
    behind = np.hypot(np.maximum(airspeed - limits.speed, 0.0), np.maximum(rise, 0.0)) @ steps
    fastest = min(float(level.max()), limits.fastest) + min(float(np.abs(rates[:, 2]).max()), limits.climb)
    brake = limits.usable_acceleration
    stops = fastest * fastest / (2.0 * brake) + fastest * brake / limits.jerk
    return float(behind + stops + fastest * max(0.0, smoothing - NORMAL_S))


def farthest(mission: MissionIR, names: Iterable[str], course: ExpectedPlaces) -> float:
    """Return the largest distance of a course from the nearest of some targets, metres."""
    targets = [mission.target(name) for name in names]
    if not targets:
        return UNWATCHED_M
    distances = [np.linalg.norm(course.places - _centre(target, course.times), axis=1) for target in targets]
    return float(np.min(distances, axis=0).max())


def _centre(target: Target, times: Array | None) -> Array:
    centre = np.array(target.centre)
    return centre if times is None or target.track is None else centre + moved(target, times)


def _zones(flight: JudgedFlight, course: ExpectedPlaces) -> Iterator[tuple[str, float]]:
    mission, body = flight.mission, flight.drone.radius + NEAR_M
    for zone in mission.zones:
        apart = signed_distance(zone.solid, course.places)
        if zone.keep == "in":
            yield f"zone {zone.name}", float(apart.max()) + body
        elif apart.min() < body:
            yield f"zone {zone.name}", size_of(zone.solid) + 2.0 * body
    yield "ground", mission.rules.ground_clearance + body - float(course.places[:, 2].min())


def _meshes(flight: JudgedFlight, course: ExpectedPlaces) -> Iterator[tuple[str, float]]:
    """Yield the detour around each mesh: above its near parts, or around the widest of them."""
    body = flight.mission.rules.beside_obstacle(flight.drone.radius)
    for mesh in flight.mission.meshes:
        near = body + mesh.spacing + NEAR_M
        closest_points = nearest(mesh.surface, course.places)
        met = (closest_points.distance < near) | mesh.holds(course.places)
        if met.any():
            low, high = _boxes(mesh, np.unique(mesh.part[mesh.surface.source[closest_points.triangle[met]]]))
            over = float(high[:, 2].max() - course.places[:, 2].min())
            yield str(mesh_owner(mesh)), max(over, _widest(low - near, high + near)) + 2.0 * near


def _boxes(mesh: ObstacleMesh, parts: IntArray) -> tuple[Array, Array]:
    """Return the lower and upper corners of boxes around parts of a mesh, shapes (K, 3), metres."""
    of = mesh.part[mesh.surface.source]
    corners = [mesh.surface.triangles[of == part].reshape(-1, 3) for part in parts]
    return np.array([c.min(axis=0) for c in corners]), np.array([c.max(axis=0) for c in corners])


def _widest(low: Array, high: Array) -> float:
    """Return the largest horizontal diagonal of a group of touching boxes, metres."""
    touch = ((low[:, None] <= high) & (high[:, None] >= low))[..., :2].all(axis=2)
    count, of = connected_components(touch)
    spans = [high[of == k, :2].max(axis=0) - low[of == k, :2].min(axis=0) for k in range(count)]
    return float(np.linalg.norm(spans, axis=1).max())


def _targets(flight: JudgedFlight, course: ExpectedPlaces, *, placed: bool) -> Iterator[tuple[str, float]]:
    near = flight.mission.rules.target_clearance + flight.drone.radius + NEAR_M
    for target in flight.mission.targets:
        if (placed and target.track is None) or (course.times is None and target.track is not None):
            continue
        beside = course.places - (_centre(target, course.times) - np.array(target.centre))
        if signed_distance(target.kept_clear, beside).min() < near:
            yield f"target {target.name}", max(2.0 * target.radius, target.height) + 2.0 * near


def _drones(flight: JudgedFlight, course: ExpectedPlaces) -> Iterator[tuple[str, float]]:
    if course.times is None:
        return
    near = flight.mission.rules.separation + NEAR_M
    for other in flight.others:
        if np.linalg.norm(flying(other.curve, course.times) - course.places, axis=1).min() < near:
            yield f"drone {other.drone}", 2.0 * near


def size_of(solid: Solid) -> float:
    """Return the larger of a solid's width and its height, metres."""
    if isinstance(solid, Cylinder):
        return max(2.0 * solid.radius, solid.top - solid.bottom)
    points = np.array(solid.points)
    width = float(np.linalg.norm(points[:, None] - points, axis=-1).max())
    return max(width, solid.top - solid.bottom)
