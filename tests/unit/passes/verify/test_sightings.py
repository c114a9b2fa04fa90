"""What is told of drones in each other's pictures, of plans made and of plans tampered with."""

from __future__ import annotations

import json
import re
from functools import cache
from math import atan2, cos, pi, radians, sin
from pathlib import Path
from typing import Any

import pytest

from shotc.api import Compilation, verify_plan
from shotc.cli.summary import summary
from shotc.diag.model import Diagnostic
from shotc.ir.path import CAM_YAW
from shotc.planfile.write import document
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

PAIR = """\
shotc: 1
mission: pair
drones:
  one: {model: x500, home: [0, -40, 0]}
  two: {model: x500, home: [8, -40, 0]}
RULES
shots:
  - {id: look, kind: static, drone: one, at: [0, -30, 9], heading: 0 deg, pitch: 0 deg,
     timing: {start: 40, duration: 5}}
  - {id: see, kind: static, drone: two, at: [PLACE, 9], heading: HEADING deg, pitch: 0 deg,
     timing: {start: 40, duration: 5}}
"""
FACING, ABREAST, BEFORE = ("0, 30", "180"), ("12, -30", "0"), ("0, 30", "0")
REQUIRE = "rules: {mutual_visibility: {strength: require}}"


@cache
def planned(where: tuple[str, str], rules: str = "") -> Compilation:
    text = PAIR.replace("RULES", rules).replace("PLACE", where[0]).replace("HEADING", where[1])
    return compiled_text(text, "none", "m.yaml")


def told(found: Compilation) -> list[Diagnostic]:
    return [d for d in found.diagnostics if d.code in ("V025", "V033")]


def facts(found: Compilation) -> str:
    assert found.plan is not None
    text = summary(found.plan, [Path("out/plan.json")], [])
    return " ".join(text.split())


def lines(diagnostic: Diagnostic) -> list[int]:
    return [label.span.line for label in diagnostic.labels]


def test_a_silent_mission_prefers_and_warns_of_either_direction() -> None:
    found = planned(FACING)
    assert found.plan is not None
    assert [d.message for d in told(found)] == [
        "two is in the picture of one in shot `look`",
        "one is in the picture of two in shot `see`",
    ]
    (first, _) = told(found)
    assert lines(first) == [8]
    assert first.notes[0].startswith("first at t = 40.000 s, 0.000 s into the shot, in 100 % of its frames")
    assert "60.0 m from the camera; two is in its shot `see` then" in first.notes[1]
    assert first.notes[2] == "nothing worse happens between samples"
    assert "strength: off" in first.help


def test_the_heading_that_is_proposed_is_north_turned_by_as_much_as_is_told() -> None:
    (first, _) = told(planned(FACING))
    found = re.search(
        r"turn the camera of `look` (\d+) deg to the (left|right), by `heading: (\d+) deg`", first.help
    )
    assert found is not None, first.help
    by = int(found[1]) if found[2] == "right" else -int(found[1])
    assert int(found[3]) == by % 360
    assert 30 < abs(by) < 45  # half of its field of view, and a little more


def test_all_who_are_preferred_not_to_be_seen_in_a_shot_are_told_in_one() -> None:
    third = "  three: {model: x500, home: [0, 5, 0]}\nRULES"
    text = PAIR.replace("RULES", third).replace("PLACE", "0, 30").replace("HEADING", "0")
    seen = "  - {id: more, kind: static, drone: three, at: [4, 25, 9], heading: 0 deg, pitch: 0 deg,\n"
    text = text.replace("RULES", "") + seen + "     timing: {start: 40, duration: 5}}\n"
    found = compiled_text(text, "none", "m.yaml")
    said = told(found)
    assert said[0].message == "three and two are in the picture of one in shot `look`"
    assert {note.split()[0] for note in said[0].notes} >= {"two", "three"}
    assert len({d.message.partition(" in shot ")[2] for d in said}) == len(said)


def test_one_may_see_the_other_alone() -> None:
    assert [d.message for d in told(planned(BEFORE))] == ["two is in the picture of one in shot `look`"]


def test_a_requirement_refuses_and_points_at_its_line() -> None:
    found = planned(FACING, REQUIRE)
    assert found.plan is None
    assert [d.code for d in told(found)] == ["V025", "V025"]
    assert lines(told(found)[0]) == [8, 6]
    assert "strength: prefer" in told(found)[0].help


