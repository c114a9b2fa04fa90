"""A drone that films from ahead of its subjects gets out of their way when the film is over."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: stops-ahead
targets:
  first:
    track:
      points: [[-63, 48, 0.9], [-31, 34, 0.9], [0, 0, 0.9], [35, -24, 0.9], [63, -51, 0.9], [99, -85, 0.9]]
      speed: 3.6 m/s
    radius: 0.45
    height: 1.86
  second:
    track:
      points: [[-63, 45, 0.8], [-31, 31, 0.8], [0, -3, 0.8], [35, -27, 0.8], [63, -54, 0.8], [99, -88, 0.8]]
      speed: 3.6 m/s
    radius: 0.49
    height: 1.62
drones: {cam: {model: pro, camera: {hfov: 106 deg}, home: [-8.3, -6.9, 0]}}
rules: {composition: thirds-lines, ground_clearance: 1, target_clearance: 1}
shots:
  - {id: a, kind: framing, drone: cam, timing: {start: 25, duration: 6},
     subjects: [{target: first, frame: [0.2, 0.05]}, {target: second, frame: [-0.25, -0.05]}]}
"""


@pytest.mark.slow
@pytest.mark.long
def test_a_drone_ahead_of_its_subjects_leads_aside_after_the_film() -> None:
    """It stops within two seconds, and they come to where it stands in one more."""
    done = compiled_text(MISSION, "none")
    assert done.plan is not None, done.diagnostics
    flown, mission = done.plan.trajectory.drones[0].curve, done.plan.trajectory.keyframes.mission
    times = np.linspace(31.0, 41.0, 101)
    for target in mission.targets:
        away = np.linalg.norm(flown(times)[:, :2] - np.array([target.at(t)[:2] for t in times]), axis=1)
        assert away.min() > target.radius + 1.0
