"""A shot of two targets in turn: an edited plan that frames less than it films is refused."""

import json
from hashlib import sha256
from typing import Any

import pytest

from shotc import api
from tests.support.compiled import compiled_text
from tests.support.resealed_plans import resealed

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: turn
targets: {tower: {at: [0, 0, 10], radius: 3, height: 20}, mast: {at: [0, -60, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [-30, -60, 0]}}
shots:
  - id: look
    kind: keyframes
    drone: cam
    allow: [fast-pan]
    require: {in_frame: 90 %}
    keyframes:
      - {at: [-40, -10, 12], look_at: tower}
      - {at: [-40, -25, 12], look_at: mast}
"""
"""The tower is whole in 91.55 % of the frames that are said to show it: not when the camera turns from it."""


@pytest.fixture(scope="module")
def plan() -> bytes:
    done = compiled_text(MISSION, "none")
    assert done.plan is not None, done.diagnostics
    return api.emit_plan(done.plan, []).artifacts[0].data


def asked_for_more(plan: bytes) -> dict[str, Any]:
    """Return the plan with the mission of a promise that it does not keep."""
    document: dict[str, Any] = json.loads(plan)
    text = MISSION.replace("90 %", "95 %")
    document["source"].update(text=text.split("\n"), sha256=sha256(text.encode()).hexdigest())
    document["mission"]["shots"][0]["promise"]["in_frame"] = 0.95
    return document


def shortened(framing: list[dict[str, Any]]) -> None:
    framing[0]["end"] = framing[0]["start"] + 0.5


def dropped(framing: list[dict[str, Any]]) -> None:
    del framing[0]


def as_it_was(framing: list[dict[str, Any]]) -> None:
    pass


@pytest.mark.parametrize(("edit", "code"), [(as_it_was, "V019"), (shortened, "V024"), (dropped, "V024")])
def test_a_target_is_framed_until_the_next_one_is(plan: bytes, edit: Any, code: str) -> None:
    document = asked_for_more(plan)
    edit(document["drones"][0]["framing"])
    report = api.verify_plan(resealed(document), "plan.json")
    assert report.plan is None
    assert code in {fault.code for fault in report.diagnostics}
