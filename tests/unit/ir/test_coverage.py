"""Shares of targets' outlines that are covered over mission time: who covers, who is one with the target."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.shapes import BoxShape, CylinderShape
from shotc.geom.solids import box
from shotc.geom.surface.tree import surface_of
from shotc.geom.track import Track
from shotc.ir.coverage import coverage
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.occlusion import hiders, others_of
from shotc.ir.target import Target
from tests.support.film_plans import orbit_mission
from tests.support.records import replace
from tests.support.sight_plans import at, film, mission, still

MAST: Target = replace(
    orbit_mission().targets[0],
    name="mast",
    centre=(0.0, 0.0, 5.0),
    shape=CylinderShape(1.0, 10.0),
    track=None,
)
CAR: Target = replace(
    MAST,
    name="car",
    centre=(0.0, 0.0, 1.0),
    shape=BoxShape(8.0, 2.0, 2.0, (1.0, 0.0)),
    track=Track((0.0, 10.0, 20.0), ((0.0, 0.0, 1.0), (100.0, 0.0, 1.0), (100.0, 100.0, 1.0))),
)
POST = Zone("post", "out", box((-10.0, 0.0, 10.0), (0.5, 0.5, 20.0), 0.0), ("world", "zones", "post"))


def of(*targets: Target, zones: tuple[Zone, ...] = ()) -> MissionIR:
    return replace(mission(), targets=targets, zones=zones)


def shares(
    asked: MissionIR, target: str, eyes: list[tuple[float, float, float]], times: list[float]
) -> list[float]:
    return coverage(asked, (), target, np.array(eyes), np.array(times)).share.tolist()


def test_a_post_covers_its_width_as_the_eye_sees_it() -> None:
    eyes = [(-20.0, y, 5.0) for y in (0.0, 30.0)]
    found = coverage(of(MAST, zones=(POST,)), (), "mast", np.array(eyes), np.zeros(2))
    assert found.share == pytest.approx([0.5, 0.0], abs=0.06)
    assert [name for name, _ in found.by] == ["zone post"]
    inside = replace(POST, solid=box((0.0, 0.0, 5.0), (9.0, 9.0, 20.0), 0.0))
    assert shares(of(MAST, zones=(inside,)), "mast", eyes, [0.0, 0.0]) == [1.0, 1.0]
    fence = replace(POST, keep="in")
    assert shares(of(MAST, zones=(fence,)), "mast", eyes, [0.0, 0.0]) == [0.0, 0.0]


def test_a_box_is_covered_as_it_turns_with_its_course() -> None:
    """A wall a metre wide beside the road: of the car's side it covers an eighth, of its front a half."""
    wall = Zone("wall", "out", box((50.0, -4.0, 5.0), (1.0, 0.2, 10.0), 0.0), ("world", "zones", "wall"))
    front = Zone("front", "out", box((100.5, 60.0, 5.0), (1.0, 0.2, 10.0), 0.0), ("world", "zones", "front"))
    asked = of(CAR, zones=(wall, front))
    found = shares(asked, "car", [(50.0, -400.0, 1.0), (100.0, 400.0, 1.0)], [5.0, 15.0])
    assert found == pytest.approx([1 / 8, 1 / 2], abs=0.07)


def test_targets_cover_each_other_where_they_do_not_touch() -> None:
    wide = replace(MAST, name="wide", centre=(-12.0, 0.0, 5.0), shape=CylinderShape(2.0, 10.0))
    eye = [(-40.0, 0.0, 5.0)]
    assert shares(of(MAST, wide), "mast", eye, [0.0]) == [1.0]
    touching = replace(wide, centre=(-3.0, 0.0, 5.0))
    assert shares(of(MAST, touching), "mast", eye, [0.0]) == [0.0]
    car = replace(CAR, track=Track((0.0, 10.0), ((-20.0, -50.0, 1.0), (-20.0, 50.0, 1.0))))
    passing = shares(of(MAST, car), "mast", [(-40.0, 0.0, 1.0)] * 3, [0.0, 5.0, 10.0])
    assert passing[::2] == [0.0, 0.0]
    assert 0.2 < passing[1] < 0.5


def test_drones_cover_and_are_named() -> None:
    eye, bird = film("eye", still(at(-40.0, 0.0, 5.0))), film("bird", still(at(-20.0, 0.0, 5.0)))
    found = coverage(
        of(MAST), others_of((eye, bird), "eye"), "mast", np.array([[-40.0, 0.0, 5.0]]), np.zeros(1)
    )
    radius = of(MAST).drone("bird").radius
    assert found.share[0] == pytest.approx(np.pi * (2 * radius) ** 2 / 20.0, abs=0.03)
    assert [name for name, _ in found.by] == ["drone bird"]


def house(x: float, size: float) -> ObstacleMesh:
    """The walls and the lid of a house about (x, 0), as high as wide."""
    solid = box((x, 0.0, size / 2), (size, size, size), 0.0)
    low, high = ([(*p, z) for p in solid.points] for z in (0.0, size))
    quads = [(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
    faces = [t for a, b, c, d in [*quads, tuple(high)] for t in ((a, b, c), (a, c, d))]
    surface = surface_of(np.array(faces))
    one = np.zeros(len(faces), dtype=np.intp)
    return ObstacleMesh("buildings", "houses.geojson", surface, one, ("house",), one, np.ones(1, dtype=bool))


def test_a_house_covers_what_is_behind_it_and_not_itself() -> None:
    church: Target = replace(
        MAST, name="church", centre=(0.0, 0.0, 5.0), shape=BoxShape(10.0, 10.0, 10.0, (1.0, 0.0))
    )
    eyes, t = np.array([[-40.0, 1.0, 8.0]]), np.zeros(1)
    itself = replace(of(church), meshes=(house(0.0, 10.0),))
    assert coverage(itself, (), "church", eyes, t).share.tolist() == [0.0]
    assert not any(hides.any() for _, hides in hiders(itself, (), "church", eyes, t))
    before = replace(of(church), meshes=(house(-20.0, 10.0),))
    found = coverage(before, (), "church", eyes, t)
    assert found.share[0] > 0.5
    assert [name for name, _ in found.by] == ["buildings houses.geojson"]
    assert all(hides.all() for _, hides in hiders(before, (), "church", eyes, t))
