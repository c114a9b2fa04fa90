"""A camera that swings from one target to another: neither is blamed for the frames in between."""

from __future__ import annotations

import pytest

from shotc.api import PlanOptions, compile_source

pytestmark = pytest.mark.slow

MISSION = """
shotc: 1
mission: hand-over
targets:
  tower: {at: [0, 0, 10], radius: 3, height: 20}
  house: {at: [90, 0, 5], radius: 6, height: 10}
drones: {cam: {model: x500, home: [0, -70, 0]}}
rules: {composition: center}
shots:
  - id: swing
    kind: keyframes
    drone: cam
    REQUIRE
    keyframes:
      - {at: [-20, -50, 14], look_at: tower}
      - {at: [0, -50, 14], look_at: tower, hold: 2 s}
      - {at: [60, -40, 14], look_at: house}
      - {at: [80, -40, 14], look_at: house}
"""


def plan_of(require: str):
    done = compile_source(
        MISSION.replace("REQUIRE", require).encode(), "swing.yaml", None, PlanOptions("none")
    )
    assert done.plan is not None, [d.message for d in done.diagnostics]
    return done


def test_frames_of_a_hand_over_are_no_fault():
    done = plan_of("pace: normal")
    assert "V030" not in {d.code for d in done.diagnostics}
    assert done.plan is not None
    shares = {c.constraint: c.worst for c in done.plan.certificate if c.constraint.endswith("in frame")}
    assert shares == {"tower in frame": 1.0, "house in frame": 1.0}


def test_a_promise_can_be_kept_over_a_hand_over():
    assert plan_of("require: {in_frame: 100 %}").plan is not None
