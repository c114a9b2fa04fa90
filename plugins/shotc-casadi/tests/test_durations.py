"""A duration that is too short for a refined path: the one that is told is enough when it is written."""

from __future__ import annotations

import re

import pytest

from shotc.api import PlanOptions, compile_source

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: turn
targets: {tower: {at: [0, 0, 20], radius: 4, height: 40}}
drones: {cam: {model: x500, home: [0, -60, 0]}}
shots:
  - id: round
    kind: keyframes
    drone: cam
    target: tower
    timing: {duration: SECONDS s}
    keyframes:
      - {at: [-50, -35, 20], look_at: tower}
      - {at: [50, -35, 20], look_at: tower}
"""


def planned(seconds: str):
    return compile_source(MISSION.replace("SECONDS", seconds).encode(), "m.yaml", None, PlanOptions())


@pytest.mark.long
def test_the_duration_that_is_told_is_that_of_the_refined_path_and_is_enough():
    (fault,) = planned("15.3").diagnostics
    assert fault.code == "T001"
    assert "is the shortest possible on the path of refiner `ours`" in fault.message
    convex = re.search(r"convex path is too slow, too: .* but ([\d.]+) s is the shortest", fault.notes[-1])
    told = re.search(r"`duration: ([\d.]+) s`", fault.help)
    assert convex is not None
    assert told is not None
    assert float(convex[1]) < float(told[1])
    assert planned(told[1]).plan is not None
