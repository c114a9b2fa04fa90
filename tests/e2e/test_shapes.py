"""Boxes, boxes that turn and groups as targets, from text to files: planned, proved, judged by other eyes."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc import api
from shotc.checking import check_source
from shotc.planfile.write import plan_bytes
from tests.support.compiled import compiled
from tests.support.second_opinion.case import Case
from tests.support.second_opinion.compiled import case_of
from tests.support.second_opinion.judge import findings, judge
from tests.support.second_opinion.mission import Mission

VAN = Path(__file__).parents[2] / "specs" / "shapes" / "delivery-van.yaml"
BEND = "{points: [[-60, 0], [0, 0], [14, 4], [24, 14], [28, 28], [28, 90]], speed: 4 m/s}"
HEAD = f"""\
shotc: 1
mission: shapes
targets:
  car: {{track: {BEND}, size: [4.5, 1.8, 1.5]}}
  house: {{at: [20, -20], size: [10, 8, 8], heading: 20 deg}}
  mast: {{at: [26, -24], radius: 0.5, height: 14}}
  home: {{parts: [house, mast]}}
drones: {{cam1: {{model: x500, home: [-40, -30, 0]}}}}
rules: {{composition: center, allow: [jump-cut, fast-pan]}}
shots:
"""
SHOTS = {
    "beside each other": """\
  - id: both
    kind: framing
    drone: cam1
    timing: {start: 14, duration: 8}
    subjects: [{target: car, frame: [-0.3, -0.1], size: 0.15}, {target: home, frame: [0.3, 0.1]}]
""",
    "keyframes of what moves": """\
  - id: led
    kind: keyframes
    drone: cam1
    target: car
    timing: {start: 14}
    keyframes:
      - {at: {from: car, offset: [-12, 0, 5]}, look_at: car}
      - {at: {from: car, offset: [-8, -8, 4]}, look_at: car, time: 6}
""",
    "handed over": """\
  - id: over
    kind: keyframes
    drone: cam1
    target: home
    keyframes:
      - {at: [-30, -40, 10], look_at: home}
      - {at: [-10, -50, 12], look_at: house}
      - {at: [30, -60, 10], look_at: mast}
""",
}

pytestmark = pytest.mark.slow


@pytest.mark.long
@pytest.mark.parametrize("name", SHOTS)
def test_other_eyes_see_what_is_planned(name: str, tmp_path: Path) -> None:
    path = tmp_path / "shapes.yaml"
    path.write_text(HEAD + SHOTS[name], encoding="utf-8")
    assert judge(case_of(path)) == []


@pytest.mark.long
def test_the_van_before_the_church_is_in_frame_at_every_instant() -> None:
    assert judge(case_of(VAN)) == []
    plan = compiled(VAN).plan
    assert plan is not None
    assert api.verify_plan(plan_bytes(plan), "plan.json").plan is not None
    (van,) = (c for c in plan.certificate if c.constraint == "van in frame")
    assert (van.worst, van.method) == (1.0, "bounded")
    data = next(a.data for a in api.emit_plan(plan, ["csv"]).artifacts if a.name == "framing.csv")
    assert b",follow,van," in data
    assert b",church,church," in data


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("size: [5.9, 2.0, 2.7]", "size: [6.5, 2.0, 2.7]", "column size"),
        ("size: [7, 7, 32]", "size: [7, 7, 36]", "column size"),
        ("size: [21, 12, 14], heading: 90 deg", "size: [21, 12, 14], heading: 60 deg", "column u"),
        ("size: [7, 7, 32]", "size: [7, 7, 30]", "column v"),
    ],
)
def test_other_eyes_see_another_shape(old: str, new: str, rule: str) -> None:
    case = case_of(VAN)
    assert case.mission.text.count(old) == 1
    asked = Case(Mission(case.mission.text.replace(old, new), case.mission.read), case.files, case.notes)
    assert any(finding.rule == rule for finding in findings(asked))


@pytest.mark.long
def test_pictures_and_recording_show_them() -> None:
    plan = compiled(VAN).plan
    assert plan is not None
    names = {a.name: len(a.data) for a in api.emit_plan(plan, ["storyboard", "rerun"]).artifacts}
    assert names["storyboard.png"] > 50_000
    assert names["mission.rrd"] > 50_000


def test_a_drone_passes_a_long_house_nearer_than_its_corners_reach(tmp_path: Path) -> None:
    path = tmp_path / "terrace.yaml"
    text = HEAD.replace("size: [10, 8, 8], heading: 20 deg", "size: [60, 8, 8], heading: 90 deg")
    text = text.replace("[26, -24], radius: 0.5, height: 14", "[120, 0], radius: 0.5, height: 14")
    shot = (
        "  - {id: by, kind: follow-path, drone: cam1, points: [[5, -10, 4], [35, -10, 4]], heading: along}\n"
    )
    path.write_text(text + shot, encoding="utf-8")
    assert not check_source(path.read_bytes(), "terrace.yaml", None).diagnostics
    plan = compiled(path, "none").plan
    assert plan is not None
    (wall,) = (c for c in plan.certificate if c.constraint == "target house")
    assert 3.0 < wall.worst < 6.0  # the cylinder about it reaches 30 m
    assert judge(case_of(path, "none")) == []


def test_a_long_train_on_a_straight_line_is_passed_nearer_than_it_is_long(tmp_path: Path) -> None:
    text = HEAD.replace(BEND, "{start: [-20, 0, 1.8], velocity: [3, 0.5, 0]}")
    text = text.replace("size: [4.5, 1.8, 1.5]", "size: [60, 3, 3.6]").replace("[-40, -30, 0]", "[0, -30, 0]")
    shot = "  - {id: by, kind: lateral, drone: cam1, target: car, side: right, distance: 14, altitude: 6,\n"
    path = tmp_path / "train.yaml"
    path.write_text(
        text + shot + "     composition: keep, timing: {start: 14, duration: 5}}\n", encoding="utf-8"
    )
    done = compiled(path, "none")
    assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
    (side,) = (c for c in done.plan.certificate if c.constraint == "target car")
    assert 9.0 < side.worst < 13.0  # the cylinder about it reaches 30 m
    assert judge(case_of(path, "none")) == []


def test_what_a_clearance_counts_from_is_told_where_it_is_not_the_body(tmp_path: Path) -> None:
    shot = "  - {id: by, kind: lateral, drone: cam1, target: car, side: right, distance: 7, altitude: 3,\n"
    path = tmp_path / "near.yaml"
    path.write_text(HEAD + shot + "     timing: {start: 14, duration: 6}}\n", encoding="utf-8")
    told = [d for d in compiled(path, "none").diagnostics if d.code == "V034"]
    assert told
    assert all(any("2.42 m in radius" in note for note in d.notes) for d in told)
