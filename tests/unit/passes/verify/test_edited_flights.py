"""Flights of one mission in the plan of another, seal and certificate made anew: none of them is accepted."""

from __future__ import annotations

import json

import pytest

from shotc import api
from tests.support.compiled import compiled_text
from tests.support.few import few
from tests.support.resealed_plans import Document, resealed

pytestmark = [pytest.mark.slow, pytest.mark.long]

WORLD = """\
shotc: 1
mission: edited
targets:
  tower: {at: [0, 0, 10], radius: 3, height: 20}
  mast: {at: [40, 0, 10], radius: 1, height: 20}
  runner: {track: {start: [80, 0, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -60, 0], body: follow-camera}
rules: {mutual_visibility: {strength: off}, transit_clearance: {filmed: 0, other: 0}, allow: [fast-pan]}
shots:
"""
KEYED = """\
  - id: k
    kind: keyframes
    drone: cam1
    timing: {duration: 15}
    keyframes:
      - {at: {from: runner, offset: [-8, 0, 3], turn: course}, look_at: runner}
      - {at: {from: runner, offset: [0, -8, 3]}, look_at: runner, frame: left-third, hold: 2}
      - {at: [100, -20, 10], heading: 20 deg, pitch: -10 deg, hfov: 60 deg}
"""
STILL = "  - {id: s, kind: static, drone: cam1, at: [0, -40, 10], look_at: tower}\n"
AIMED = (
    "  - {id: a, kind: static, drone: cam1, target: runner, at: [80, -20, 6], heading: 0 deg, pitch: -5 deg,"
    " timing: {duration: 6}}\n"
)
TOWER = "  - {id: t, kind: static, drone: cam1, at: [-20, -40, 10], look_at: tower, timing: {duration: 2}}\n"
MAST = "  - {id: m, kind: static, drone: cam1, at: [30, -40, 10], look_at: mast, timing: {duration: 2}}\n"

FLIGHTS: dict[str, tuple[str, str, str, str, str]] = {
    "a heading beside what moves": (
        KEYED,
        "heading: 20 deg",
        "heading: 100 deg",
        "V045",
        "direction off",
    ),
    "a pitch beside what moves": (KEYED, "pitch: -10 deg", "pitch: -30 deg", "V045", "direction off"),
    "a lens beside what moves": (KEYED, "hfov: 60 deg", "hfov: 40 deg", "V045", "lens off its keyframes"),
    "a place on screen without a promise": (KEYED, "left-third", "right-third", "V024", "reference off its"),
    "an aim of a still camera": (AIMED, "heading: 0 deg", "heading: 40 deg", "V045", "direction off its aim"),
    "a longer still shot": (STILL, "tower}", "tower, timing: {duration: 30}}", "V015", "error of duration"),
    "a shorter still shot": (STILL, "tower}", "tower, timing: {duration: 1}}", "V015", "error of duration"),
    "another order of shots": (TOWER + MAST, TOWER + MAST, MAST + TOWER, "V015", "shots out of order"),
    "another body": (TOWER + MAST, "body: follow-camera", "body: free", "V045", "body off its camera"),
}
QUICK = ("an aim of a still camera", "another order of shots", "a longer still shot")


def plan_of(text: str) -> Document:
    done = compiled_text(text, refiner="none")
    assert done.plan is not None, done.diagnostics
    document: Document = json.loads(api.emit_plan(done.plan, []).artifacts[0].data)
    return document


@pytest.mark.parametrize("name", few(FLIGHTS, QUICK))
def test_a_flight_that_the_mission_does_not_ask_for_is_refused(name: str) -> None:
    shots, old, new, code, constraint = FLIGHTS[name]
    text = WORLD + shots
    assert old in text
    document, other = plan_of(text), plan_of(text.replace(old, new))
    assert api.verify_plan(resealed(document), "plan.json").plan is not None
    document.update(drones=other["drones"], deviations=other["deviations"])
    report = api.verify_plan(resealed(document), "plan.json")
    assert any(d.code == code and constraint in d.message for d in report.diagnostics)
    assert report.plan is None


@pytest.mark.parametrize("points", [1, 2, 5, 7])
def test_a_flight_of_another_degree_is_refused(points: int) -> None:
    """Curves of two degrees have no difference, which the separation of two drones needs."""
    document = plan_of(WORLD + STILL)
    curve = document["drones"][0]["curve"]
    curve["control"] = [(piece * 2)[:points] for piece in curve["control"]]
    report = api.verify_plan(json.dumps(document).encode(), "plan.json")
    assert report.plan is None
    assert [
        (d.code, f"has {points} control points a piece, not 6" in d.message) for d in report.diagnostics
    ] == [("E003", True)]
