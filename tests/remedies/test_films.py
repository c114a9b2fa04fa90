"""Helps about films that leave a choice, in missions that are no example: each is done once."""

from __future__ import annotations

from functools import partial

import pytest

from tests.remedies.test_planned import planned
from tests.support.remedies.done import Done, assert_helps

pytestmark = pytest.mark.slow

RUN = """\
shotc: 1
mission: watch
rules: {transit_clearance: {filmed: 1}}
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - SHOT
"""
PASS = (
    "{id: pass, kind: static, drone: cam, target: runner, at: [30, -12, 4], heading: 0 deg, pitch: -10 deg, "
    "timing: {start: 15, duration: 15}, allow: [walks-out-of-frame]}"
)
CASES = [
    Done("V030", RUN.replace("SHOT", PASS), "film from farther away",
        (("at: [30, -12, 4]", "at: [30, -60, 8]"),)),
    Done("V030", RUN.replace("SHOT", PASS), "through a wider lens there",
        (("home: [0, -30, 0]", "home: [0, -30, 0], camera: {hfov: 110 deg}"),)),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[f"{case.code}-{i}" for i, case in enumerate(CASES)])
def test_what_a_help_proposes_does_when_it_is_written(case: Done) -> None:
    assert_helps(case, partial(planned, refiner="none"))
