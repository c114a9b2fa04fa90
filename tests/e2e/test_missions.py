"""Every mission of the tree, from text to files: what is said about it, what comes out, twice alike."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from shotc import api
from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.ir.source import TAKES
from tests.e2e.conftest import MISSIONS, Plan, each_mission
from tests.support import written_missions
from tests.support.compiled import freshly_compiled

EMITTERS = ("csv", "storyboard", "rerun")
SAID: dict[str, dict[str, list[tuple[str, int]]]] = {
    "courtyard": {"plan": [("V031", 22)], "emit": [("E101", 7)]},
    "keyframes": {"emit": [("E101", 1)]},
    "landmark": {},
    "moves": {"emit": [("E101", 1)]},
    "orbit": {"emit": [("E101", 1)]},
    "path": {"emit": [("E101", 1)]},
    "pisa-campanile": {"emit": [("E102", 13)]},
    "river-path": {},
    "rooftop-survey": {},
    "rotsee-sculler": {"emit": [("E118", 19), ("E118", 21), ("E118", 23)]},
    "runner": {"emit": [("E101", 1)]},
    "runner-three-cameras": {
        "plan": [("M008", 17), ("M008", 19), ("M008", 21)],
        "emit": [
            *(("E107", line) for line in (17, 19, 21)),
            *(("E145", line) for line in (12, 12, 13)),
        ],
    },
    "statue-moves": {"emit": [("E101", 1)]},
    "tower-fly-past": {"plan": [("V030", 19)]},
    "tower-reveal": {"emit": [("E105", 22)]},
    "westerhever-lighthouse": {},
}
"""Warnings of each mission with their lines: those of `check`, those that planning and emitting add."""
TWICE = ("keyframes", "path")
"""Small missions: `make test` emits these alone."""

every_mission = pytest.mark.parametrize("path", each_mission())


def test_the_missions_ask_for_all_that_is_looked_at_in_what_is_flown():
    shots = [shot for path in MISSIONS for shot in written_missions.read(path)["shots"]]
    asked = {key for shot in shots for part in ("timing", "require") for key in shot.get(part, {})}
    asked |= {key for shot in shots for keyframe in shot.get("keyframes", ()) for key in keyframe}
    assert asked >= {"duration", "start", "after", "hold", "time", "in_frame", "screen_error", "size"}


def said(diagnostics: tuple[Diagnostic, ...]) -> list[tuple[str, int]]:
    return [(d.code, d.labels[0].span.line) for d in diagnostics]


def test_every_mission_is_listed_here() -> None:
    assert [path.stem for path in sorted(MISSIONS, key=lambda path: path.stem)] == list(SAID)
    assert sum("specs" in path.parts for path in MISSIONS) >= 6


@every_mission
def test_check_says_what_is_expected(path: Path) -> None:
    report = check_source(path.read_bytes(), path.name, path.parent)
    assert said(report.diagnostics) == SAID[path.stem].get("check", [])


@pytest.mark.parametrize("path", each_mission(long=lambda path: path.stem not in TWICE))
def test_all_outputs_are_made(plan: Plan, path: Path) -> None:
    planned = plan(path)
    expected = SAID[path.stem]
    assert said(planned.diagnostics) == [*expected.get("check", []), *expected.get("plan", [])]
    flown = planned.mission.drones
    machine = TAKES[flown[0].autopilot][0]
    emitted = api.emit_plan(planned.plan, (*EMITTERS, machine))
    assert said(emitted.diagnostics) == expected.get("emit", [])
    files = {artifact.name: artifact.data for artifact in emitted.artifacts}
    flown = flown if planned.mission.origin else ()
    machines = {f"{d.name}.{'kmz' if machine == 'dji' else 'plan'}" for d in flown}
    machines |= {f"{d.name}.waypoints" for d in flown if d.autopilot == "ardupilot"}
    tables = {"plan.json", "trajectory.csv", "framing.csv"}
    assert set(files) == tables | machines | {"storyboard.png", "mission.rrd"}
    assert files["storyboard.png"].startswith(b"\x89PNG\r\n\x1a\n")
    assert files["mission.rrd"].startswith(b"RRF")
    for name in machines & {"cam1.plan"}:
        assert json.loads(files[name])["fileType"] == "Plan"
    assert all(len(data) > 60 for data in files.values())


@pytest.mark.slow
@pytest.mark.parametrize("path", [path for path in MISSIONS if path.stem in TWICE], ids=TWICE)
def test_the_same_mission_gives_the_same_bytes(plan: Plan, path: Path) -> None:
    again = freshly_compiled(path, "none").plan
    assert again is not None
    files = {a.name: a.data for a in api.emit_plan(again, ["csv"]).artifacts}
    assert files == plan(path).files
