"""Shots that look where they fly: recomputed from the trajectory alone."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import degrees
from pathlib import Path

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.cli.summary import summary
from shotc.geom.bernstein import Piecewise
from shotc.geom.vec import wrapped
from shotc.ir.passes import PassContext
from shotc.ir.path import BODY_YAW, CAM_YAW
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.verify import judge
from shotc.planning.path import shots
from tests.support.few import few

pytestmark = pytest.mark.slow

FAST_M_S = 0.5
HALF_DEG = 18.0


def mission(body: str, points: str, extra: str = "") -> str:
    return f"""\
shotc: 1
mission: along
targets: {{tower: {{at: [40, 30, 10], radius: 3, height: 20}}}}
drones: {{cam: {{model: x500, home: [0, -40], body: {body}}}}}
rules: {{look_ahead: {HALF_DEG} deg, allow: [fast-pan]}}
shots:
  - {{id: run, kind: follow-path, drone: cam, points: {points}, heading: along, pitch: -8 deg}}
{extra}output: {{rate: 5}}
"""


ROUND = "  - {id: round, kind: orbit, drone: cam, target: tower, radius: 34, altitude: 15, sweep: 80 deg}\n"
CORNERS = "[[0, 0, 10], [30, 0, 12], [33, 22, 14], [-20, 30, 10]]"


def compiled(text: str, refiner: str = "none") -> Compilation:
    return compile_source(text.encode(), "along.yaml", None, PlanOptions(refiner=refiner))


@lru_cache
def planned(text: str, refiner: str = "none") -> VerifiedIR:
    done = compiled(text, refiner)
    assert done.plan is not None, [d.message for d in done.diagnostics]
    return done.plan


def claimed(plan: VerifiedIR, shot: str) -> Claim:
    return next(c for c in plan.certificate if c.constraint == "look ahead" and c.shot == shot)


def off_course(plan: VerifiedIR, shot: str, channel: int = BODY_YAW) -> float:
    """Return the largest angle between nose and course in a shot, at samples, degrees."""
    (track,) = (t for t in plan.trajectory.drones if any(p.shot == shot for p in t.phases))
    phase = next(p for p in track.phases if p.shot == shot)
    t = np.linspace(phase.start, phase.end, 8001)
    v = track.curve.derivative()(t)[:, :2]
    off = np.abs(wrapped(track.curve(t)[:, channel] - np.arctan2(v[:, 1], v[:, 0])))
    return degrees(off[np.linalg.norm(v, axis=1) > FAST_M_S].max())


@pytest.mark.long
@pytest.mark.parametrize("seed", few(range(16), range(2)))
def test_whatever_path_is_drawn_its_nose_and_its_camera_look_along_it(seed: int) -> None:
    rng = np.random.default_rng([seed, 156])
    places = np.cumsum(rng.uniform(-30.0, 30.0, (int(rng.integers(3, 6)), 2)), axis=0).round(1)
    points = ", ".join(f"[{x}, {y}, {rng.uniform(8.0, 16.0):.1f}]" for x, y in places)
    text = mission(str(rng.choice(["follow-camera", "forward", "free"])), f"[{points}]")
    plan = planned(text.replace("{at: [40, 30, 10]", "{at: [900, 30, 10]"))
    claim = claimed(plan, "run")
    assert claim.holds
    assert claim.method == "bounded"
    assert off_course(plan, "run") <= degrees(claim.worst) + 1e-3 <= HALF_DEG + 2e-3
    assert off_course(plan, "run", CAM_YAW) <= HALF_DEG


@pytest.mark.long
def test_the_same_path_is_refused_where_nobody_plans_it(monkeypatch: pytest.MonkeyPatch) -> None:
    text = mission("follow-camera", CORNERS)
    monkeypatch.setattr(shots, "ahead_in", lambda mission, shot: None)
    done = compiled(text)
    assert done.plan is None
    (broken,) = (d for d in done.diagnostics if d.code == "V056")
    assert "shot `run`" in broken.message
    assert {label.span.line for label in broken.labels} == {5, 7}


@pytest.mark.long
def test_a_refined_shot_still_looks_along_its_path() -> None:
    plan = planned(mission("follow-camera", CORNERS), "ours")
    assert claimed(plan, "run").holds
    assert off_course(plan, "run") <= HALF_DEG


@pytest.mark.long
def test_beside_another_drone_the_legs_keep_their_times_and_look_ahead() -> None:
    far = "  - {id: far, kind: static, drone: two, at: [-60, -60, 9], heading: 0 deg, pitch: 0 deg}\n"
    text = mission("follow-camera", CORNERS, far)
    text = text.replace("drones: {", "drones: {two: {model: x500, home: [-60, -70]}, ")
    for refiner in ("none", "ours"):
        plan = planned(text, refiner)
        assert off_course(plan, "run") <= HALF_DEG


@pytest.mark.long
def test_a_body_under_a_camera_that_films_looks_ahead_where_its_gimbal_pans_enough() -> None:
    plan = planned(mission("forward", CORNERS, ROUND))
    assert claimed(plan, "round").holds
    assert off_course(plan, "round") <= HALF_DEG
    assert off_course(plan, "round", CAM_YAW) > 60.0
    assert "in `run`, in `round`" in summary(plan, [Path("o/plan.json")], [])


@pytest.mark.long
@pytest.mark.parametrize(
    ("drone", "why"),
    [
        ("body: follow-camera", "its body turns with its camera"),
        ("body: forward, gimbal: {yaw: [-30 deg, 30 deg]}", "leaves the nose"),
    ],
)
def test_a_shot_whose_framing_binds_the_nose_is_not_judged_and_the_summary_says_why(
    drone: str, why: str
) -> None:
    plan = planned(mission("forward", CORNERS, ROUND).replace("body: forward", drone))
    assert not [c for c in plan.certificate if c.constraint == "look ahead" and c.shot == "round"]
    told = " ".join(summary(plan, [Path("o/plan.json")], []).split())
    assert "not judged in `round`" in told
    assert why in told


def test_verification_sees_a_nose_that_somebody_turned_aside() -> None:
    plan = planned(mission("forward", CORNERS, ROUND))
    (track,) = plan.trajectory.drones
    ctrl = track.curve.ctrl.copy()
    ctrl[:, :, BODY_YAW] += np.radians(25.0)
    aside = replace(track, curve=Piecewise(track.curve.breaks, ctrl))
    verdict = judge(replace(plan.trajectory, drones=(aside,)), PassContext())
    broken = [c for c in verdict.certificate if c.constraint == "look ahead" and not c.holds]
    assert {c.shot for c in broken} == {None, "run", "round"}
