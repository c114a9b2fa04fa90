"""Drones leave the places free where others, planned later, film at fixed times."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: same-place
targets: {{tower: {{at: [0, 0, 6], radius: 2, height: 12}}}}
drones:
  cam1: {{model: x500, home: [-20, -40, 0], priority: 1}}
  cam2: {{model: x500, home: [20, -40, 0], priority: 2}}
rules: {{composition: center, separation: 6, mutual_visibility: {{strength: "off"}}}}
shots:
  - {{id: a1, kind: static, drone: cam1, at: [0, -25, 8], look_at: tower, timing: {{start: 20, duration: 5}}}}
  - {{id: b1, kind: static, drone: cam2, at: [1, -25, 8], look_at: tower,
     timing: {{start: {start}, duration: 5}}}}
  - {{id: a2, kind: static, drone: cam1, at: [-25, 0, 8], look_at: tower, timing: {{start: 80, duration: 5}}}}
"""
FIRST, SECOND = np.array([0.0, -25.0, 8.0]), np.array([1.0, -25.0, 8.0])


@pytest.mark.slow
@pytest.mark.parametrize("start", [40.0, 60.0])
def test_a_drone_does_not_wait_where_another_films_meanwhile(start: float) -> None:
    """The first has time until its next shot, and would leave its place as late as it can."""
    done = compiled_text(MISSION.format(start=start), "none")
    assert done.plan is not None, done.diagnostics
    one, other = (track.curve for track in done.plan.trajectory.drones)
    film = np.linspace(start, start + 5.0, 51)
    assert np.linalg.norm(other(film)[:, :3] - SECOND, axis=1).max() < 1e-6
    assert np.linalg.norm(one(film)[:, :3] - SECOND, axis=1).min() >= 6.0


@pytest.mark.slow
def test_a_drone_that_is_in_nobodys_way_waits_where_it_filmed() -> None:
    done = compiled_text(MISSION.format(start=60.0).replace("at: [1, -25, 8]", "at: [20, -15, 8]"), "none")
    assert done.plan is not None, done.diagnostics
    one = done.plan.trajectory.drones[0].curve
    assert np.linalg.norm(one(np.linspace(25.0, 65.0, 41))[:, :3] - FIRST, axis=1).max() < 1e-6
