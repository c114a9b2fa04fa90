"""Homes and cameras beside scenes and buildings: what is told, with numbers, and that helps are enough."""

from __future__ import annotations

import re

import numpy as np
import pytest

from tests.support.front_passes import placed, resolved
from tests.support.meshes import ply
from tests.support.scene_missions import feature, geojson, house, square
from tests.support.scenes import quad

TEXT = """\
shotc: 1
mission: village
world:
  origin: {lat: 46.68, lon: 7.68, alt: 500}
  buildings: {file: houses.geojson}
targets:
  statue: {at: [0, 60], radius: 1, height: 4}
drones:
  cam: {model: x500, home: HOME, radius: 0.6}
shots:
  - {id: film, drone: cam, SHOT}
"""
CALM = "kind: static, at: [0, 30, 5], look_at: statue"


@pytest.fixture
def folder(tmp_path):
    """A hut of 10 x 10 x 8 m about the origin."""
    (tmp_path / "houses.geojson").write_bytes(
        geojson(feature(square(0, 0, 10), name="hut", building="yes", height=8))
    )
    return tmp_path


def told(folder, shot=CALM, home="[0, -40]", text=TEXT):
    return placed(text.replace("SHOT", shot).replace("HOME", home), folder)[1]


def test_what_keeps_clear_is_not_told(folder):
    assert told(folder) == []


@pytest.mark.long
@pytest.mark.parametrize(
    ("home", "words"),
    [
        ("[0, 0]", "inside of building `hut`"),
        ("[1, 2, 3]", "inside of building `hut`"),
        ("[5.3, 0]", "too near to building `hut`"),
    ],
)
def test_a_home_is_told_with_a_free_one(folder, home, words):
    (fault,) = told(folder, home=home)
    assert fault.code == "G027"
    assert words in fault.message
    assert fault.labels[0].span.line == 9
    assert fault.labels[1].span.line == 5
    place = re.search(r"to (\[.*\])", fault.help)[1]
    assert told(folder, home=place) == []


@pytest.mark.parametrize("home", ["[5.61, 0]", "[0, 0, 8]", "[0, 0, 8.01]", "[-5.7, -5.7]"])
def test_a_home_beside_a_wall_and_on_a_roof_is_one(folder, home):
    assert told(folder, home=home) == []


