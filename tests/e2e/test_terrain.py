"""Missions over terrain, planned whole: what is flown is held against the ground, computed anew."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

from shotc import api
from shotc.geom.bernstein import Array
from shotc.planfile.write import plan_bytes
from tests.support.terrain_missions import cliff, relief, under, write

pytestmark = pytest.mark.slow

TOWER = "  tower: {at: [120, 60, {above: ground, height: 10}], radius: 2, height: 20}"
ROUND = "kind: orbit, target: tower, radius: 35, sweep: 150 deg, altitude: {above: ground, height: 6}"


def planned(path, refiner=None):
    options = api.PlanOptions(refiner=refiner)
    return api.compile_source(path.read_bytes(), path.name, path.parent, options)


def flown(plan) -> Array:
    """All places of the first drone, a hundredth of a second apart."""
    curve = plan.trajectory.drones[0].curve
    return curve(np.arange(curve.start, curve.end, 0.01))[:, :3]


def phases(plan, *names: str) -> Array:
    track = plan.trajectory.drones[0]
    parts = [np.arange(p.start, p.end, 0.01) for p in track.phases if p.name in names]
    return track.curve(np.concatenate(parts))[:, :3]


@pytest.fixture(scope="module")
def hills(tmp_path_factory):
    shape = relief()
    path = write(tmp_path_factory.mktemp("hills"), shape, ROUND, TOWER, "max_height: 45")
    found = planned(path)
    assert found.plan is not None, found.diagnostics
    return shape, path, found.plan


def claim(plan, constraint):
    (found,) = [c for c in plan.certificate if c.constraint == constraint]
    return found


@pytest.mark.long
def test_heights_above_ground_are_proved_and_are_what_is_flown(hills):
    shape, _, plan = hills
    places = phases(plan, "transit", "shot", "hold")
    height = places[:, 2] - under(shape, places)
    low = claim(plan, "ground clearance")
    radius = plan.trajectory.keyframes.mission.drones[0].radius
    assert low.method == "bounded"
    assert low.worst <= (height - radius).min() + 1e-6
    assert low.worst >= (height - radius).min() - 0.01
    assert low.worst >= 2.0 - 1e-6
    high = claim(plan, "height above ground")
    whole = flown(plan)
    assert high.worst >= (whole[:, 2] - under(shape, whole)).max() - 1e-6
    assert high.worst <= 45.0 + 1e-5
    assert claim(plan, "distance from terrain").worst <= low.worst + 1e-6


def test_the_film_follows_the_ground(hills):
    shape, _, plan = hills
    filmed = phases(plan, "shot")
    height = filmed[:, 2] - under(shape, filmed)
    assert np.ptp(filmed[:, 2]) > 5.0
    assert height.min() > 3.0
    assert abs(np.median(height) - 6.0) < 1.5


def test_a_plan_is_verified_with_the_terrain_that_it_holds(hills, tmp_path):
    _, _, plan = hills
    text = plan_bytes(plan)
    verdict = api.verify_plan(text, "plan.json")
    assert verdict.plan is not None
    document = json.loads(text)
    (table,) = document["source"]["tables"]
    lines = table["text"]
    header, rows = lines[0], [line.rstrip("\n").split(",") for line in lines[1:] if line.strip()]
    lifted = [header] + [f"{x},{y},{float(z) + 20:g}\n" for x, y, z in rows]
    document["source"]["tables"][0]["text"] = lifted
    held = api.verify_plan(json.dumps(document).encode(), "plan.json")
    assert held.plan is None


def test_a_hill_hides_what_is_behind_it(tmp_path):
    target = "  hut: {at: [20, 0, 2], radius: 2, height: 4}"
    shot = "kind: static, look_at: hut, at: [160, 0, {above: ground, height: 8}], timing: {duration: 3}"
    path = write(tmp_path, cliff(height=60.0, at=34), shot, target)
    refused = planned(path, refiner="none")
    told = next(d for d in refused.diagnostics if d.code == "V050")
    assert refused.plan is None
    assert any("terrain `relief.csv` hides up to 100 % of it" in note for note in told.notes)
    path.write_text(path.read_text().replace("duration: 3}", "duration: 3}, allow: [hidden-subject]"))
    plan = planned(path, refiner="none").plan
    assert plan is not None
    (data,) = [a.data for a in api.emit_plan(plan, ["csv"]).artifacts if a.name == "framing.csv"]
    rows = list(csv.DictReader(io.StringIO(data.decode())))
    assert {(row["occluded"], row["covered"]) for row in rows} == {("1", "1")}


@pytest.mark.parametrize("height", [4.0, 40.0])
def test_a_drone_flies_up_a_cliff_and_keeps_from_its_wall(tmp_path, height):
    """The way from the pad to the film leads over a wall one cell wide."""
    shape = cliff(height)
    shot = "kind: static, heading: 90 deg, pitch: 0 deg, at: [120, 0, {above: ground, height: 8}]"
    plan = planned(
        write(tmp_path, shape, shot, "  post: {at: [200, 0, 45], radius: 1, height: 2}"), "none"
    ).plan
    assert plan is not None
    places = phases(plan, "transit", "shot", "hold")
    room = places[:, 2] - under(shape, places)
    assert room.min() >= 2.0
    assert claim(plan, "ground clearance").holds
    assert claim(plan, "distance from terrain").worst > 0.0


@pytest.mark.long
def test_the_mission_over_real_elevation_data_is_planned():
    path = Path(__file__).parents[2] / "specs" / "terrain" / "jacksboro-ridge.yaml"
    found = planned(path)
    assert found.plan is not None
    assert {d.code for d in found.diagnostics} == set()
    relief = found.plan.trajectory.keyframes.mission.terrain.ground.surface.triangles
    assert np.ptp(relief[..., 2]) > 200.0
    assert claim(found.plan, "ground clearance").holds
    assert claim(found.plan, "height above ground").worst < 100.0
    (run, tower) = (c.worst for c in found.plan.certificate if c.constraint.endswith(" in frame"))
    assert run == tower == 1.0
    assert api.verify_plan(plan_bytes(found.plan), "plan.json").plan is not None


def test_a_flight_beyond_the_terrain_is_refused(tmp_path):
    shot = "kind: static, heading: 90 deg, pitch: 0 deg, at: [310, 0, {above: ground, height: 8}]"
    path = write(tmp_path, relief(), shot, "  post: {at: [200, 0, 150], radius: 1, height: 2}")
    (told,) = planned(path, refiner="none").diagnostics
    assert told.code == "G025"
    assert told.notes == ("at [310.0, 0.0] it is 10.0 m beyond the ground of `relief.csv`",)
