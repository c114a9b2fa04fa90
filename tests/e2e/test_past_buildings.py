"""A shot that cannot be flown past buildings says which, and what it says helps."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from tests.support.scene_missions import feature, geojson

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: past
world:
  origin: {lat: 46.68, lon: 7.68, alt: 500}
  buildings: {file: houses.geojson}
  zones:
    lane: {keep: in, polygon: {points: [[-120, -20], [120, -20], [120, 20], [-120, 20]], height: [0, TOP]}}
targets:
  runner: {track: {points: [[-100, ASIDE], [100, ASIDE]], speed: 3}, radius: 0.4, height: 1.8}
drones:
  cam: {model: x500, home: [-70, 0]}
rules: {obstacle_clearance: 2}
shots:
  - {id: side, drone: cam, target: runner, SHOT, altitude: 3, timing: {start: 24, duration: 15}}
"""
LATERAL = "kind: lateral, side: left, distance: 12"


def wall(low: float, high: float, name: str) -> dict:
    ring = [(-3.0, low), (3.0, low), (3.0, high), (-3.0, high)]
    return feature(ring, name=name, building="yes", height=30)


def planned(folder: Path, text: str, *walls: dict) -> Compilation:
    (folder / "houses.geojson").write_bytes(geojson(*walls))
    return compile_source(text.encode(), "m.yaml", folder, PlanOptions(refiner="none"))


@pytest.mark.long
def test_a_wall_across_the_way_is_named_and_the_height_that_is_told_leads_over_it(tmp_path: Path) -> None:
    text = MISSION.replace("TOP", "60").replace("ASIDE", "-19").replace("SHOT", LATERAL)
    done = planned(tmp_path, text, wall(-60, 60, "Long wall"))
    (told,) = (d for d in done.diagnostics if d.code == "M009")
    assert told.message == "shot `side` cannot be flown clear of building `Long wall`"
    assert re.fullmatch(r"at t = 3\d\.\d s its place is 5\.\d+ m too near to .*", told.notes[0])
    (lift,) = re.findall(r"raise its `altitude` by (\d+) m", told.help or "")
    higher = planned(
        tmp_path, text.replace("altitude: 3", f"altitude: {3 + int(lift)}"), wall(-60, 60, "Long wall")
    )
    assert higher.plan is not None, higher.diagnostics


@pytest.mark.long
def test_a_gap_that_is_too_narrow_tells_the_clearance_with_which_it_is_flown(tmp_path: Path) -> None:
    text = MISSION.replace("TOP", "20").replace("ASIDE", "0").replace("SHOT", "kind: lead, distance: 10")
    walls = wall(-60, -2.2, "South wall"), wall(2.2, 60, "North wall")
    done = planned(tmp_path, text, *walls)
    (told,) = (d for d in done.diagnostics if d.code == "M009")
    assert "th wall`" in told.message
    (clearance,) = re.findall(r"obstacle_clearance: ([\d.]+)", told.help or "")
    assert 1.0 <= float(clearance) < 1.6
    lower = planned(
        tmp_path, text.replace("obstacle_clearance: 2", f"obstacle_clearance: {clearance}"), *walls
    )
    assert lower.plan is not None, lower.diagnostics


@pytest.mark.long
def test_where_nothing_helps_no_number_is_told(tmp_path: Path) -> None:
    text = MISSION.replace("TOP", "20").replace("ASIDE", "-19").replace("SHOT", LATERAL)
    (told,) = (d for d in planned(tmp_path, text, wall(-60, 60, "Long wall")).diagnostics if d.code == "M009")
    assert (
        told.help
        == "no other altitude and no smaller clearance was found: film it from another side, or elsewhere"
    )
