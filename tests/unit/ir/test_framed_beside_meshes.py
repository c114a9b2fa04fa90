"""Framings beside meshes and over terrain: their bearing is one from which the subject is seen."""

from __future__ import annotations

from math import atan2, degrees

import numpy as np
import pytest

from shotc.geom.surface.ground import ground_of
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.hidden import hidden_by_surfaces, hides, lacks
from shotc.ir.mission import MissionIR
from shotc.ir.terrain import Terrain
from tests.support.front_passes import clean
from tests.support.mesh_spaces import with_meshes
from tests.support.scenes import house, turned
from tests.support.surfaces import distances

pytestmark = pytest.mark.slow

TEXT = """\
shotc: 1
mission: square
targets:
  statue: {at: [0, 0, 1.5], radius: 0.5, height: 3}
  bench: {at: [3, 0, 1], radius: 0.5, height: 2}
drones: {cam: {model: x500, home: [0, -60, 0]}}
rules: {composition: keep}
shots:
  - {id: s, kind: framing, drone: cam, timing: {start: 20, duration: 5}, subjects: [SUBJECTS]}
"""
RING = np.linspace(0.0, 2 * np.pi, 7)[:-1]
ALONE = "{target: statue, size: 0.3}"


def square(subjects: str = ALONE) -> MissionIR:
    return clean(TEXT.replace("SUBJECTS", subjects)).mission


def course(mission: MissionIR) -> StartedFraming:
    return course_of(mission, mission.shots[0], 20.0)


def bearing(of: StartedFraming) -> float:
    x, y, _ = of.poses[0][:3]
    return degrees(atan2(x, y)) % 360.0


def seen_whole(mission: MissionIR, of: StartedFraming) -> bool:
    eyes = [(t, (p[0], p[1], p[2])) for t, p in zip(of.times, of.poses, strict=True)]
    return not any(hidden_by_surfaces(mission, "statue", eyes))


def test_a_bearing_is_turned_until_no_house_stands_before_the_subject():
    mission = square()
    assert bearing(course(mission)) == pytest.approx(180.0)
    barn = turned(house(6.0, 2.0, 6.0, 7.0), 0.0, (0.0, -4.0))
    beside = with_meshes(mission, barn)
    found = course(beside)
    assert 20.0 < abs(bearing(found) - 180.0) < 90.0
    assert (found.blocked, found.hidden) == (0.0, 0.0)
    assert seen_whole(beside, found)
    assert not seen_whole(beside, course(mission))


def test_a_bearing_is_turned_until_the_camera_has_room_beside_houses():
    mission = square()
    at = course(mission).poses[0][:3]
    barn = turned(house(6.0, 6.0, 6.0, 7.0), 0.0, (at[0], at[1] - 4.0))
    beside = with_meshes(mission, barn)
    found = course(beside)
    x, y, z = found.poses[0][:3]
    assert found.blocked == 0.0
    need = mission.rules.beside_obstacle(mission.drones[0].radius)
    assert distances(barn, np.array([[x, y, z]]))[0] >= need - 1e-6
    assert distances(barn, np.array([at]))[0] < need


def test_of_bearings_none_of_which_is_clear_the_one_that_hides_least_is_taken():
    wall = np.concatenate(
        [turned(house(3.0, 2.0, 9.0, 9.5), a, (4 * np.sin(a), -4 * np.cos(a))) for a in RING]
    )
    level = ALONE.replace("size", "view: {elevation: 5 deg}, size")
    beside = with_meshes(square(level), wall)
    found, plain = course(beside), course(square(level))
    eyes = [(20.0, plain.poses[0][:3])]
    assert 0.0 < found.hidden < hidden_by_surfaces(beside, "statue", eyes)[0]


def test_a_camera_looks_over_a_wall_that_hides_two_thirds_of_a_walker_for_most_of_the_way():
    """Over the whole way less than half of the walker is hidden."""
    track = "walker: {track: {points: [[0, 0, 1.5], [20, 0, 1.5]], speed: 1}, radius: 0.5, height: 3}"
    text = TEXT.replace("bench: {at: [3, 0, 1], radius: 0.5, height: 2}", track)
    text = text.replace("SUBJECTS", "{target: walker, size: 0.3, view: {azimuth: 180 deg}}")
    mission = clean(text.replace("{start: 20, duration: 5}", "{start: 0, duration: 20}")).mission
    beside = with_meshes(mission, turned(house(14.0, 1.0, 1.9, 1.91), 0.0, (10.0, -3.0)))
    level, found = (course_of(of, of.shots[0], 0.0) for of in (mission, beside))
    eyes = [(t, (p[0], p[1], p[2])) for t, p in zip(level.times, level.poses, strict=True)]
    shares = np.array(hidden_by_surfaces(beside, "walker", eyes))
    assert shares.mean() < 0.5 < (shares >= 0.5).mean()
    assert found.poses[0][2] > level.poses[0][2] + 1.0
    assert (found.hidden, found.lost) == (0.0, 0.0)


def test_several_subjects_are_filmed_from_the_side_on_which_no_house_stands():
    mission = square("{target: statue, size: 0.3, frame: [0, 0]}, {target: bench}")
    plain = course(mission)
    x, y, _ = plain.poses[0][:3]
    barn = turned(house(9.0, 2.0, 6.0, 7.0), -atan2(x - 1.5, y), (0.5 * (x + 1.5), 0.5 * y))
    beside = with_meshes(mission, barn)
    found = course(beside)
    assert not seen_whole(beside, plain)
    assert seen_whole(beside, found)


@pytest.mark.long
def test_a_bearing_is_turned_until_no_hill_hides_the_subject():
    corners = np.array([[-400.0, -400.0], [400.0, -400.0], [400.0, 400.0], [-400.0, 400.0], [0.0, -20.0]])
    ring = np.array([[-9.0, -20.0], [0.0, -26.0], [9.0, -20.0], [0.0, -14.0]])
    flat = np.concatenate([corners[:4], ring])
    points = np.column_stack([np.concatenate([flat, corners[4:]]), np.append(np.zeros(8), 14.0)])
    outside = [(0, 1, 5), (1, 6, 5), (1, 2, 6), (2, 7, 6), (2, 3, 7), (3, 4, 7), (3, 0, 4), (0, 5, 4)]
    faces = np.array([*outside, (4, 5, 8), (5, 6, 8), (6, 7, 8), (7, 4, 8)])
    mission = clean(TEXT.replace("SUBJECTS", "{target: statue, size: 0.03}")).mission
    assert bearing(course(mission)) == pytest.approx(180.0)
    hill = mission._replace(terrain=Terrain(ground_of(points, faces), "relief.csv"))
    found = course(hill)
    assert abs(bearing(found) - 180.0) > 10.0
    assert seen_whole(hill, found)
    assert not seen_whole(hill, course(mission))
    assert [str(owner) for owner, _ in lacks(hill, hill.drones[0], (0.0, -20.0, 15.0), 20.0)] == ["ground"]


def test_what_hides_and_what_lacks_room_is_named():
    beside = with_meshes(square(), turned(house(6.0, 2.0, 6.0, 7.0), 0.0, (0.0, -4.0)))
    assert hides(beside, "statue", (0.0, -12.0, 1.5), 20.0) == "scene a.ply"
    assert hides(beside, "statue", (-12.0, 0.0, 1.5), 20.0) is None
    assert [str(owner) for owner, _ in lacks(beside, beside.drones[0], (0.0, -6.0, 3.0), 20.0)] == ["scene"]
