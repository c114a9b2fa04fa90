"""A duration that is too short for a refined path: the one that is told is enough when it is written."""

from __future__ import annotations

import re
from math import cos, radians, sin

import pytest

from shotc.api import PlanOptions, compile_source

FAR = 61.0  # metres from the tower, at which it fits

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
      - {at: [-EAST, NORTH, 20], look_at: tower}
      - {at: [EAST, NORTH, 20], look_at: tower}
"""


def planned(turn: int, seconds: str):
    east, north = FAR * sin(radians(turn / 2)), -FAR * cos(radians(turn / 2))
    text = MISSION.replace("EAST", f"{east:.2f}").replace("NORTH", f"{north:.2f}")
    return compile_source(text.replace("SECONDS", seconds).encode(), "m.yaml", None, PlanOptions())


@pytest.mark.parametrize(("turn", "seconds"), [(60, "10.4"), (110, "15.3")])
def test_the_duration_that_is_told_is_that_of_the_refined_path_and_is_enough(turn, seconds):
    (fault,) = planned(turn, seconds).diagnostics
    assert fault.code == "T001"
    assert "is the shortest for the path of refiner `ours`" in fault.message
    convex = re.search(r"convex path would not do either.* but ([\d.]+) s is the shortest", fault.notes[-1])
    told = re.search(r"`duration: ([\d.]+) s`", fault.help)
    assert convex is not None
    assert told is not None
    assert float(convex[1]) < float(told[1])
    assert planned(turn, told[1]).plan is not None
