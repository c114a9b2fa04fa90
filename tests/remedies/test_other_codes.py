"""Helps of codes without an example in the registry: each remedy is written into a mission and planned."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import pytest

from tests.remedies.test_planned import planned
from tests.support.remedies.tried import failed

pytestmark = pytest.mark.slow


class Case(NamedTuple):
    """The drones and shots of a mission that raises a code.

    remedies : how many of its helps a rule applies
    """

    code: str
    remedies: int
    drones: str
    shots: tuple[str, ...]
    world: str = "{}"


MISSION = """\
shotc: 1
mission: other
world: {WORLD}
targets:
  tower: {at: [0, 0, 10], radius: 3, height: 20}
  mast: {at: [0, -60, 6], radius: 1, height: 12}
drones:
  {DRONES}
shots:
"""
CAM = "cam: {model: x500, home: [-30, -70, 0]MORE}"
TWO = "c0: {model: x500, home: [-30, -70, 0]}\n  c1: {model: x500, home: [40, 30, 0]}"
SHARP = ", camera: {sensor: 36 mm, focal_length: 85 mm, aperture: f/1.4}"
WALL = "{zones: {wall: {keep: out, box: {center: [-20, 0, 9], size: [1, 30, 18]}}}}"
CASES = [
    Case("G010", 3, CAM, ("kind: static, drone: cam, at: [0, -20, 12], look_at: tower",)),
    Case("G010", 3, CAM, ("kind: orbit, drone: cam, target: mast, radius: 12, altitude: 6, sweep: 90 deg",)),
    Case("G010", 2, CAM.replace("MORE", SHARP),
        ("kind: static, drone: cam, at: [-55, 0, 10], look_at: tower",)),
    Case("V061", 2, CAM.replace("MORE", SHARP),
        ("kind: static, drone: cam, at: [-95, 0, 10], look_at: tower, focus: 20 m",)),
    Case("V050", 1, CAM, ("kind: static, drone: cam, at: [-50, 0, 5], look_at: tower",), WALL),
    Case("T004", 1, CAM.replace("MORE", ", endurance: 40 s"),
        ("kind: orbit, drone: cam, target: tower, radius: 40, altitude: 12",)),
    Case("V033", 3, TWO,
        ("kind: static, drone: c0, at: [-40, 0, 12], look_at: tower, timing: {start: 30, duration: 8}",
         "kind: static, drone: c1, at: [40, 5, 12], look_at: tower, timing: {start: 30, duration: 8}")),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_does_when_it_is_written(case: Case) -> None:
    text = MISSION.replace("{WORLD}", case.world).replace("{DRONES}", case.drones.replace("MORE", ""))
    text += "".join(f"  - {{id: s{i}, {shot}}}\n" for i, shot in enumerate(case.shots))
    judged = partial(planned, refiner="none")
    assert {fault.code for fault in judged(text)} == {case.code}
    found, wrong = failed(text, judged)
    assert len(found) == case.remedies
    assert wrong == []
