"""Missions drawn by seed: each is planned, and every shot shows all of its subjects that geometry allows."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from tests.support.few import few
from tests.support.generated.judge import judge, write
from tests.support.generated.missions import Mission, mission

pytestmark = pytest.mark.slow

QUICK = (60005, 60162, 60018, 60079, 60197, 60210, 60058, 60098, 60023)
"""Missions of ``make test`` of one drone each; ``tests/golden`` plans 23 more there."""

FEW = (1, 12, 18, 33, 41)
"""Small missions of ``make test-all``, at most two drones with a shot each."""

MANY = range(300)
"""Missions of ``make fuzz``."""

KINDS = {
    *("keyframes", "static", "orbit", "spiral", "elevator", "dolly", "crane", "top-down", "follow-path"),
    *("chase", "lead", "lateral", "flyby", "framing"),
}


def small(seed: int) -> Mission:
    return mission(seed, most_drones=2, most_takes=1)


@pytest.mark.parametrize("seed", QUICK)
def test_a_mission_of_one_drone_is_planned_and_shows_its_subjects_whole(seed: int) -> None:
    assert_planned_and_whole(mission(seed))


@pytest.mark.long
@pytest.mark.parametrize("seed", [60053, 60071])
def test_what_was_refused_is_planned(seed: int) -> None:
    """A free body was led astray by its fit (R009), and a drone that had to wait was given up (T003)."""
    assert_planned_and_whole(mission(seed))


@pytest.mark.long
@pytest.mark.parametrize("seed", few(FEW, (1, 12, 41)))
def test_a_small_mission_is_planned_and_shows_its_subjects_whole(seed: int) -> None:
    assert_planned_and_whole(small(seed))


@pytest.mark.long
def test_run_ups_of_four_drones_begin_farther_off_where_they_lack_their_separation() -> None:
    """Led aside, that of a second drone passed the first at 2.3 m of 3, and a refiner gave up (R011)."""
    assert not judge(mission(52070), "none").errors


@pytest.mark.fuzz
@pytest.mark.parametrize("seed", MANY)
def test_a_mission_is_planned_and_shows_its_subjects_whole(seed: int) -> None:
    assert_planned_and_whole(mission(seed))


def assert_planned_and_whole(asked: Mission) -> None:
    verdict = judge(asked)
    assert not verdict.errors
    assert not [shot for shot in verdict.shots if shot.falls_short]
    assert {shot.id for shot in verdict.shots} == {take.id for take in asked.takes}


@pytest.mark.fuzz
def test_every_kind_theme_and_number_of_drones_is_drawn_often() -> None:
    drawn = [mission(seed) for seed in MANY]
    kinds = Counter(str(take.wanted["kind"]) for m in drawn for take in m.takes)
    assert set(kinds) == KINDS
    assert min(kinds.values()) >= 5
    assert min(Counter(m.theme for m in drawn).values()) >= 5
    assert sum("from: " in m.text for m in drawn) >= 5
    assert sum("drone: auto" in m.text for m in drawn) >= 5
    assert sum("after: " in m.text for m in drawn) >= 5
    drones = Counter(len(m.cameras) for m in drawn)
    assert set(drones) == {1, 2, 3, 4}
    assert sum(drones[n] for n in (2, 3, 4)) >= 90
    lenses = [c.hfov for m in drawn for c in m.cameras]
    assert min(lenses) < 0.35
    assert max(lenses) > 1.75
    assert sum("zones:" in m.text for m in drawn) >= 60


@pytest.mark.long
def test_a_seed_means_the_same_mission_in_every_process(tmp_path: Path) -> None:
    dumped = ("--seeds", "3:6", "--dump", str(tmp_path / "other"))
    command = [sys.executable, "-m", "tests.support.generated", *dumped]
    root = Path(__file__).parents[2]
    subprocess.run(command, check=True, cwd=root, env={"PYTHONHASHSEED": "7"}, capture_output=True)
    for seed in range(3, 6):
        (tmp_path / f"{seed}").mkdir()
        write(mission(seed), tmp_path / f"{seed}")
        files = {p.name: p.read_bytes() for p in (tmp_path / f"{seed}").iterdir()}
        assert files == {p.name: p.read_bytes() for p in (tmp_path / "other" / f"seed-{seed}").iterdir()}


def test_a_shot_that_falls_short_is_told() -> None:
    """The judge looks: with a longer lens the shots are cropped, or the mission is refused."""
    asked = mission(3)
    longer = asked._replace(text=asked.text.replace("hfov: 42 deg", "hfov: 4 deg"))
    assert longer.text != asked.text
    verdict = judge(longer)
    assert verdict.errors or any(shot.falls_short for shot in verdict.shots)
    assert has_errors(check_source(longer.text.encode(), "m.yaml", None).diagnostics) <= bool(verdict.errors)
