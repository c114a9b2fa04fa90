"""Cameras that film a show over terrain and beside buildings, through the command, and what burns there."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.fleet_spline import places
from tests.support.command import run
from tests.support.scene_missions import feature, geojson, square
from tests.support.standing_worlds import from_box, height_over, ridge
from tests.support.terrain_missions import table

pytestmark = pytest.mark.long

CREST = 60.0
TOWER = (60.0, 0.0, 25.0), (30.0, 30.0, 50.0)
MISSION = """\
shotc: 1
mission: filmed
world: {origin: {lat: 46.68, lon: 7.68, alt: 500}, WORLD}
drones:
  cam: {model: x500, home: [-30, -60, {above: ground, height: 0}], camera: {hfov: 74 deg, aspect: "16:9"}}
fleets:
  swarm: {count: 12, layout: {grid: {spacing: 5, origin: [-30, 0]}}, separation: 1.5}
shots:
  - id: lights
    kind: display
    fleet: swarm
    viewpoint: [0, -90, {above: ground, height: 2}]
    pyro:
      - {at: 42 s, drones: [2], product: fountain, duration: 5, prefire: 0.5, clear: CLEAR}
    frames:
      - {sphere: {center: [-20, 0, {above: ground, height: 30}], radius: 9}, name: globe, at: 40 s, hold: 14}
      - {cube: {center: [140, 0, {above: ground, height: 30}], size: 16}, hold: 2}
  - id: turn
    kind: orbit
    drone: cam
    target: globe
    radius: 36
    altitude: {above: ground, height: 25}
    start_azimuth: 180 deg
    sweep: 50 deg
    timing: {duration: 12}
    require: {in_frame: 100 %}
"""
WORLDS = {"terrain": "terrain: {file: ridge.csv}", "buildings": "buildings: {file: houses.geojson}"}
BURNS = 41.5, 47.0


def written(folder: Path, world: str, clear: float) -> Path:
    (folder / "ridge.csv").write_text(table(ridge(CREST)))
    tower = feature(square(60, 0, 30), "way/1", building="yes", height="50", name="Tower")
    (folder / "houses.geojson").write_bytes(geojson(tower))
    path = folder / "filmed.yaml"
    path.write_text(MISSION.replace("WORLD", WORLDS[world]).replace("CLEAR", f"{clear:g}"))
    return path


@pytest.mark.parametrize("world", WORLDS)
def test_a_show_is_filmed_and_proved_again(world: str, tmp_path: Path) -> None:
    written(tmp_path, world, 3.0)
    done = run("plan", "filmed.yaml", "--emit", "csv,storyboard,contact-sheet", "-o", "out", folder=tmp_path)
    assert done.code == 0, done.err
    again = run("verify", "out/plan.json", "--against", "filmed.yaml", folder=tmp_path)
    assert again.code == 0, again.err
    plan = json.loads((tmp_path / "out" / "plan.json").read_text())
    (fleet,) = plan["fleets"]
    burning = places(np.array(fleet["breaks"]), np.array(fleet["coef"])[1:2], np.linspace(*BURNS, 2000))[0]
    claims = {c["constraint"]: c for c in plan["certificate"]}
    ground = claims["pyro 1 fountain from the ground"]["worst"]
    if world == "terrain":
        assert ground <= height_over(ridge(CREST), burning).min() + 1e-9
    else:
        assert ground == pytest.approx(burning[:, 2].min(), abs=0.05)
        near = from_box(burning, *TOWER).min()
        assert claims["pyro 1 fountain from the buildings"]["worst"] == pytest.approx(near, abs=0.05)


@pytest.mark.parametrize(
    ("world", "clear", "what"), [("terrain", 34.0, "ground"), ("buildings", 70.0, "buildings")]
)
def test_what_burns_too_near_is_refused(world: str, clear: float, what: str, tmp_path: Path) -> None:
    written(tmp_path, world, clear)
    done = run("plan", "filmed.yaml", "-o", "out", folder=tmp_path)
    assert done.code == 1
    assert f"[V059]: swarm-02 of swarm: pyro 1 fountain from the {what} of shot `lights` is" in done.err
    assert ("nearest is building `Tower`" in done.err) == (what == "buildings")
