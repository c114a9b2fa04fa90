"""The second opinion on every mission of the tree and on missions that are drawn: nothing is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from tests.support.few import few
from tests.support.films_in_a_row import SKIER, THIRD
from tests.support.generated.missions import mission
from tests.support.second_opinion.case import Case
from tests.support.second_opinion.compiled import case_of
from tests.support.second_opinion.judge import judge
from tests.support.second_opinion.reflight import reflights

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
FUZZ = {False: (), True: (pytest.mark.fuzz,)}
LONG = ("courtyard", "pisa-campanile", "rooftop-survey", "westerhever-lighthouse")
"""Missions that take minutes to fly: `make fuzz` judges them."""
FILMED = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.xdist_group(path.stem), *FUZZ[path.stem in LONG]])
    for path in sorted(ROOT.glob("specs/*.yaml"))
    if "fleets" not in yaml.safe_load(path.read_text(encoding="utf-8"))
]
FEW = (1, 7, 12, 330)  # quick ones, of one drone to three; the last one looks through a long lens from near
MANY = range(300, 400)


@pytest.mark.long
@pytest.mark.parametrize("path", FILMED)
def test_a_mission_of_the_tree_flies_as_it_says(path: Path) -> None:
    assert judge(case_of(path, "none")) == []


@pytest.mark.long
def test_the_refined_flight_is_as_it_says() -> None:
    assert judge(case_of(ROOT / "specs/tower-fly-past.yaml")) == []


@pytest.mark.long
@pytest.mark.parametrize("name", few(["tower-fly-past", "runner-three-cameras"], ["tower-fly-past"]))
def test_the_files_of_an_ardupilot_fly_as_they_say(name: str) -> None:
    case = case_of(ROOT / f"specs/{name}.yaml", "none", "ardupilot")
    assert "cam1.waypoints" in case.files
    assert list(reflights(case)) == []


@pytest.mark.parametrize("seed", FEW)
def test_a_drawn_mission_flies_as_it_says(seed: int, tmp_path: Path) -> None:
    assert judge(drawn(seed, tmp_path, "none")) == []


@pytest.mark.fuzz
@pytest.mark.parametrize("seed", MANY)
def test_many_drawn_missions_fly_as_they_say(seed: int, tmp_path: Path) -> None:
    assert judge(drawn(seed, tmp_path)) == []


WINDY = """\
shotc: 1
mission: windy
world: {wind: {speed: 4 m/s, from: 250 deg}}
targets: {runner: {track: {points: [[0, 0, 0.9], [190, 60, 0.9]], speed: 6 m/s}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [-10, -10, 0], limits: {tilt: 16 deg, thrust_to_weight: 1.25}}}
shots:
  - {id: after, kind: chase, drone: cam, target: runner, distance: 8, altitude: 4,
     timing: {start: 22, duration: 3}}
  - {id: back, kind: static, drone: cam, at: [120, 0, 8], look_at: [0, 20, 5], timing: {duration: 2}}
"""


def test_a_flight_in_wind_leans_and_flies_as_it_says(tmp_path: Path) -> None:
    (tmp_path / "mission.yaml").write_text(WINDY, encoding="utf-8")
    case = case_of(tmp_path / "mission.yaml", "none")
    assert judge(case) == []
    claimed = {claim["constraint"]: claim for claim in case.plan["certificate"]}
    assert claimed.keys() >= {"airspeed", "tilt", "thrust to weight"}
    assert "speed" not in claimed


def drawn(seed: int, folder: Path, refiner: str | None = None) -> Case:
    asked = mission(seed)
    for name, data in asked.files.items():
        (folder / name).write_bytes(data)
    (folder / "mission.yaml").write_text(asked.text, encoding="utf-8")
    return case_of(folder / "mission.yaml", refiner)


@pytest.mark.long
@pytest.mark.parametrize("refiner", few(["none", "ours"], ["none"]))
def test_a_flight_from_film_to_film_without_a_stop_is_as_it_says(refiner: str, tmp_path: Path) -> None:
    (tmp_path / "mission.yaml").write_text(SKIER + THIRD, encoding="utf-8")
    assert judge(case_of(tmp_path / "mission.yaml", refiner)) == []
