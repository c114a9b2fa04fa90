"""What written headings say about turns, before anything is solved."""

from __future__ import annotations

from math import degrees, pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.front_passes import clean

WRITTEN = st.floats(-3600.0, 3600.0).map(lambda x: round(x, 3))
MISSION = """\
shotc: 1
mission: turns
drones:
  cam1: {{model: x500, home: [0, -10, 0]}}
shots:
  - id: look
    kind: keyframes
    drone: cam1
    keyframes:
      - {{at: [0, 0, 10], heading: {0} deg, pitch: 0 deg}}
      - {{at: [10, 0, 10], heading: {1} deg, pitch: 0 deg}}
"""


def turn(first: float, second: float) -> float | None:
    """The clockwise turn that two headings state, deg."""
    found = clean(MISSION.format(first, second)).shots[0].keyframes[1].turn
    return None if found is None else -degrees(found)


@pytest.mark.slow
@given(WRITTEN, WRITTEN)
def test_turns_are_the_difference_or_free(first: float, second: float) -> None:
    found = turn(first, second)
    if abs(second) < 360:
        assert found is None
    else:
        assert found == pytest.approx(second - first, abs=1e-6)


@pytest.mark.slow
@given(WRITTEN, WRITTEN)
def test_a_stated_turn_leads_to_the_yaw(first: float, second: float) -> None:
    a, b = clean(MISSION.format(first, second)).shots[0].keyframes
    assert -pi < b.yaw <= pi
    if b.turn is not None:
        off = (a.yaw + b.turn - b.yaw + pi) % (2 * pi) - pi
        assert abs(off) < 1e-9


def test_a_first_heading_states_nothing() -> None:
    first, _ = clean(MISSION.format(725, 10)).shots[0].keyframes
    assert first.turn is None
    assert first.yaw == pytest.approx(radians(85))


def test_composition_is_counted_in() -> None:
    text = MISSION.format(0, 450).replace(
        "shots:", "targets:\n  tower: {at: [10, 40, 6], radius: 2, height: 12}\nshots:"
    )
    text = text.replace("heading: 0 deg, pitch: 0 deg", "look_at: tower, frame: left-third")
    before, after = clean(text).shots[0].keyframes
    # A turn and a quarter from North, less what the camera looks away from North before.
    assert after.turn is not None
    assert -degrees(after.turn) == pytest.approx(450.0 - degrees(pi / 2 - before.yaw) % 360)
