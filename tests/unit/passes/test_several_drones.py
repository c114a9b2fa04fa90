"""Several drones in one mission: they keep apart in the air and on the ground, whoever has to wait."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import PlanOptions, check_source, compile_source
from shotc.ir.trajectory import VerifiedIR

KEPT, GIVEN_UP = 1.0, 2.5  # metres off a place

HEAD = """\
shotc: 1
mission: several
targets:
  runner:
    track: {points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: 3 m/s}
    radius: 0.4
    height: 1.8
  tower: {at: [0, 80, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [20, -20, 0], priority: 1}
  cam2: {model: x500, home: [26, -20, 0], priority: 2}
  cam3: {model: x500, home: [32, -20, 0], priority: 3}
rules: {mutual_visibility: {strength: "off"}}
shots:
"""
SIDE = """\
  - {id: side, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 4,
     timing: {start: 15, duration: 12}}
"""
PASS = """\
  - {id: pass, kind: flyby, drone: cam2, target: runner, behind: 10, ahead: 10, offset: -8, altitude: 4,
     timing: {start: 15, duration: 12}}
"""
TAIL = """\
  - {id: tail, kind: chase, drone: cam3, target: runner, distance: 6, altitude: 4,
     timing: {start: 16, duration: 10}}
"""
ORBITS = """\
  - {id: a, kind: orbit, drone: cam1, target: tower, radius: 45, altitude: 20, sweep: 120 deg,
     start_azimuth: 180 deg}
  - {id: b, kind: orbit, drone: cam2, target: tower, radius: 45, altitude: 20, sweep: -120 deg,
     start_azimuth: 180 deg}
"""


def planned(shots: str, head: str = HEAD) -> VerifiedIR:
    done = compile_source((head + shots).encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    return done.plan


def nearest(plan: VerifiedIR) -> float:
    """Return how near any two drones come, by samples of our own; each stands at its ends."""
    tracks = [t.curve for t in plan.trajectory.drones]
    t = np.arange(0.0, max(c.end for c in tracks), 0.01)
    places = [c(np.minimum(t, c.end))[:, :3] for c in tracks]
    return min(
        float(np.linalg.norm(a - b, axis=1).min()) for i, a in enumerate(places) for b in places[i + 1 :]
    )


def test_three_drones_film_one_runner_and_keep_apart() -> None:
    plan = planned(SIDE + PASS + TAIL)
    assert nearest(plan) >= 3.0 - 1e-6
    claims = [c for c in plan.certificate if c.constraint.startswith("separation")]
    assert len(claims) == 3
    assert all(c.hard and c.holds and c.method == "bounded" for c in claims)
    assert min(c.worst for c in claims) == pytest.approx(nearest(plan), abs=0.02)


def test_the_lower_priority_gives_way() -> None:
    first = planned(SIDE + PASS)
    away = {c.shot: c.worst for c in first.certificate if c.constraint == "distance from its place"}
    assert away["side"] < KEPT
    assert away["pass"] > GIVEN_UP
    swapped = HEAD.replace("priority: 1", "priority: 9")
    other = planned(SIDE + PASS, swapped)
    away = {c.shot: c.worst for c in other.certificate if c.constraint == "distance from its place"}
    assert away["pass"] < KEPT
    assert away["side"] > GIVEN_UP


def test_drones_that_film_what_stands_wait_for_each_other() -> None:
    plan = planned(ORBITS)
    assert nearest(plan) >= 3.0 - 1e-6


def test_a_shot_waits_for_that_of_a_drone_of_lower_priority() -> None:
    wait = ORBITS.replace("start_azimuth: 180 deg}", "start_azimuth: 180 deg, timing: {after: b}}", 1)
    plan = planned(wait)
    phases = {p.shot: p for t in plan.trajectory.drones for p in t.phases if p.shot}
    assert phases["a"].start >= phases["b"].end - 1e-6


def test_homes_that_are_too_near_are_told_on_their_line() -> None:
    near = HEAD.replace("[26, -20, 0]", "[21, -20, 0]") + SIDE + PASS
    found = check_source(near.encode(), "m.yaml", None).diagnostics
    assert [d.code for d in found] == ["G019"]
    assert found[0].labels[0].span.line == 11
