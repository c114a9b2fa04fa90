"""Wind of a known direction, as `check` reckons with it: what it carries, and what has to fly against it."""

from __future__ import annotations

import re

import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic

CHASE = """\
shotc: 1
mission: windy
world: {wind: {speed: 4 m/s, from: FROM deg}}
targets: {runner: {track: {start: [0, 0, 0.9], velocity: [6, 0, 0]}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [-10, -10, 0]}}
shots:
  - {id: after, kind: chase, drone: cam, target: runner, distance: 8, altitude: 4,
     timing: {start: 40, duration: 3}}
"""

LINE = """\
shotc: 1
mission: windy
world: {wind: {speed: 6 m/s, from: FROM deg}}
drones: {cam: {model: x500, home: [0, -60, 0]}}
shots:
  - id: way
    kind: keyframes
    drone: cam
    timing: {duration: 15}
    keyframes:
      - {at: [0, 0, 10], heading: 0 deg, pitch: 0 deg}
      - {at: [60, 0, 10], heading: 0 deg, pitch: 0 deg}
"""


def faults(text: str, bearing: int) -> list[Diagnostic]:
    return list(check_source(text.replace("FROM", str(bearing)).encode(), "windy.yaml", None).diagnostics)


def test_a_target_is_kept_up_with_through_the_air() -> None:
    (against,) = faults(CHASE, 90)
    assert against.code == "M005"
    assert "10.0 m/s through the air" in against.notes[0]
    assert (3, "the wind") in [(label.span.line, label.text) for label in against.labels]
    assert faults(CHASE, 270) == []
    assert faults(CHASE.replace("velocity: [6", "velocity: [11"), 270) == []
    assert [f.code for f in faults(CHASE.replace("velocity: [6", "velocity: [12.5"), 270)] == ["M005"]


def test_a_way_against_the_wind_takes_longer_than_one_with_it() -> None:
    assert faults(LINE, 270) == []
    (against,) = faults(LINE, 90)
    assert against.code == "K004"
    assert "at least 30.0 s" in against.notes[0]  # 60 m at 8 - 6 m/s


def test_less_wind_that_is_proposed_is_enough() -> None:
    (against,) = faults(LINE, 90)
    calm = re.search(r"wind below ([0-9.]+) m/s", against.help or "")
    assert calm is not None
    assert faults(LINE.replace("speed: 6", f"speed: {calm[1]}"), 90) == []


@pytest.mark.parametrize("bearing", [0, 90, 222])
def test_a_wind_as_fast_as_the_drone_leaves_it_no_speed_wherever_it_comes_from(bearing: int) -> None:
    first, *_ = faults(LINE.replace("speed: 6", "speed: 7.95"), bearing)
    assert first.code == "K011"
