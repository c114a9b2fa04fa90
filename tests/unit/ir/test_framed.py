"""The course of a framing as a function of the mission, the shot and the start."""

from __future__ import annotations

from shotc.ir.framed import course_of
from shotc.ir.mission import MissionIR
from tests.support.front_passes import clean


def mission(north: float = 0.0) -> MissionIR:
    text = f"""\
shotc: 1
mission: again
targets: {{walker: {{radius: 0.3, height: 1.8, track: {{start: [0, {north}, 3], velocity: [1, 0, 0]}}}}}}
drones: {{cam: {{model: x500, camera: {{hfov: 40 deg, aspect: "16:9"}}, home: [0, 30, 0]}}}}
shots:
  - id: a
    kind: framing
    drone: cam
    subjects: [{{target: walker, view: {{azimuth: 0 deg}}}}]
    timing: {{start: 60, duration: 4}}
"""
    return clean(text).mission


def test_the_course_for_one_start_is_computed_once() -> None:
    """Planning, refinement and verification ask for it, and it takes up to 0.1 s."""
    one = mission()
    assert course_of(one, one.shots[0], 60.0) is course_of(one, one.shots[0], 60.0)


def test_a_course_belongs_to_its_mission_its_shot_and_its_start() -> None:
    here, there = mission(), mission(north=7.0)
    first = course_of(here, here.shots[0], 60.0)
    for other in (
        course_of(there, there.shots[0], 60.0),
        course_of(here, here.shots[0], 62.0),
        course_of(here, here.shots[0]._replace(timing=here.shots[0].timing._replace(duration=8.0)), 60.0),
    ):
        assert other.times != first.times or other.poses != first.poses
