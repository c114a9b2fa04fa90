"""Framings whose nearest place hides a subject, or has no room: places elsewhere are tried, as far as the
mission leaves them free."""

from __future__ import annotations

from math import degrees

import numpy as np
import pytest

from shotc.geom.viewpoint import judged
from shotc.ir.coverage import coverage
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.framed_scene import lens_of, required_view_at
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.passes.verify.hidden import nowhere_seen
from tests.support.compiled import compiled_text
from tests.support.front_passes import placed

START = 60.0
COURT = """\
    n: {keep: out, box: {center: [0, 5, 3], size: [12, 1, 6]}}
    s: {keep: out, box: {center: [0, -5, 3], size: [12, 1, 6]}}
    e: {keep: out, box: {center: [5, 0, 3], size: [1, 12, 6]}}
    w: {keep: out, box: {center: [-5, 0, 3], size: [1, 12, 6]}}
"""
ALONE = """\
shotc: 1
mission: court
world:
  zones:
{zones}
targets: {{statue: {{at: [0, 0, 1], radius: 0.4, height: 2}}}}
drones: {{cam: {{model: x500, camera: {{hfov: 40 deg, aspect: "16:9"}}, home: [0, -25, 0]}}}}
rules: {{composition: center, target_clearance: 0.5}}
shots:
  - {{id: a, kind: framing, drone: cam, subjects: [{{target: statue{asked}}}],
     {allow}timing: {{start: 60, duration: 4}}}}
"""
SEVERAL = """\
shotc: 1
mission: behind
targets:
  person: {{at: [0, 0, 0.94], radius: 0.4, height: 1.88}}
  friend: {{at: [2.03, 3.12, 0.88], radius: 0.44, height: 1.76}}
  statue: {{at: [-2.97, 0, 1.5], radius: 1.01, height: 3}}
drones: {{cam: {{model: x500, camera: {{hfov: 35 deg, aspect: "1:1"}}, home: [11.4, 16, 0]}}}}
rules: {{composition: center, target_clearance: 2}}
shots:
  - id: a
    kind: framing
    drone: cam
    subjects:
      - {{target: person, frame: [-0.15, -0.05], size: 0.23}}
      - {{target: friend, frame: [-0.45, -0.15]}}
      - {{target: statue{asked}}}
    timing: {{start: 60, duration: 10}}
"""


def court(asked: str = "", zones: str = COURT, allow: str = "") -> MissionIR:
    return mission_of(ALONE.format(asked=asked, zones=zones, allow=allow))


def mission_of(text: str) -> MissionIR:
    keyframes, faults = placed(text)
    assert keyframes is not None, faults
    return keyframes.mission


def course(mission: MissionIR) -> StartedFraming:
    return course_of(mission, mission.shots[0], START)


def most_hidden(mission: MissionIR) -> float:
    """Return the largest share of a subject's exact outline that is hidden anywhere on the course."""
    at = course(mission)
    eyes, t = np.array(at.poses)[:, :3], np.array(at.times)
    return max(float(coverage(mission, (), s.target, eyes, t).share.max()) for s in mission.shots[0].subjects)


def size_and_elevation(mission: MissionIR) -> tuple[float, float]:
    """Return the size of the subject, and the camera's elevation over it, degrees."""
    (pose, *_), shot = course(mission).poses, mission.shots[0]
    view = required_view_at(mission, shot.subjects[0], START, START)
    seen = judged(pose, lens_of(mission.drone("cam")), view)
    assert seen is not None
    return seen.size, degrees(np.arctan2(pose[2] - 1.0, np.hypot(pose[0], pose[1])))


@pytest.mark.slow
@pytest.mark.parametrize("view", ["", ", view: {azimuth: 90 deg}"])
def test_a_camera_looks_over_walls_on_all_sides(view: str) -> None:
    """From the size that is asked for, no bearing shows the statue unless the camera is higher."""
    mission = court(f", size: 0.3{view}")
    assert most_hidden(mission) < 0.5
    size, elevation = size_and_elevation(mission)
    assert size == pytest.approx(0.3, abs=1e-3)
    assert 20.0 <= elevation <= 60.0


@pytest.mark.long
def test_a_camera_of_free_size_steps_into_the_court() -> None:
    mission = court()
    assert most_hidden(mission) == 0.0
    assert np.abs(np.array(course(mission).poses)[:, :2]).max() < 4.5


def test_a_camera_does_not_look_up_where_its_elevation_is_given() -> None:
    mission = court(", size: 0.3, view: {elevation: 12 deg}")
    assert size_and_elevation(mission)[1] == pytest.approx(12.0, abs=0.1)
    assert course(mission).lost == 1.0


@pytest.mark.slow
def test_a_camera_stays_level_where_its_subject_may_be_hidden() -> None:
    usual = size_and_elevation(
        court(", size: 0.3", "    far: {keep: out, box: {center: [90, 90, 3], size: [1, 1, 6]}}")
    )
    assert size_and_elevation(court(", size: 0.3", allow="allow: [hidden-subject], ")) == pytest.approx(usual)


@pytest.mark.slow
def test_several_subjects_appear_less_exactly_where_the_best_place_hides_one() -> None:
    """Both places of least cost stand behind the statue, or have the friend before the person."""
    assert most_hidden(mission_of(SEVERAL.format(asked=""))) < 0.5


@pytest.mark.long
def test_several_subjects_are_filmed_from_where_the_camera_has_room() -> None:
    """A zone stands where they appear best; nothing else hides anybody."""
    plain = SEVERAL.format(asked="").replace("at: [-2.97, 0, 1.5]", "at: [-2.97, 6, 1.5]")
    (x, y, *_), *_ = course(mission_of(plain)).poses
    zone = f"world: {{zones: {{hall: {{keep: out, box: {{center: [{x}, {y}, 4], size: [6, 6, 8]}}}}}}}}\n"
    beside = course(mission_of(plain.replace("targets:", f"{zone}targets:")))
    assert (beside.blocked, beside.lost) == (0.0, 0.0)


@pytest.mark.long
def test_several_subjects_stay_hidden_where_no_place_shows_one() -> None:
    """The person stands in a shaft that is too narrow for a drone, and too deep to look into."""
    walls = COURT.replace("3]", "100]").replace(" 6]", " 200]").replace("5,", "2,").replace(" 5,", " 2,")
    text = SEVERAL.format(asked="").replace("targets:", f"world:\n  zones:\n{walls}targets:")
    mission = mission_of(text)
    assert course(mission).lost == 1.0
    (note,) = nowhere_seen(mission, Phase("shot", "a", START, START + 10.0))
    assert note.endswith("were tried: none shows all subjects")


@pytest.mark.long
def test_v050_says_that_places_all_round_were_tried() -> None:
    text = ALONE.format(asked=", size: 0.3, view: {elevation: 12 deg}", zones=COURT, allow="")
    (hidden,) = (d for d in compiled_text(text, "none", "m.yaml").diagnostics if d.code == "V050")
    assert hidden.notes[-1].endswith("were tried: none shows it")
