"""Drones that wait for each other in turn: each films after a shot of the other one."""

from __future__ import annotations

import pytest

from tests.support.compiled import compiled_text

RELAY = """\
shotc: 1
mission: relay
targets: {villa: {at: [0, 0, 4], radius: 5, height: 8}}
drones:
  a: {model: pro, home: [45, -35, 0]}
  b: {model: pro, home: [-45, -35, 0]}
shots:
  - {id: one, kind: static, drone: a, at: [25, -30, 10], look_at: villa, timing: {start: 12, duration: 4}}
  - {id: two, kind: static, drone: b, at: [-25, -30, 10], look_at: villa, timing: {after: one, duration: 4}}
  - {id: three, kind: static, drone: a, at: [25, -20, 14], look_at: villa, timing: {after: two, duration: 4}}
  - {id: four, kind: static, drone: b, at: [-30, 0, 9], look_at: villa, timing: {after: three, duration: 4}}
"""


@pytest.mark.long
def test_drones_that_hand_over_in_turn_film_one_after_the_other() -> None:
    """The first drone was planned without the ends of the other one's shots (T003 of a shot `None`)."""
    done = compiled_text(RELAY, "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    filmed = {p.shot: p for t in done.plan.trajectory.drones for p in t.phases if p.shot}
    assert sorted(filmed) == ["four", "one", "three", "two"]
    for before, after in (("one", "two"), ("two", "three"), ("three", "four")):
        assert filmed[after].start >= filmed[before].end - 1e-6