@pytest.mark.slow
def test_the_ground_of_a_scanned_scene_is_no_obstacle_to_a_home_on_it(tmp_path):
    random = np.random.default_rng(1)
    x, y = np.meshgrid(np.arange(-60, 61, 2.0), np.arange(-60, 61, 2.0), indexing="ij")
    z = random.uniform(-0.1, 0.1, x.shape)
    p = np.stack([x, y, z], axis=-1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    (tmp_path / "scan.ply").write_bytes(ply(faces))
    text = TEXT.replace("buildings: {file: houses.geojson}", "scene: {file: scan.ply, units: m}")
    assert told(tmp_path, text=text) == []


@pytest.mark.slow
def test_what_hangs_over_a_home_is_told(tmp_path):
    roof = quad((-3, -43, 2.5), (3, -43, 2.5), (3, -37, 2.5), (-3, -37, 2.5))
    (tmp_path / "shed.ply").write_bytes(ply(roof))
    text = TEXT.replace("buildings: {file: houses.geojson}", "scene: {file: shed.ply, units: m}")
    (fault,) = told(tmp_path, text=text)
    assert fault.code == "G027"
    assert "`shed` of the scene" in fault.message
    place = re.search(r"to (\[.*\])", fault.help)[1]
    assert told(tmp_path, home=place, text=text) == []


@pytest.mark.parametrize(
    ("at", "words", "number"),
    [
        ("[0, 0, 4]", "is inside of building `hut`", "4.00 m deep"),
        ("[0, 6.5, 4]", "is too close to building `hut`", "1.50 m away"),
        ("[0, 0, 10]", "is too close to building `hut`", "2.00 m away"),
    ],
)
def test_a_camera_is_told_with_a_free_place(folder, at, words, number):
    (fault,) = told(folder, f"kind: static, at: {at}, look_at: statue")
    assert fault.code == "G028"
    assert words in fault.message
    assert number in fault.notes[0]
    assert "obstacle clearance of 2.00 m and the body radius of 0.60 m" in fault.notes[0]
    assert fault.labels[0].span.line == 11
    place = re.search(r"to (\[.*\])", fault.help)[1]
    assert told(folder, f"kind: static, at: {place}, look_at: statue") == []


def test_each_keyframe_is_told_on_its_line(folder):
    shot = """kind: keyframes, target: statue, keyframes: [
      {at: [-9, 20, 9], look_at: statue},
      {at: [0, 7, 4], look_at: statue},
      {at: [9, 20, 9], look_at: statue}]"""
    (fault,) = told(folder, shot)
    assert (fault.code, fault.labels[0].span.line) == ("G028", 13)
    assert "the keyframe is too close to building `hut`" in fault.message


def test_a_path_that_leads_through_is_a_warning_and_one_within_an_error(folder):
    far = "kind: orbit, target: statue, radius: 55, altitude: 6"
    (warning,) = told(folder, far)
    assert warning.code == "G029"
    assert "to keep it, write `altitude: " in warning.help
    height = re.search(r"altitude: ([\d.]+)", warning.help)[1]
    assert told(folder, far.replace("altitude: 6", f"altitude: {height}")) == []
    (tmp := folder / "houses.geojson").write_bytes(
        geojson(feature(square(0, 60, 200), name="hall", building="yes", height=30))
    )
    assert tmp.exists()
    found = [d for d in told(folder, far, home="[0, -90]") if d.code == "G028"]
    assert len(found) == 1
    assert "the path of this orbit is inside of building `hall`" in found[0].message


def test_a_clearance_of_the_mission_counts(folder):
    near = "kind: static, at: [0, 6.5, 4], look_at: statue"
    assert [d.code for d in told(folder, near)] == ["G028"]
    assert told(folder, near, text=TEXT.replace("shots:", "rules: {obstacle_clearance: 0.5}\nshots:")) == []


def test_half_the_spacing_of_a_cloud_is_added(tmp_path):
    points = np.column_stack([np.arange(-20, 21, 2.0), np.zeros(21), np.full(21, 4.0)])
    (tmp_path / "wire.ply").write_bytes(ply(points))
    text = TEXT.replace("buildings: {file: houses.geojson}", "scene: {file: wire.ply, units: m}")
    (fault,) = told(tmp_path, "kind: static, at: [0, 3, 4], look_at: statue", text=text)
    assert "half the spacing of its points, 1.00 m" in fault.notes[0]
    assert told(tmp_path, "kind: static, at: [0, 3.7, 4], look_at: statue", text=text) == []


def test_the_camera_of_a_shot_of_what_moves_is_told(folder):
    text = TEXT.replace(
        "statue: {at: [0, 60], radius: 1, height: 4}",
        "statue: {track: {start: [-10, 40, 1], velocity: [1, 0, 0]}, radius: 0.5, height: 1.8}",
    )
    timing = "timing: {start: 20, duration: 10}"
    (fault,) = told(folder, f"kind: static, at: [0, 6.5, 4], look_at: statue, {timing}", text=text)
    assert fault.code == "G028"
    along = text.replace("start: [-10, 40, 1]", "start: [-30, 10, 1]")
    shot = f"kind: lateral, target: statue, side: right, distance: 6, altitude: 3, {timing}"
    assert "G029" in {d.code for d in told(folder, shot, text=along)}


def test_targets_may_stand_in_a_scene(tmp_path):
    (tmp_path / "house.ply").write_bytes(ply(house()))
    text = TEXT.replace(
        "buildings: {file: houses.geojson}", "scene: {file: house.ply, units: m, at: [0, 60, 0]}"
    )
    assert not [d for d in told(tmp_path, text=text) if d.code in ("G027", "G028", "G029")]
    assert resolved(text.replace("SHOT", CALM).replace("HOME", "[0, -40]"), tmp_path)[0] is not None
