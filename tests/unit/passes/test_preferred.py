"""A preference to keep out of pictures crops nobody, and moves a camera only so far."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.passes.timed_route import position

FAR = """\
shotc: 1
mission: far
targets: {yacht: {track: {start: [-80, 0, 8.85], velocity: [2.2, 0, 0]}, radius: 7.25, height: 17.7}}
drones:
  near: {model: pro, camera: {hfov: 105 deg, aspect: "1:1"}, priority: 1, home: [-14, -24, 0]}
  tele: {model: x500, camera: {hfov: 23 deg}, priority: 2, home: [0, 110, 0]}
rules: {separation: 6, mutual_visibility: {strength: prefer}}
shots:
  - {id: behind, kind: chase, drone: near, target: yacht, distance: 14.7, altitude: 15.8,
     timing: {start: 37, duration: 9}}
  - {id: side, kind: lateral, drone: tele, target: yacht, side: left, distance: 125, altitude: 11.3,
     timing: {start: 36, duration: 5}}
"""


def planned() -> Compilation:
    return compile_source(FAR.encode(), "m.yaml", None, PlanOptions(refiner="none"))


def moved(done: Compilation) -> float:
    """Return how far the long lens is from its place, 125 m left of the yacht, metres."""
    assert done.plan is not None
    track = next(t for t in done.plan.trajectory.drones if t.drone == "tele")
    times = np.linspace(36.0, 41.0, 51)
    place = np.column_stack([2.2 * times - 80, np.full(51, 125.0), np.full(51, 11.3)])
    return float(np.linalg.norm(track.curve(times)[:, :3] - place, axis=1).max())


def whole(done: Compilation) -> float:
    assert done.plan is not None
    return min(c.worst for c in done.plan.certificate if c.constraint == "yacht in frame")


def test_a_preference_crops_nobody_and_tells_who_is_seen() -> None:
    done = planned()
    assert whole(done) == 1.0
    assert moved(done) < 62.5
    assert "V033" in {d.code for d in done.diagnostics}


def test_without_its_rule_it_would(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(position, "costs_little", lambda *_: True)
    assert whole(planned()) < 0.9
