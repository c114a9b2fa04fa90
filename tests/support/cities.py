"""Random cities of cylinders and boxes, and keyframes drawn in them, for the identification of targets."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import ScreenBox, aim_at
from shotc.geom.surface.inside import bodies
from shotc.geom.surface.tree import surface_of
from shotc.identify.views import FRAME, CameraPose, look
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from tests.support.meshes import box_mesh

HALF_M = 110.0
SHOWN = 0.45
HFOV_RAD, ASPECT = np.radians(70.0), 16 / 9
THIRDS = ((0.0, 0.0), *((a / 3, b / 3) for a in (-1, 1) for b in (-1, 1)))


class Building(NamedTuple):
    """What stands there: its centre in the plan, the radius of the circle about it, its height, metres."""

    centre: tuple[float, float]
    radius: float
    height: float
    triangles: Array


class City(NamedTuple):
    """Buildings, and the mission's scene of all their triangles; owner : of each triangle, its building."""

    buildings: tuple[Building, ...]
    mission: MissionIR
    owner: Array


class Drawn(NamedTuple):
    """A keyframe that somebody framed: of which building, its camera, and the box round the building."""

    building: int
    camera: CameraPose
    box: ScreenBox


def tube(centre: tuple[float, float], radius: float, height: float, sides: int = 24) -> Array:
    """Return the wall and the lid of a cylinder on the ground, without a floor."""
    turn = np.linspace(0.0, 2 * np.pi, sides + 1)
    rim = np.column_stack([centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)])
    low, high = np.column_stack([rim, 0 * turn]), np.column_stack([rim, 0 * turn + height])
    top = np.array([*centre, height])
    faces = [
        f
        for i in range(sides)
        for f in (
            (low[i], low[i + 1], high[i + 1]),
            (low[i], high[i + 1], high[i]),
            (high[i], high[i + 1], top),
        )
    ]
    return np.array(faces)


def block(centre: tuple[float, float], size: tuple[float, float], height: float, turn: float) -> Array:
    """Return a box on the ground, turned, without a floor."""
    made = box_mesh((0.0, 0.0, height / 2), (*size, height))
    made = made[~(np.abs(made[..., 2]) < 1e-9).all(axis=1)]
    c, s = np.cos(turn), np.sin(turn)
    return made @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + np.array([*centre, 0.0])


def mission_of(
    *parts: Array, names: tuple[str, ...] = (), spacing: float = 0.0, kind: str = "scene"
) -> MissionIR:
    """Return a mission whose scene has these parts, (n, 3, 3) each, on the plane z = 0."""
    triangles = np.concatenate(parts)
    made = bodies(triangles)
    mesh = ObstacleMesh(
        kind=kind,
        file="scene.ply",
        surface=surface_of(triangles),
        part=np.repeat(np.arange(len(parts)), [len(p) for p in parts]),
        names=names or ("scene",) * len(parts),
        body=made.body,
        closed=made.closed,
        spacing=spacing,
    )
    return _EMPTY._replace(meshes=(mesh,))


_EMPTY = MissionIR("city", None, 0.0, (), (), (), None, (), 50.0, (), "", (), None)


def one_surface(mission: MissionIR) -> MissionIR:
    """Return a mission whose scene is one open surface: nothing in it tells where a building ends."""
    (mesh,) = mission.meshes
    whole = replace(mesh, body=np.zeros_like(mesh.body), closed=np.zeros(1, dtype=bool))
    return mission._replace(meshes=(whole,))


def random_city(random: np.random.Generator, count: int = 25) -> City:
    """Return a city of cylinders and boxes, 5 to 14 m in radius, 10 to 50 m high, that do not touch."""
    made: list[Building] = []
    while len(made) < count:
        x, y = (float(c) for c in random.uniform(-HALF_M, HALF_M, 2))
        radius, height = float(random.uniform(5, 14)), float(random.uniform(10, 50))
        if any(np.hypot(x - b.centre[0], y - b.centre[1]) < radius + b.radius + 4.0 for b in made):
            continue
        if random.uniform() < 0.5:
            triangles = tube((x, y), radius, height)
        else:
            turn, lean = random.uniform(0, np.pi), random.uniform(0.6, 1.0)
            size = 2 * radius / np.hypot(1.0, lean) * np.array([1.0, lean])
            triangles = block((x, y), (float(size[0]), float(size[1])), height, turn)
        made.append(Building((x, y), radius, height, triangles))
    mission = mission_of(*(b.triangles for b in made))
    owner = np.repeat(np.arange(count), [len(b.triangles) for b in made])
    return City(tuple(made), mission, owner)


