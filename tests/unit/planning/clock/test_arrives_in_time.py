"""A shot with a start is reached in time, whatever comes near to its drone in the shot."""

from __future__ import annotations

import pytest

from tests.support.compiled import compiled_text

TWO_ORBITS = """\
shotc: 1
mission: two-orbits
targets: {tower: {at: [0, 0, 6], radius: 2, height: 12}}
drones: {cam1: {model: x500, home: [0, -60, 0]}, cam2: {model: x500, home: [20, -60, 0]}}
rules: {mutual_visibility: {strength: off}, separation: 5}
shots:
  - {id: one, kind: orbit, drone: cam1, target: tower, radius: 25, altitude: 8, sweep: 180 deg,
     timing: {start: 25, duration: 20}}
  - {id: two, kind: orbit, drone: cam2, target: tower, radius: 32, altitude: 10, sweep: -180 deg,
     timing: {start: 25, duration: 20}}
"""


@pytest.mark.long
def test_a_late_detour_is_no_answer_to_who_passes_the_end_of_the_shot() -> None:
    """The first drone leaves at 45 s through where the second one stops; the second one leaves then, too."""
    done = compiled_text(TWO_ORBITS, "none")
    assert done.plan is not None, done.diagnostics
    starts = {p.shot: p.start for d in done.plan.trajectory.drones for p in d.phases if p.shot}
    assert starts == {"one": pytest.approx(25.0), "two": pytest.approx(25.0)}
