"""Show files in Skybrush's own loader: the drones that it finds fly and shine as trajectory.csv says.

The loader, npm package @skybrush/show-format, is served by a registry of its publisher, and no part of this
tree. It runs from where SHOW_FORMAT_LOADER says, a module or the folder of the built package, or from
wherever node finds it. Without it these tests are skipped; ``tests/skyc_reader.py`` has the same rules.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.show.emit.skyc import EMITTER
from tests.e2e.conftest import ROOT
from tests.support import csv_tables, show_flights, skyc_reader
from tests.support.command import run
from tests.support.csv_tables import Table

pytestmark = pytest.mark.xdist_group("skybrush")

SCRIPT = Path(__file__).parents[1] / "support" / "skybrush_loader.mjs"
NOT_FOUND = 3
HOW = (
    "name its folder in SHOW_FORMAT_LOADER, or make it known to node by "
    "`npm install --@skybrush:registry=https://npm.collmot.com @skybrush/show-format`"
)
TWO_FLEETS = """\
shotc: 1
mission: two-fleets
world: {origin: {lat: 47.35, lon: 8.54, alt: 406}}
fleets:
  west: {count: 12, layout: {grid: {spacing: 4, origin: [-40, 0, 0]}}, model: show-drone}
  east: {count: 9, layout: {circle: {center: [40, 0, 0], radius: 12}}, model: show-drone}
shots:
  - {id: ball, kind: display, fleet: west, timing: {start: 50}, viewpoint: [0, -80, 2],
     frames: [{sphere: {center: [-40, 10, 40], radius: 8}, hold: 3, color: "#ff8000"},
              {cube: {center: [-40, 10, 40], size: 14}, hold: 3, color: blue}]}
  - {id: ring, kind: display, fleet: east, timing: {start: 60},
     frames: [{torus: {center: [40, 10, 40], radius: 12, tube: 2}, hold: 3, color: "#00c8ff"}]}
"""
MISSIONS = {
    "lakeside-show": (ROOT / "specs" / "lakeside-show.yaml").read_text(encoding="utf-8"),
    "two-fleets": TWO_FLEETS,
}


def loaded(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["node", str(SCRIPT), *arguments], capture_output=True, text=True, timeout=120, check=False
    )


@pytest.fixture(scope="module", autouse=True)
def loader() -> None:
    """Skip where there is no loader."""
    if shutil.which("node") is None:
        pytest.skip(f"node is not installed, which Skybrush's loader runs in; then {HOW}")
    tried = loaded()
    if tried.returncode == NOT_FOUND:
        pytest.skip(f"Skybrush's loader is not here ({tried.stderr.strip()}): {HOW}")
    assert tried.returncode == 0, tried.stderr


@pytest.fixture(scope="module", params=MISSIONS)
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a show that the command has planned, named as its mission is."""
    folder = tmp_path_factory.mktemp("show") / request.param
    folder.mkdir()
    (folder / "mission.yaml").write_text(MISSIONS[request.param], encoding="utf-8")
    shutil.copy(ROOT / "specs" / "heart.svg", folder)
    done = run("plan", "mission.yaml", "-o", "out", "--emit", "csv,skyc", folder=folder)
    assert (done.code, done.err) == (0, "")
    return folder


@pytest.mark.slow
def test_it_flies_and_shines_as_the_table_says(folder: Path) -> None:
    table = csv_tables.read((folder / "out" / "trajectory.csv").read_bytes())
    flights = {str(name): table.where(drone=name) for name in dict.fromkeys(table["drone"].tolist())}
    times = max((rows["t_s"] for rows in flights.values()), key=len)
    done = loaded(str(folder / "out" / f"{folder.name}.skyc"), json.dumps(times.tolist()))
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert sorted(found["names"]) == sorted(flights)
    played = np.array(found["played"])
    assert played.shape == (len(flights), len(times), 9)
    for name, flown in zip(found["names"], played, strict=True):
        rows = flights[name]
        assert rows["t_s"] == pytest.approx(times[: len(rows["t_s"])])
        same(rows, flown[: len(rows["t_s"])])
    about(folder, found)


def same(rows: Table, flown: Array) -> None:
    """Compare one drone's places, velocities and colours, (T, 9), with its rows of trajectory.csv."""
    for k, (ending, tolerance) in enumerate((("_m", 2e-3), ("_m_s", 2e-2))):
        east, north, up = (rows[f"{'v' * k}{axis}{ending}"] for axis in "xyz")
        off = np.linalg.norm(flown[:, 3 * k : 3 * k + 3] - np.stack([north, -east, up], axis=1), axis=1)
        assert off.max() < tolerance, ending
    shone = np.stack([rows[name] for name in ("red", "green", "blue")], axis=1)
    assert len(np.unique(shone, axis=0)) > 3
    assert np.abs(255.0 * flown[:, 6:] - shone).max() <= 2.0


def about(folder: Path, found: dict[str, Any]) -> None:
    """What is said of the show beside its drones is what the plan says."""
    document = json.loads((folder / "out" / "plan.json").read_bytes())
    assert found["environment"]["type"] == "outdoor"
    assert found["meta"]["title"] == folder.name
    displays = [display["id"] for display in document["mission"]["displays"]]
    assert found["cameras"] == [f"audience of {name}" for name in displays]
    phases = [phase for fleet in document["fleets"] for phase in fleet["phases"]]
    up = max(phase["end"] for phase in phases if phase["name"] == "takeoff")
    down = min(phase["start"] for phase in phases if phase["name"] == "land")
    end = max(fleet["breaks"][-1] for fleet in document["fleets"])
    assert found["meta"]["segments"] == {
        "takeoff": [0, pytest.approx(up, abs=1e-3)],
        "show": pytest.approx([up, down], abs=1e-3),
        "landing": pytest.approx([down, end], abs=1e-3),
    }
    starts = sorted(shown["start"] for fleet in document["fleets"] for shown in fleet["shown"])
    assert [cue["time"] for cue in found["settings"]["cues"]["items"]] == pytest.approx(starts, abs=1e-3)


def test_what_it_refuses(tmp_path: Path) -> None:
    """The damage that our reader names (``tests/unit/show/emit/test_skyc.py``), and it has no more rules."""
    (artifact,) = EMITTER.emit(show_flights.plan(show_flights.mission(4))).artifacts
    file = tmp_path / artifact.name
    file.write_bytes(artifact.data)
    content = skyc_reader.read(artifact.data)
    ways = {}
    for name in skyc_reader.DAMAGE:
        file.write_bytes(skyc_reader.archived(skyc_reader.damaged(content, name)))
        ways[name] = loaded(str(file), "[1.0, 30.0]").returncode
    assert ways == dict.fromkeys(skyc_reader.DAMAGE, 1)
