"""What a shot promises comes before what is only preferred or told: pictures, and what hides a part."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from shotc_casadi.clock import refiner, shown
from shotc_casadi.clock.references import ClockSubject
from shotc_casadi.clock.refiner import refine_one, subject_of
from shotc_casadi.clock.shown import SubjectVisibility, as_whole, keeps_promises
from shotc_casadi.covered import UncoveredShare

from shotc.api import PlanOptions, compile_source
from shotc.plugin_api import PathIR
from shotc.plugin_api.refiner import ClockLeg, ideal_places

pytestmark = pytest.mark.slow

NEAR = """\
shotc: 1
mission: near
targets:
  runner: {{track: {{points: [[0, 0, 0.9], [60, 0, 0.9]], speed: 1.5 m/s}}, radius: 0.4, height: 1.8}}
drones:
  cam1: {{model: x500, home: [25, -20, 0], camera: {{hfov: 52 deg}}}}
rules: {{mutual_visibility: {{strength: {strength}}}}}
shots:
  - {{id: s, drone: cam1, target: runner, kind: lateral, side: right, distance: 2.8, altitude: 2.7,
     timing: {{start: 15, duration: 6}}{promise}}}
"""
PROMISE = ", require: {in_frame: 100 %}"


@cache
def path(strength: str, promise: str = PROMISE) -> PathIR:
    """A walker filmed from so near that he does not fit by a hand's breadth."""
    text = NEAR.format(strength=strength, promise=promise)
    done = compile_source(text.encode(), "near.yaml", None, PlanOptions(refiner="none"))
    return next(report.output for report in done.reports if report.name == "solve-path-qp")


def off(of: ClockSubject) -> float:
    t = np.linspace(of.leg.start, of.leg.end, 101)
    ideal = ideal_places(of.mission, of.placed.shot, of.leg.start, t)
    return float(np.linalg.norm(of.leg.curve(t)[:, :3] - ideal, axis=1).max())


@pytest.mark.parametrize(("strength", "kept"), [("prefer", True), ("require", False)])
def test_a_picture_that_is_only_preferred_to_be_free_is_no_reason_to_break_a_promise(
    strength: str, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Whoever leaves the ideal place comes into somebody's picture.
    monkeypatch.setattr(
        refiner, "least_out", lambda moved: 0.05 - max(0.0, off(subject_of(moved, "s")) - 0.05)
    )
    before = subject_of(path(strength), "s")
    assert not keeps_promises(before, before.leg)
    new, told = refine_one(path(strength), "s", "ours")
    after = subject_of(new, "s")
    assert keeps_promises(after, after.leg) is kept
    assert (off(after) > 0.05) is kept
    assert not told


@pytest.mark.parametrize(("promise", "taken"), [(PROMISE, True), ("", False)])
def test_a_part_that_is_hidden_is_no_reason_to_break_a_promise(
    promise: str, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    of = subject_of(path("prefer", promise), "s")
    seen = {
        "before": SubjectVisibility(UncoveredShare(0.67, 0.66, 0.67, 0.69, 1.0), 1.0, 0.3, 0.3, 0.0),
        "after": SubjectVisibility(UncoveredShare(0.61, 0.49, 0.67, 0.65, 0.98), 0.0, 0.29, 0.3, 0.0),
    }
    legs = {name: _copy(of.leg) for name in seen}
    monkeypatch.setattr(
        shown, "visibility_of", lambda _, leg, which=0: next(seen[n] for n, one in legs.items() if one is leg)
    )
    assert as_whole(of, legs["before"], legs["after"]) is taken
    assert not as_whole(of, legs["after"], legs["before"])


def _copy(leg: ClockLeg) -> ClockLeg:
    return ClockLeg(leg.shot, leg.curve, leg.start, leg.end, leg.framing, leg.path, leg.keyframes)
