"""Waves and easings through the command: planned, told, proved again from the plan, and refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.fleet_spline import places
from tests.support.command import run

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: sweep
world: {origin: {lat: 47.0, lon: 8.0, alt: 400}}
music: {tempo: 120, start: 20 s}
fleets:
  swarm:
    count: 24
    layout: {grid: {spacing: 5, origin: [-10, 0, 0]}}
    separation: {horizontal: 1.5, vertical: 3}
shots:
  - id: dance
    kind: display
    fleet: swarm
    viewpoint: [0, -80, 2]
    frames:
      - {cube: {center: [0, 0, 40], size: 16}, hold: 2}
      - {sphere: {center: [4, 0, 44], radius: 10}, hold: 2, at: {beat: 61},
         transition: {wave: 3 s, easing: ease-out}}
      - {cube: {center: [0, 0, 40], size: 16}, hold: 2,
         transition: {duration: 20 s, wave: {time: 4 s, along: up, by: start}}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("waves")
    (made / "sweep.yaml").write_text(MISSION)
    done = run("plan", "sweep.yaml", "--emit", "csv", "-o", "out", folder=made)
    assert done.code == 0, done.err
    return made


@pytest.mark.long
def test_the_plan_sweeps_from_the_left_and_from_below_and_meets_its_beat(folder: Path) -> None:
    plan = json.loads((folder / "out" / "plan.json").read_text())
    flight = plan["fleets"][0]
    breaks, coef, shown = np.array(flight["breaks"]), np.array(flight["coef"]), flight["shown"]
    assert shown[1]["start"] == pytest.approx(20.0 + 60 * 0.5, abs=1e-6)  # beat 61 of 120 a minute
    assert shown[2]["start"] - shown[1]["end"] == pytest.approx(20.0, abs=1e-6)
    for one, other, axis, by in ((0, 1, 0, "goal"), (1, 2, 2, "start")):
        begin, end = shown[one]["end"], shown[other]["start"]
        at = places(breaks, coef, np.linspace(begin, end, 2001))
        gone = np.linalg.norm(at - at[:, :1], axis=2)
        half = (gone > 0.5 * gone[:, -1:]).argmax(axis=1) * (end - begin) / 2000
        order = at[:, -1 if by == "goal" else 0, axis]
        assert np.corrcoef(order, half)[0, 1] > 0.99
        wave = plan["mission"]["displays"][0]["pictures"][other]["wave"]
        assert np.ptp(half) == pytest.approx(wave["time"], abs=0.1)


@pytest.mark.long
def test_verify_proves_it_again_and_refuses_another_wave(folder: Path) -> None:
    done = run("verify", "out/plan.json", folder=folder)
    assert done.code == 0, done.err
    assert "error of wave" in done.out
    assert "the plan holds" in done.out
    plan = json.loads((folder / "out" / "plan.json").read_text())
    plan["mission"]["displays"][0]["pictures"][1]["wave"]["time"] = 6.0
    (folder / "other.json").write_text(json.dumps(plan))
    refused = run("verify", "other.json", folder=folder)
    assert refused.code == 1
    assert "wave" in refused.err
    plan["mission"]["displays"][0]["pictures"][1]["wave"]["time"] = -1.0
    (folder / "other.json").write_text(json.dumps(plan))
    assert "wave.time" in run("verify", "other.json", folder=folder).err


@pytest.mark.long
def test_a_wave_that_brings_drones_too_near_says_which_would_not(folder: Path) -> None:
    (folder / "long.yaml").write_text(
        MISSION.replace("wave: 3 s", "wave: 20 s").replace("at: {beat: 61},", "")
    )
    done = run("plan", "long.yaml", "-o", "long", folder=folder)
    assert done.code == 1
    assert "error[D141]" in done.err
    longest = float(done.err.split("write `wave: ")[1].split(" s")[0])
    assert 3.0 < longest < 20.0
    assert not (folder / "long").exists()


@pytest.mark.long
def test_check_refuses_waves_on_arcs_and_in_no_time(folder: Path) -> None:
    (folder / "arc.yaml").write_text(
        MISSION.replace("wave: 3 s", "path: arc, wave: 3 s").replace("duration: 20 s", "duration: 3 s")
    )
    done = run("check", "arc.yaml", "--format", "concise", folder=folder)
    assert done.code == 1
    assert "D140" in done.err + done.out
    (folder / "short.yaml").write_text(MISSION.replace("duration: 20 s", "duration: 3 s"))
    done = run("check", "short.yaml", "--format", "concise", folder=folder)
    assert "D019" in done.err + done.out
    assert "not all drones get from this sphere to the cube in 3.0 s" in done.err + done.out
