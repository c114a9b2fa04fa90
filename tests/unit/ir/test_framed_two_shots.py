"""Two subjects side by side without sizes or places: how the course of their framing shows them."""

from __future__ import annotations

import pytest

from shotc.geom.viewpoint import SubjectAppearance, judged, whole
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.framed_scene import lens_of, required_view_at
from tests.support.front_passes import clean

START_S = 15.0


def first_frame(composition: str) -> tuple[StartedFraming, list[SubjectAppearance]]:
    """Return the course of two walkers, 2 m beside each other, and how they appear in its first frame."""
    text = f"""\
shotc: 1
mission: two
targets:
  left: {{track: {{start: [0, 0, 0.9], velocity: [0, 2, 0]}}, radius: 0.4, height: 1.8}}
  right: {{track: {{start: [2, 0, 0.9], velocity: [0, 2, 0]}}, radius: 0.4, height: 1.8}}
drones: {{cam: {{model: mavic-3-pro, home: [-15, -20, 0]}}}}
shots:
  - {{id: pair, kind: framing, drone: cam, composition: {composition}, timing: {{duration: 8, start: 15}},
     subjects: [{{target: left}}, {{target: right}}]}}
"""
    mission = clean(text).mission
    course = course_of(mission, mission.shots[0], START_S)
    views = [required_view_at(mission, s, START_S, START_S) for s in course.shot.subjects]
    lens = lens_of(mission.drone("cam"))
    assert all(whole(course.poses[0], lens, view) for view in views)
    seen = [judged(course.poses[0], lens, view) for view in views]
    return course, [s for s in seen if s is not None]


@pytest.mark.slow
def test_two_who_walk_side_by_side_take_two_places_of_one_height() -> None:
    """It was the middle and a corner, from a camera nearly in the line of both, 30 deg above them."""
    course, seen = first_frame("thirds")
    (left,), (right,) = (s.composition.points for s in course.shot.subjects)
    assert left == pytest.approx((-right[0], right[1]))
    assert left[0] < 0.0
    assert [s.screen for s in seen] == pytest.approx([0.0, 0.0], abs=0.02)
    assert seen[0].size == pytest.approx(seen[1].size, rel=0.02)


@pytest.mark.slow
def test_two_without_places_stand_beside_each_other_in_the_default_size() -> None:
    """Each by itself was drawn to the middle of the picture, so one stood behind the other."""
    course, seen = first_frame("keep")
    assert course.hidden == 0.0
    assert [s.size for s in seen] == pytest.approx([0.4, 0.4], rel=0.1)
    assert seen[0].size == pytest.approx(seen[1].size, rel=0.02)
