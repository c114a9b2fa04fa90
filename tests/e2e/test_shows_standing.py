"""Shows over terrain and beside buildings through the command: planned, proved again, and refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from tests.support.command import run
from tests.support.scene_missions import feature, geojson, square
from tests.support.standing_worlds import from_box, height_over, ridge
from tests.support.terrain_missions import cliff, relief, table

pytestmark = pytest.mark.slow

CREST = 60.0
MISSION = """\
shotc: 1
mission: over
world: {WORLD}
fleets:
  swarm: {count: 24, layout: {grid: {spacing: 5, origin: ORIGIN}}, separation: 1.5}
shots:
  - id: lights
    kind: display
    fleet: swarm
    viewpoint: [0, -90, {above: ground, height: 2}]
    frames:
      - {sphere: {center: FIRST, radius: 9}, hold: 2}
      - {cube: {center: SECOND, size: 16}, hold: 2}
"""


def text(world: str, origin: str = "[-30, 0]", first: str = "", second: str = "") -> str:
    low = "[-20, 0, {above: ground, height: 30}]"
    far = "[140, 0, {above: ground, height: 30}]"
    words = {"{WORLD}": f"{{{world}}}", "ORIGIN": origin, "FIRST": first or low, "SECOND": second or far}
    made = MISSION
    for word, value in words.items():
        made = made.replace(word, value)
    return made


def flown(folder: Path) -> tuple[Array, Array]:
    """Return where all drones are at 3000 times, and the pads, of a plan in `out`."""
    plan = json.loads((folder / "out" / "plan.json").read_text())
    (flight,) = plan["fleets"]
    breaks, coef = np.array(flight["breaks"]), np.array(flight["coef"])
    spans = [(p["start"], p["end"]) for p in flight["phases"] if p["name"] not in {"takeoff", "land"}]
    times = np.linspace(spans[0][0], spans[-1][1], 3000)
    return places(breaks, coef, times), coef[:, 0]


@pytest.fixture(scope="module")
def hilly(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("hilly")
    (made / "ridge.csv").write_text(table(ridge(CREST)))
    (made / "over.yaml").write_text(text("terrain: {file: ridge.csv}"))
    done = run("plan", "over.yaml", "--emit", "csv,contact-sheet,site", "-o", "out", folder=made)
    assert done.code == 0, done.err
    return made


@pytest.mark.long
def test_the_fleet_stands_on_the_ground_and_rises_over_the_ridge(hilly: Path) -> None:
    at, pads = flown(hilly)
    shape = ridge(CREST)
    assert height_over(shape, pads) == pytest.approx(0.0, abs=1e-6)
    assert height_over(shape, at).min() >= 2.0 + 0.25 - 1e-6
    assert at[..., 2].max() > CREST + 2.0


@pytest.mark.long
def test_the_plan_is_proved_again_from_its_file_and_against_its_mission(hilly: Path) -> None:
    done = run("verify", "out/plan.json", "--against", "over.yaml", folder=hilly)
    assert done.code == 0, done.err
    (hilly / "flat.yaml").write_text(text("terrain: {file: ridge.csv}").replace("ridge.csv", "higher.csv"))
    (hilly / "higher.csv").write_text(table(ridge(CREST + 20.0)))
    other = run("verify", "out/plan.json", "--against", "flat.yaml", folder=hilly)
    assert other.code == 1
    assert "V043" in other.err
    assert "terrain is another" in other.err


@pytest.mark.long
def test_collective_returns_rise_over_the_ridge_too(hilly: Path) -> None:
    done = run("verify", "out/plan.json", "--abort-every", "20s", folder=hilly)
    assert done.code == 0, done.err + done.out


@pytest.mark.long
def test_pads_on_a_slope_stand_at_their_own_heights(tmp_path: Path) -> None:
    shape = relief(3, 25.0)
    (tmp_path / "relief.csv").write_text(table(shape))
    second = "[60, 20, {above: ground, height: 40}]"
    (tmp_path / "over.yaml").write_text(text("terrain: {file: relief.csv}", "[0, 0]", second=second))
    done = run("plan", "over.yaml", "--emit", "csv", "-o", "out", folder=tmp_path)
    assert done.code == 0, done.err
    at, pads = flown(tmp_path)
    assert np.ptp(pads[:, 2]) > 3.0
    assert height_over(shape, pads) == pytest.approx(0.0, abs=1e-6)
    assert height_over(shape, at).min() >= 2.25 - 1e-6


@pytest.mark.long
def test_beside_a_tower_the_fleet_keeps_the_obstacle_clearance(tmp_path: Path) -> None:
    tower = feature(square(60, 0, 30), "way/1", building="yes", height="50", name="Tower")
    (tmp_path / "houses.geojson").write_bytes(geojson(tower))
    world = "origin: {lat: 46.68, lon: 7.68, alt: 500}, buildings: {file: houses.geojson}"
    (tmp_path / "over.yaml").write_text(text(world))
    done = run("plan", "over.yaml", "--emit", "csv", "-o", "out", folder=tmp_path)
    assert done.code == 0, done.err
    at, _ = flown(tmp_path)
    assert from_box(at, (60.0, 0.0, 25.0), (30.0, 30.0, 50.0)).min() >= 2.25 - 0.01


BAD = {
    "under a hill": (text("terrain: {file: ridge.csv}", first="[60, 0, 40]"), "D014", "raise its centre by"),
    "in a hill on its side": (text("terrain: {file: ridge.csv}", first="[52, 0, 62]"), "D058", "shift it by"),
    "pads under ground": (
        text("terrain: {file: ridge.csv}", origin="[50, 0, 0]"),
        "D006",
        "leave its height out",
    ),
    "terrain that ends beside the pads": (
        text("terrain: {file: ridge.csv}", origin="[290, 0]"),
        "G025",
        "elevation model",
    ),
    "a picture beyond the terrain": (
        text("terrain: {file: ridge.csv}", second="[400, 0, 90]"),
        "G025",
        "elevation model",
    ),
    "an audience beyond the terrain": (
        text("terrain: {file: ridge.csv}").replace("[0, -90,", "[0, -900,"),
        "G046",
        "elevation model",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_a_diagnostic_with_a_way_out(name: str, tmp_path: Path) -> None:
    written, code, words = BAD[name]
    (tmp_path / "ridge.csv").write_text(table(ridge(CREST)))
    (tmp_path / "over.yaml").write_text(written)
    done = run("plan", "over.yaml", "-o", "out", folder=tmp_path)
    assert done.code == 1
    assert f"[{code}]" in done.err
    assert words in done.err
    assert "Traceback" not in done.err


@pytest.mark.long
def test_a_fleet_on_either_side_of_a_cliff_is_planned_clear_of_it(tmp_path: Path) -> None:
    shape = cliff(12.0, 32)  # the plain ends at x = 10 m, the plateau begins at x = 20 m
    (tmp_path / "cliff.csv").write_text(table(shape))
    made = text("terrain: {file: cliff.csv}", "[0, 0]", "[-20, 0, 60]", "[80, 0, 60]")
    (tmp_path / "over.yaml").write_text(made)
    done = run("plan", "over.yaml", "--emit", "csv", "-o", "out", folder=tmp_path)
    assert done.code == 0, done.err
    at, pads = flown(tmp_path)
    assert np.ptp(pads[:, 2]) == pytest.approx(12.0)
    assert height_over(shape, at).min() >= 2.25 - 1e-6
