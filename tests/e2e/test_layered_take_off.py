"""Drones on pads 0.6 m apart that fly 1.5 m apart: planned, read back, written, judged, called off."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.command import run

MISSION = """\
shotc: 1
mission: dense-pads
world: {origin: {lat: 51.05, lon: 13.74, alt: 110}}
fleets:
  swarm:
    count: 64
    layout: {grid: {spacing: 0.6}}
    separation: {horizontal: 1.5 m, vertical: 2.5 m}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    frames: [{sphere: {center: [2, 6, 36], radius: 8}, hold: 2}]
"""

EMIT = ("--emit", "csv,skyc,zipped-csv")

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("layers")
    (folder / "m.yaml").write_text(MISSION)
    done = run("plan", "m.yaml", "-o", "out", *EMIT, folder=folder)
    assert done.code == 0, done.err
    assert "takes off in 8 layers, 10.0 to 27.5 m" in " ".join(done.out.split())
    return folder


def test_the_plan_holds_when_it_is_read_again(home: Path) -> None:
    done = run("verify", "out/plan.json", "--against", "m.yaml", "--abort-every", "12s", folder=home)
    assert done.code == 0, done.out + done.err
    assert "separation in the air" in done.out
    assert "separation on pads" in done.out
    assert "returns hold" in done.out


@pytest.mark.parametrize("name", ["trajectory.csv", "dense-pads.skyc", "dense-pads-csv.zip"])
def test_files_of_it_hold_too(home: Path, name: str) -> None:
    done = run("verify", f"out/{name}", "--against", "m.yaml", folder=home)
    assert done.code == 0, done.out + done.err
    assert "separation in the air" in done.out


def test_a_file_whose_drones_rise_at_once_breaks(home: Path, tmp_path: Path) -> None:
    rows = (home / "out" / "trajectory.csv").read_text().splitlines()
    names = rows[0].split(",")
    z, drone, time = names.index("z_m"), names.index("drone"), names.index("t_s")
    table = [row.split(",") for row in rows[1:]]
    first = {row[time]: row for row in table if row[drone] == "swarm-01"}
    end = float(max(first, key=float))
    for row in table:
        if row[drone] == "swarm-02" and float(row[time]) < 0.25 * end:
            row[z] = first[row[time]][z]
    (tmp_path / "trajectory.csv").write_text("\n".join([rows[0], *(",".join(row) for row in table)]) + "\n")
    done = run("verify", str(tmp_path / "trajectory.csv"), "--against", "m.yaml", folder=home)
    assert done.code == 1
    assert "V022" in done.err
    assert "separation in the air" in done.out


def test_it_is_rehearsed(home: Path) -> None:
    done = run("simulate", "out/plan.json", "--seeds", "1", "-o", "sim", folder=home)
    assert done.code == 0, done.out + done.err
    assert "come nearest while one stands on its pad, 0.6" in " ".join(done.out.split())
    assert json.loads((home / "sim" / "simulate.json").read_text())
