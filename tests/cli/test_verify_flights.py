"""verify of files of flights: what is printed where, and the exit status."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.support.flight_files import ACROSS, AROUND, MISSION, kmz, mark, waypoints_file, wpml_text


@pytest.fixture
def mission(tmp_path: Path) -> str:
    path = tmp_path / "yard.yaml"
    path.write_text(MISSION)
    return str(path)


def written(folder: Path, name: str, data: bytes) -> str:
    (folder / name).write_bytes(data)
    return str(folder / name)


def test_a_flight_that_holds(run: Run, tmp_path: Path, mission: str) -> None:
    file = written(tmp_path, "cam1.kmz", kmz(wpml_text([mark(place) for place in AROUND])))
    done = run("verify", file, "--against", mission)
    assert done.code == 0
    assert "zone hut" in done.out
    assert "not judged" in done.out
    assert done.out.rstrip().endswith("requirements proved")


def test_a_flight_that_does_not(run: Run, tmp_path: Path, mission: str) -> None:
    file = written(tmp_path, "cam1.waypoints", waypoints_file(ACROSS))
    done = run("verify", file, "--against", mission)
    assert done.code == 1
    assert "BROKEN" in done.out
    assert "error[V007]" in done.err
    assert "cam1.waypoints:" in done.err
    assert "yard.yaml:6:5" in done.err


def test_json_says_it_all(run: Run, tmp_path: Path, mission: str) -> None:
    file = written(tmp_path, "flight.waypoints", waypoints_file(ACROSS))
    done = run("verify", file, "--against", mission, "--format", "json", "--drone", "cam1")
    found = json.loads(done.out)
    assert (done.code, found["holds"]) == (1, False)
    assert {d["code"] for d in found["diagnostics"]} == {"V007"}
    assert any("not judged" in note for note in found["notes"])
    assert any(not claim["holds"] for claim in found["certificate"])


def test_what_is_missing_is_named(run: Run, tmp_path: Path, mission: str) -> None:
    file = written(tmp_path, "cam1.waypoints", waypoints_file(AROUND))
    alone = run("verify", file)
    assert (alone.code, "--against" in alone.err) == (2, True)
    mixed = run("verify", file, mission, "--against", mission)
    assert (mixed.code, "no file of a flight" in mixed.err) == (2, True)
    several = run("verify", mission, mission)
    assert (several.code, "are for flights" in several.err) == (2, True)
    absent = run("verify", "cam1.kmz", "--against", mission)
    assert (absent.code, "cannot be read" in absent.err) == (1, True)
