"""A plan file stands for itself: it is proved from its bytes, and an edit that matters is noticed."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from shotc import api
from shotc.diag.registry import has_errors
from tests.e2e.conftest import ROOT, Plan, each_mission

pytestmark = pytest.mark.slow

TOWER = ROOT / "specs" / "tower-reveal.yaml"
ORBIT = ROOT / "shotc" / "templates" / "orbit.yaml"

Document = dict[str, Any]
Edit = Callable[[Document], object]


def prove(document: Document, **style: Any) -> api.PlanReport:
    return api.verify_plan(json.dumps(document, **style).encode(), "plan.json")


def edited(path: str, change: Callable[[float], float]) -> Edit:
    """Return an edit of the number at a path such as ``mission.rules.separation``."""

    def edit(document: Document) -> None:
        *parents, last = (int(k) if k.isdecimal() else k for k in path.split("."))
        place: Any = document
        for key in parents:
            place = place[key]
        place[last] = change(place[last])

    return edit


def plus(path: str, amount: float) -> Edit:
    return edited(path, lambda old: old + amount)


def times(path: str, factor: float) -> Edit:
    return edited(path, lambda old: old * factor)


@pytest.mark.long
@pytest.mark.parametrize("path", each_mission())
def test_a_plan_is_proved_from_its_bytes_alone(
    plan: Plan, path: Any, tmp_path: Any, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    report = api.verify_plan(plan(path).files["plan.json"], "plan.json")
    assert report.plan is not None
    assert not has_errors(report.diagnostics)
    assert report.certificate == plan(path).plan.certificate


def test_what_is_proved_again_is_emitted_again(plan: Plan) -> None:
    planned = plan(TOWER)
    report = api.verify_plan(planned.files["plan.json"], "plan.json")
    assert report.plan is not None
    assert {a.name: a.data for a in api.emit_plan(report.plan, ["csv"]).artifacts} == planned.files


@pytest.mark.parametrize(
    "style",
    [{"indent": 3}, {"separators": (",", ":")}, {"sort_keys": True}],
    ids=["indent", "tight", "sorted"],
)
def test_another_way_to_write_the_same_json_is_the_same_plan(plan: Plan, style: dict[str, Any]) -> None:
    report = prove(json.loads(plan(TOWER).files["plan.json"]), **style)
    assert report.plan is not None


LIMITS = "mission.drones.0.limits."
GIMBAL = "mission.drones.0.gimbal."
EDITS: dict[str, Edit] = {
    **{f"{name} lowered": times(LIMITS + name, 0.5) for name in ("speed", "acceleration", "jerk")},
    **{f"{name} lowered": times(LIMITS + name, 0.3) for name in ("climb", "descent")},
    **{f"{name} raised": times(LIMITS + name, 2) for name in ("speed", "jerk", "yaw_rate")},
    "gimbal slowed": times(GIMBAL + "rate", 0.01),
    "gimbal stiffened": times(GIMBAL + "acceleration", 0.001),
    "gimbal held up": edited(GIMBAL + "pitch.0", lambda _: -0.01),
    "endurance shortened": times("mission.drones.0.endurance", 0.01),
    "drone grown": times("mission.drones.0.radius", 20),
    "home moved": plus("mission.drones.0.home.0", 0.5),
    "ground raised": plus("mission.rules.ground_clearance", 5),
    "target clearance raised": plus("mission.rules.target_clearance", 40),
    "tree moved into the path": lambda d: zone(d, "tree").update(centre=on_the_path(d)),
    "field lowered": lambda d: zone(d, "field").update(top=12.0),
    "house grown": lambda d: zone(d, "house").update(
        points=[[-200, -200], [200, -200], [200, 200], [-200, 200]]
    ),
    "target moved": plus("mission.targets.0.centre.0", 3),
    "target grown": times("mission.targets.0.shape.height", 2),
    "promise raised": lambda d: d["mission"]["shots"][0]["promise"].update(in_frame=1.0),
    "duration asked": lambda d: d["mission"]["shots"][0]["timing"].update(duration=20.0),
    "start asked": lambda d: d["mission"]["shots"][0]["timing"].update(start=20.0),
    "keyframe moved": plus("keyframes.0.keyframes.1.at.2", 0.01),
    "keyframe time moved": plus("drones.0.keyframes.1.time", 0.5),
    "hold lengthened": plus("keyframes.0.keyframes.2.hold", 1.5),
    "screen reference moved": plus("keyframes.0.keyframes.1.reference.0", 0.1),
    "shot begun later": lambda d: shift(d, "shot", 0.5),
    "landing begun sooner": lambda d: shift(d, "land", -1.0),
    "take-off skipped": lambda d: shift(d, "transit", -1.0),
    "certificate bettered": lambda d: claim(d, "speed").update(worst=claim(d, "speed")["worst"] * 0.9),
    "certificate turned": lambda d: claim(d, "jerk").update(holds=False),
    "claim dropped": lambda d: d["certificate"].remove(claim(d, "zone tree")),
    "claim softened": lambda d: claim(d, "zone tree").update(hard=False),
}


def zone(document: Document, name: str) -> Document:
    return next(zone for zone in document["mission"]["zones"] if zone["name"] == name)["solid"]  # type: ignore[no-any-return]


def claim(document: Document, constraint: str) -> Document:
    return next(claim for claim in document["certificate"] if claim["constraint"] == constraint)  # type: ignore[no-any-return]


def on_the_path(document: Document) -> list[float]:
    control = document["drones"][0]["curve"]["control"]
    return control[len(control) // 2][0][:2]  # type: ignore[no-any-return]


def shift(document: Document, phase: str, seconds: float) -> None:
    """Move the boundary at which a phase begins."""
    phases = document["drones"][0]["phases"]
    index = next(i for i, p in enumerate(phases) if p["name"] == phase)
    phases[index]["start"] += seconds
    phases[index - 1]["end"] += seconds


@pytest.mark.long
@pytest.mark.parametrize("name", EDITS)
def test_an_edit_that_matters_is_noticed(plan: Plan, name: str) -> None:
    document = json.loads(plan(TOWER).files["plan.json"])
    EDITS[name](document)
    report = prove(document)
    assert report.plan is None
    assert "V" in {d.code[0] for d in report.diagnostics}, report.diagnostics
    assert all(d.labels for d in report.diagnostics)


def test_an_edited_screen_promise_is_noticed(plan: Plan) -> None:
    document = json.loads(plan(ORBIT).files["plan.json"])
    document["mission"]["shots"][0]["promise"]["screen_error"] = 1e-12
    document["mission"]["targets"][0]["centre"][2] += 1
    report = prove(document)
    assert report.plan is None
    assert {"V020", "V040"} <= {d.code for d in report.diagnostics}


@pytest.mark.long
@pytest.mark.parametrize("channel", range(7))
def test_every_control_point_counts(plan: Plan, channel: int) -> None:
    """Whichever of the control points moves by a hundredth, something jumps or does not agree."""
    source = plan(TOWER).files["plan.json"]
    chance = random.Random(channel)
    for _ in range(3):
        document = json.loads(source)
        control = document["drones"][0]["curve"]["control"]
        piece, point = chance.randrange(len(control)), chance.randrange(6)
        control[piece][point][channel] += 0.01
        report = prove(document)
        assert report.plan is None, (piece, point)
        assert "V" in {d.code[0] for d in report.diagnostics}


@pytest.mark.long
def test_every_break_counts_where_the_drone_moves(plan: Plan) -> None:
    source = plan(TOWER).files["plan.json"]
    curve = plan(TOWER).track.curve
    speed = np.linalg.norm(curve.derivative()(curve.breaks)[:, :3], axis=1)
    moving = [int(i) for i in np.flatnonzero(speed > 0.5) if 0 < i < len(curve.breaks) - 1]
    for index in random.Random(0).sample(moving, 8):
        document = json.loads(source)
        breaks = document["drones"][0]["curve"]["breaks"]
        breaks[index] += 0.1 * (breaks[index + 1] - breaks[index])
        report = prove(document)
        assert report.plan is None, index
        assert "V" in {d.code[0] for d in report.diagnostics}
