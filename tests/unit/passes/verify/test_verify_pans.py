"""Pans as they are flown: told once a shot, with the number that is flown, and a remedy that mends it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.ir.path import CAM_YAW

SWEEP = """\
shotc: 1
mission: pan
targets: {mast: {at: [0, -30, 6], radius: 0.5, height: 12}}
drones: {cam: {model: x500, home: [0, -60, 0]}}
shots:
  - id: sweep
    kind: keyframes
    drone: cam
    timing: TIMING
    keyframes:
      - {at: [0, -50, 15], heading: 320 deg, pitch: 0 deg}
      - {at: [4, -50, 15], heading: 20 deg, pitch: 0 deg}
"""
PANS = ("F005", "V051")


def planned(timing: str, text: str = SWEEP) -> Compilation:
    done = compile_source(
        text.replace("TIMING", timing).encode(), "m.yaml", None, PlanOptions(refiner="none")
    )
    assert done.plan is not None
    return done


def told(done: Compilation) -> list[str]:
    return [d.code for d in done.diagnostics if d.code in PANS]


def test_a_pan_whose_time_was_not_known_is_told_with_what_is_flown() -> None:
    done = planned("auto")
    assert told(done) == ["V051"]
    (found,) = (d for d in done.diagnostics if d.code == "V051")
    assert done.plan is not None
    (track,) = done.plan.trajectory.drones
    (phase,) = (p for p in track.phases if p.shot == "sweep")
    starts = np.linspace(phase.start, phase.end - 1, 500)
    turned = np.abs(track.curve(starts + 1)[:, CAM_YAW] - track.curve(starts)[:, CAM_YAW]).max()
    width = 2 * np.tan(np.radians(35)) / turned
    assert f"goes by in {width:.1f} s" in found.notes[0]
    assert found.labels[0].span.line == 6


def test_a_pan_that_check_tells_is_told_once_a_shot() -> None:
    assert told(planned("{duration: 5}")) == ["V051"]


@pytest.mark.slow
def test_the_duration_of_the_remedy_mends_it() -> None:
    (found,) = (d for d in planned("auto").diagnostics if d.code == "V051")
    asked = re.search(r"duration: [\d.]+ s", found.help or "")
    assert asked is not None
    assert told(planned(f"{{{asked[0]}}}")) == []


@pytest.mark.slow
def test_what_is_meant_is_not_told() -> None:
    assert told(planned("auto", SWEEP.replace("drone: cam", "drone: cam\n    allow: [fast-pan]"))) == []
    assert told(planned("auto", SWEEP.replace("shots:", "rules: {allow: [fast-pan]}\nshots:"))) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("look", "found"), [("look_at: mast", []), ("heading: 53 deg, pitch: 0 deg", ["V051"])]
)
def test_a_subject_that_is_followed_holds_the_eye(look: str, found: list[str]) -> None:
    """The same places: at the rate at which a free camera judders, one that follows its target does not."""
    text = SWEEP.replace("heading: 20 deg, pitch: 0 deg", "look_at: mast").replace(
        "[4, -50, 15]", "[16, -42, 9]"
    )
    text = text.replace("[0, -50, 15], heading: 320 deg, pitch: 0 deg", f"[-16, -42, 9], {look}")
    codes = told(planned("{duration: 14}", text))
    assert codes == found
