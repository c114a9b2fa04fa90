"""Refined shots in a wind of known direction: faster with it than against it, never too fast for the air."""

from __future__ import annotations

import pytest

from shotc.api import PlanOptions, compile_source
from shotc.ir.trajectory import VerifiedIR
from shotc.passes.refine_path.account import DONE

pytestmark = pytest.mark.slow

HEAD = """\
shotc: 1
mission: windy
world: {wind: {speed: 4 m/s, from: FROM deg}}
drones: {cam: {model: x500, home: [0, -60, 0]}}
targets:
  tower: {at: [0, 0, 10], radius: 2, height: 20}
  runner: {track: {points: [[0, 0, 0.9], [290, 0, 0.9]], speed: 7 m/s}, radius: 0.4, height: 1.8}
"""
PAST = """\
shots:
  - id: past
    kind: keyframes
    drone: cam
    target: tower
    pace: brisk
    keyframes: [{at: [-60, -40, 10], look_at: tower}, {at: [60, -40, 10], look_at: tower}]
"""
AFTER = """\
shots:
  - {id: after, kind: lateral, side: right, drone: cam, target: runner, distance: 12, altitude: 4,
     timing: {start: 30, duration: 4}}
"""


def planned(shots: str, bearing: int) -> VerifiedIR:
    text = HEAD.replace("FROM", str(bearing)) + shots
    done = compile_source(text.encode(), "windy.yaml", None, PlanOptions(refiner="ours"))
    assert done.plan is not None, done.diagnostics
    return done.plan


def airspeed(plan: VerifiedIR) -> float:
    return next(c.worst for c in plan.certificate if c.constraint == "airspeed")


def test_a_path_is_refined_at_the_speed_that_the_wind_allows() -> None:
    with_it, against = planned(PAST, 270), planned(PAST, 90)
    lasts = [
        next(p.end - p.start for p in plan.trajectory.drones[0].phases if p.shot)
        for plan in (with_it, against)
    ]
    for plan in (with_it, against):
        assert dict(plan.trajectory.stats)["past.refined"] == DONE
        assert airspeed(plan) <= 8.0 + 8e-6
    # 120 m at up to 12 m/s, or at up to 4 m/s.
    assert lasts[0] < 17.0
    assert 30.0 < lasts[1] < 36.0


def test_a_shot_of_what_moves_is_refined_through_the_air() -> None:
    plan = planned(AFTER, 270)
    assert dict(plan.trajectory.stats)["after.refined"] == DONE
    assert 4.0 < airspeed(plan) <= 8.0 + 8e-6