def test_nothing_is_told_where_it_is_off_or_kept() -> None:
    assert told(planned(FACING, "rules: {mutual_visibility: {strength: off}}")) == []
    assert told(planned(ABREAST, REQUIRE)) == []


def test_a_cone_is_told_in_degrees() -> None:
    cone = planned(FACING, "rules: {mutual_visibility: {half_angle: 20 deg, strength: prefer}}")
    (first, _) = told(cone)
    assert first.message == "two is within 20 deg of the optical axis of one in shot `look`"
    assert "0 deg off the axis, 20 deg are to be kept free" in first.notes[1]


@pytest.mark.parametrize(
    ("where", "rules", "said"),
    [
        (ABREAST, REQUIRE, "3.00 m needed, at"),
        (ABREAST, REQUIRE, "none is in the picture of another"),
        (FACING, "", "two is in the picture of one (shot look), one is in the picture of two (shot see)"),
        (FACING, "rules: {mutual_visibility: {strength: off}}", "pictures are not judged"),
        (
            ABREAST,
            "rules: {mutual_visibility: {half_angle: 10 deg}}",
            "none is within 10 deg of the axis of another",
        ),
    ],
)
def test_the_summary_tells_of_the_drones_together(where: tuple[str, str], rules: str, said: str) -> None:
    assert said in facts(planned(where, rules))


def proved(value: dict[str, Any]) -> set[str]:
    return {d.code for d in verify_plan(json.dumps(value).encode(), "plan.json").diagnostics}


def plan_of(where: tuple[str, str], rules: str = "") -> dict[str, Any]:
    plan = planned(where, rules).plan
    assert plan is not None
    written: dict[str, Any] = json.loads(json.dumps(document(plan)))
    return written


def test_a_plan_proves_itself_again() -> None:
    assert proved(plan_of(ABREAST, REQUIRE)) == set()
    assert proved(plan_of(FACING)) == {"V033"}


def test_a_camera_that_was_turned_in_the_plan_is_noticed() -> None:
    value = plan_of(ABREAST, REQUIRE)
    for piece in value["drones"][1]["curve"]["control"]:
        for point in piece:
            point[CAM_YAW] += pi / 2
    assert "V025" in proved(value)


def test_a_rule_that_was_edited_in_the_plan_is_noticed() -> None:
    value = plan_of(FACING)
    value["mission"]["rules"]["visibility"] = "require"
    assert {"V025", "V040"} <= proved(value)
    value["mission"]["rules"]["visibility"] = "off"
    assert "V040" in proved(value)
    value = plan_of(ABREAST, REQUIRE)
    value["mission"]["rules"]["half_angle"] = 0.2
    assert "V040" in proved(value)


def test_a_claim_that_was_made_better_in_the_plan_is_noticed() -> None:
    value = plan_of(FACING)
    for claim in value["certificate"]:
        if claim["constraint"] == "two out of the picture":
            claim["worst"], claim["holds"] = 1.0, True
    assert proved(value) == {"V033", "V040"}
    value = plan_of(FACING)
    value["certificate"] = [c for c in value["certificate"] if "picture" not in c["constraint"]]
    assert proved(value) == {"V033", "V040"}


@pytest.mark.parametrize("angle", [0.0, -0.1, 2.0, "wide"])
def test_a_cone_that_is_none_is_refused(angle: object) -> None:
    value = plan_of(ABREAST, REQUIRE)
    value["mission"]["rules"]["half_angle"] = angle
    assert verify_plan(json.dumps(value).encode(), "plan.json").plan is None


def test_how_far_aside_another_has_to_be_is_what_lacks_to_the_cone() -> None:
    found = planned(("6, 30", "180"), "rules: {mutual_visibility: {half_angle: 20 deg, strength: prefer}}")
    assert found.plan is not None
    (first, _) = told(found)
    claim = next(c for c in found.plan.certificate if c.constraint == "two out of the picture")
    # The body is nearer to the axis than its centre by as much as its radius is wide.
    assert 0.8 * atan2(6.0, 60.0) < claim.worst < atan2(6.0, 60.0)
    radius = found.plan.trajectory.keyframes.mission.drone("two").radius
    # The other is 6 m beside the axis and 60 m ahead; its sphere has to touch the cone from outside.
    lack = (60.0 * sin(radians(20.0)) + radius) / cos(radians(20.0)) - 6.0
    metres = re.search(r"film from where `two` is ([0-9.]+) m farther to the right", first.help)
    assert metres is not None
    assert lack < float(metres[1]) < lack + 0.2
