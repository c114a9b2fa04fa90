"""What is said of a shot of a moving target that leaves its place."""

from __future__ import annotations

import pytest

from shotc.ir.path import LIMITS, ClockDeviation
from shotc.passes.solve_path_qp.explain.on_clock import left_places
from tests.support.front_passes import placed

MISSION = """\
shotc: 1
mission: bend
targets:
  car: {track: {points: [[0, 0, 0.8], [90, 0, 0.8], [120, 60, 0.8]], speed: 7 m/s}, size: [4.5, 1.8, 1.5]}
drones: {cam: {model: pro, home: [30, -30, 0]}}
shots:
  - {id: film, drone: cam, target: car, timing: {start: 10, duration: 8}, KIND}
"""


@pytest.mark.parametrize(
    ("kind", "first"),
    [
        ("kind: lateral, side: left, distance: 16, altitude: 5", "film it from nearer"),
        ("kind: chase, distance: 16, altitude: 5", "film it from nearer"),
        ("kind: flyby, behind: 20, ahead: 20, offset: 12, altitude: 5", "give the shot more time"),
    ],
)
def test_more_time_is_proposed_only_where_it_makes_the_shot_slower(kind: str, first: str) -> None:
    """A lateral of a car was told to take more time, which changes nothing of its pace."""
    keyed, told = placed(MISSION.replace("KIND", kind).encode())
    assert keyed is not None, told
    (said,) = left_places(keyed.mission, [ClockDeviation("film", 4.46, 15.0, LIMITS)])
    assert said.help == f"{first}, or give the drone higher `limits`"
