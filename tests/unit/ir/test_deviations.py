"""Which deviations count as leaving what a mission asks for."""

from __future__ import annotations

from shotc.ir.path import CALM, LIMITS, ClockDeviation, from_required_positions
from tests.support.front_passes import clean

TEXT = """\
shotc: 1
mission: deviations
targets:
  runner: {track: {points: [[0, 0, 0.9], [90, 0, 0.9]], speed: 3 m/s}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [-20, -20, 0]}}
shots:
  - id: keyed
    drone: cam
    kind: keyframes
    keyframes:
      - {at: {from: runner, offset: [9, 2, 5]}, look_at: runner}
      - {at: {from: runner, offset: [-4, 9, 6]}, look_at: runner}
    timing: {start: 5, duration: 8}
  - {id: chase, drone: cam, kind: chase, target: runner, distance: 8, altitude: 4,
    timing: {start: 18, duration: 6}}
"""
WHOLE = "the whole subject in the frame, and the drone's limits"


def test_between_keyframes_only_limits_and_calm_do_not_count() -> None:
    mission = clean(TEXT).mission
    all_ = [
        ClockDeviation(shot, 2.0, 6.0, cause)
        for shot in ("keyed", "chase")
        for cause in (LIMITS, CALM, WHOLE, "`tree`")
    ]
    left = from_required_positions(mission, all_)
    assert [d.cause for d in left if d.shot == "keyed"] == [WHOLE, "`tree`"]
    assert [d for d in left if d.shot == "chase"] == [d for d in all_ if d.shot == "chase"]
