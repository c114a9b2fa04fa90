"""The base install without numpy: it says what of a world it does not judge, and judges the rest."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.command import run
from tests.support.meshes import ply
from tests.support.scene_missions import feature, geojson, house, square, text

SURROUNDINGS = str(Path(__file__).parents[1] / "support" / "surroundings")
HEAVY = "numpy,scipy,cvxpy,clarabel,toppra,matplotlib,pymap3d,laspy,lazrs,rerun"
BARE = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": HEAVY}
WORLDS = {
    "terrain": "terrain: {file: hill.csv}",
    "scene": "scene: {file: house.ply, units: m, at: [-40, 20]}",
    "buildings": "buildings: {file: houses.geojson}",
}

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("command")]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "hill.csv").write_text("x,y,z\n0,0,90\n")  # no elevation model, which nobody can tell here
    (tmp_path / "house.ply").write_bytes(ply(house()))
    hut = feature(square(-40, 60, 10), name="hut", building="yes", height=4)
    (tmp_path / "houses.geojson").write_bytes(geojson(hut))
    for name, world in WORLDS.items():
        (tmp_path / f"{name}.yaml").write_text(text(world))
    return tmp_path


@pytest.mark.long
@pytest.mark.parametrize("name", WORLDS)
def test_what_cannot_be_judged_is_listed_and_no_fault(place: Path, name: str) -> None:
    done = run("check", f"{name}.yaml", folder=place, env=BARE)
    assert done.code == 0
    assert done.out.count("N013") == 1
    assert "Traceback" not in done.err


def test_the_rest_is_judged_beside_a_scene(place: Path) -> None:
    low = text(WORLDS["scene"]).replace("{above: ground, height: 6}", "0.5")
    (place / "low.yaml").write_text(low)
    done = run("check", "low.yaml", folder=place, env=BARE)
    assert done.code == 1
    assert "G001" in done.out
    assert "N013" in done.out


@pytest.mark.long
def test_bad_files_are_told_as_far_as_they_can_be(place: Path) -> None:
    (place / "houses.geojson").write_bytes(geojson(feature(square(0, 0, 10), building="yes")))
    done = run("check", "buildings.yaml", folder=place, env=BARE)
    assert done.code == 1
    assert "G035" in done.out
    (place / "house.ply").unlink()
    assert "N008" in run("check", "scene.yaml", folder=place, env=BARE).out


@pytest.mark.long
@pytest.mark.parametrize("name", WORLDS)
def test_nothing_is_planned(place: Path, name: str) -> None:
    done = run("plan", f"{name}.yaml", folder=place, env=BARE)
    assert done.code == 1
    assert "P004" in done.err
    assert not (place / "out").exists()


@pytest.mark.long
@pytest.mark.parametrize("name", ["scene", "buildings"])
def test_check_of_what_stands_there_loads_numpy_and_nothing_larger(place: Path, name: str) -> None:
    code = (
        "import sys; from shotc.cli.app import run\n"
        f"code = run(['check', {str(place / f'{name}.yaml')!r}])\n"
        "large = {'scipy', 'trimesh', 'matplotlib', 'PIL', 'pymap3d', 'cvxpy', 'numpy'}\n"
        "print(code, sorted(large & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0 ['numpy']\n"