def some_keyframes(random: np.random.Generator, city: City, targets: int = 3, each: int = 2) -> list[Drawn]:
    """Return keyframes on some buildings, at least SHOWN of whose boxes show them."""
    chosen = random.choice(len(city.buildings), targets, replace=False)
    found: list[Drawn] = []
    for number in chosen:
        azimuth = random.uniform(0, 2 * np.pi)
        mine: list[Drawn] = []
        for _ in range(40):
            drawn = _keyframe(random, city, int(number), azimuth + random.uniform(-1.0, 1.0))
            if drawn is not None:
                mine.append(drawn)
            if len(mine) == each:
                found += mine
                break
    return found


def _keyframe(random: np.random.Generator, city: City, number: int, azimuth: float) -> Drawn | None:
    """Return a keyframe of a building about the centre or a third; None where too much is hidden."""
    b = city.buildings[number]
    away = random.uniform(2.2, 4.5) * max(2 * b.radius, b.height)
    eye = (
        b.centre[0] + away * np.cos(azimuth),
        b.centre[1] + away * np.sin(azimuth),
        random.uniform(0.4, 1.6) * b.height + 4.0,
    )
    place = THIRDS[int(random.integers(len(THIRDS)))] + random.normal(0.0, 0.2, 2)
    offset = tuple(c - e for c, e in zip((*b.centre, b.height / 2), eye, strict=True))
    aim = aim_at(offset, (float(place[0]), float(place[1])), HFOV_RAD, ASPECT)
    if aim is None or city.mission.meshes[0].holds(np.array([eye])).any():
        return None
    camera = CameraPose(tuple(map(float, eye)), aim[0], aim[1], HFOV_RAD, ASPECT)
    box = box_of(b.triangles, camera)
    if box is None or _blocked(city, number, eye):
        return None
    seen = look(city.mission, camera, box, (4, 4))
    mine = seen.solid.copy()
    mine[mine] = city.owner[seen.triangle[mine]] == number
    return Drawn(number, camera, box) if mine.mean() >= SHOWN else None


def _blocked(city: City, number: int, eye) -> bool:
    """Tell whether an eye is in or over a building, or too near to one."""
    return any(
        np.hypot(eye[0] - b.centre[0], eye[1] - b.centre[1]) < b.radius + 3.0 and eye[2] < b.height + 3.0
        for b in city.buildings
    )


def box_of(triangles: Array, camera: CameraPose) -> ScreenBox | None:
    """Return the box round triangles on screen, or None where a part of them is out of the frame."""
    u, v, depth = camera.view.project(tuple((triangles.reshape(-1, 3) - camera.eye).T))
    if (depth <= 0.1).any():
        return None
    box = ScreenBox(float(u.min()), float(u.max()), float(v.min()), float(v.max()))
    inside = box.u_min >= FRAME.u_min and box.u_max <= FRAME.u_max
    return box if inside and box.v_min >= FRAME.v_min and box.v_max <= FRAME.v_max else None


def sloppy(random: np.random.Generator, box: ScreenBox, share: float = 0.1) -> ScreenBox:
    """Return a box whose edges are off by a share of its sides (SD), as a hand draws it."""
    width, height = box.u_max - box.u_min, box.v_max - box.v_min
    du, dv = random.normal(0.0, share * width, 2), random.normal(0.0, share * height, 2)
    u0, u1 = np.clip([box.u_min + du[0], box.u_max + du[1]], -1.0, 1.0)
    v0, v1 = np.clip([box.v_min + dv[0], box.v_max + dv[1]], -1.0, 1.0)
    return ScreenBox(float(u0), float(u1), float(v0), float(v1))
