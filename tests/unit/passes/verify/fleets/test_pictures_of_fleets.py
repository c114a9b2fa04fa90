"""Shows flown under the mission of another show: no other text, place, size, shape or colour is accepted."""

from __future__ import annotations

import json
from typing import Any

import pytest

from shotc import api
from shotc.ir.source import Chosen
from shotc.ir.trajectory import Claim
from shotc.lowering import lower
from tests.support.compiled import compiled_text
from tests.support.records import replace
from tests.support.resealed_plans import resealed
from tests.support.verdicts import verdict_on

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("pictures-of-fleets")]

SHOW = """\
shotc: 1
mission: letters
fleets:
  swarm: {count: 24, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone}
shots:
  - id: d
    kind: display
    fleet: swarm
    viewpoint: [0, -80, 2]
    frames:
      - {text: {text: AB, center: [0, 40, 40], height: 24, heading: 0 deg}, hold: 4}
      - {sphere: {center: [0, 40, 40], radius: 16}, hold: 3, color: red}
      - {torus: {center: [0, 40, 40], radius: 16, tube: 3}, hold: 2}
"""
TEXT, BALL, RING = (line.strip() for line in SHOW.splitlines()[-3:])
OFF = "light off its picture"
SHAPE = {OFF, "picture without lights", "picture off its place", "picture off its size"}
NOT_ASKED: dict[str, tuple[str, str, set[str]]] = {
    "another text": ("AB", "CD", {OFF}),
    "a mirrored text": ("heading: 0 deg", "heading: 180 deg", {OFF}),
    "letters in another order": ("AB", "BA", {OFF}),
    "a ball for a text": (TEXT, "- {sphere: {center: [0, 40, 40], radius: 18}, hold: 4}", SHAPE),
    "a text for a ball": (
        BALL,
        "- {text: {text: AB, center: [0, 40, 40], height: 24}, hold: 3, color: red}",
        {OFF},
    ),
    "a text 20 m aside": ("[0, 40, 40], height", "[20, 40, 40], height", {OFF}),
    "a text 3 m behind": ("[0, 40, 40], height", "[0, 43, 40], height", {OFF}),
    "a larger text": ("height: 24", "height: 34", SHAPE),
    "a smaller text": ("height: 24", "height: 17", SHAPE),
    "a ball 10 m higher": ("40], radius: 16}, hold: 3", "50], radius: 16}, hold: 3", SHAPE),
    "a larger ball": ("radius: 16}, hold: 3", "radius: 25}, hold: 3", {"picture off its size"}),
    "a smaller ball": ("radius: 16}, hold: 3", "radius: 10}, hold: 3", SHAPE),
    "a ring that stands": ("tube: 3", "tube: 3, tilt: 90 deg", SHAPE),
    "another colour": ("color: red", "color: blue", {"light off its colour"}),
    "no colour": (", color: red", "", {"light off its colour"}),
    "a shorter hold": ("hold: 3", "hold: 1", {"excess of hold"}),
    "a longer hold": ("hold: 3", "hold: 30", {"lack of hold"}),
}


def certificate(text: str) -> dict[str, Claim]:
    """Return the claims about the flight of the show under the mission of another text."""
    plan, keyframes = compiled_text(SHOW).plan, lower(text.encode(), "show.yaml", None, Chosen()).keyframes
    assert plan is not None
    assert keyframes is not None
    return {c.constraint: c for c in verdict_on(replace(plan.trajectory, keyframes=keyframes)).certificate}


def test_the_show_holds() -> None:
    assert all(c.holds for c in certificate(SHOW).values())


@pytest.mark.parametrize("name", NOT_ASKED)
def test_a_picture_that_is_not_asked_for_is_refused(name: str) -> None:
    old, new, claims = NOT_ASKED[name]
    changed = SHOW.replace(old, new, 1)
    assert changed != SHOW
    assert {name for name, c in certificate(changed).items() if c.hard and not c.holds} & claims


def test_a_plan_of_dark_lights_with_a_new_seal_is_refused() -> None:
    plan = compiled_text(SHOW).plan
    assert plan is not None
    document: dict[str, Any] = json.loads(api.emit_plan(plan, []).artifacts[0].data)
    lights = document["fleets"][0]["lights"]
    lights["colors"] = ["000000" * len(lights["times"])] * 24
    report = api.verify_plan(resealed(document), "plan.json")
    assert report.plan is None
    assert {d.code for d in report.diagnostics} == {"V064"}


def test_what_a_plan_cannot_show_is_told() -> None:
    told = certificate(SHOW.replace("heading: 0 deg", "font: DejaVu Serif"))["pictures of a file"]
    assert (told.worst, told.limit, told.holds) == (1.0, 3.0, True)
