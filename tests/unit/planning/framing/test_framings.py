"""Framings: where their cameras go, what is told of them, and what of it is flown."""

from __future__ import annotations

import re
from math import atan2, degrees, hypot

import numpy as np
import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.viewpoint import viewpoint
from shotc.ir.framed import at_start, course_of
from shotc.ir.hidden import hides
from shotc.ir.ideal import ideal_place
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.sampling import seen
from shotc.planfile.read import read_plan
from shotc.planfile.write import plan_bytes
from shotc.spec.presets import PRESETS
from tests.support.compiled import compiled_text
from tests.support.few import few
from tests.support.framing_missions import claim, planned, text
from tests.support.front_passes import clean, placed
from tests.support.remedies.apply import remedies

pytestmark = pytest.mark.slow


def told(mission: str) -> list[Diagnostic]:
    return placed(mission)[1]


def only(mission: str, code: str) -> Diagnostic:
    found = told(mission)
    assert [d.code for d in found] == [code], found
    return found[0]


def underlined(mission: str, diagnostic: Diagnostic) -> str:
    span = diagnostic.labels[0].span
    return mission.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1]


def bearing_of(ir: KeyframeIR, t: float = 15.0) -> tuple[float, float]:
    """Compass bearing and elevation of the ideal camera from the first subject, deg."""
    shot = ir.mission.shots[0]
    centre = ir.mission.target(shot.subjects[0].target).at(t)
    x, y, z = np.subtract(ideal_place(ir.mission, shot, 15.0, t), centre)
    return degrees(atan2(x, y)) % 360, degrees(atan2(z, hypot(x, y)))


@pytest.mark.long
@pytest.mark.parametrize("target", ["runner", "tower"])
def test_one_subject_is_seen_as_asked_at_every_frame_whether_it_moves_or_stands(target: str) -> None:
    size, view = 0.4, "view: {azimuth: 150 deg, elevation: 20 deg}"
    mission = text(f"target: {target}, frame: [-0.3, 0.1], size: {size}, {view}")
    mission = mission.replace("start: 15", "start: 19").replace("[60, ", "[90, ")
    ir = clean(mission)
    for t in (19.0, 23.0, 27.0):
        azimuth, elevation = bearing_of(ir, t)
        assert (azimuth, elevation) == pytest.approx((150.0, 20.0), abs=1e-6)
    plan = planned(mission)
    track = plan.trajectory.drones[0]
    frames = seen(plan.trajectory.keyframes.mission, track, target, np.linspace(19.0, 27.0, 60))
    assert np.abs(frames.size - size).max() < 2e-3
    assert np.abs(frames.u + 0.3).max() < 5e-3
    assert np.abs(frames.v - 0.1).max() < 5e-3


def test_a_free_bearing_is_the_one_from_which_the_drone_comes() -> None:
    ir = clean(text("target: runner, size: 0.3"))
    azimuth, elevation = bearing_of(ir)
    x, y, _ = ir.mission.target("runner").at(15.0)
    assert azimuth == pytest.approx(degrees(atan2(45 - x, -20 - y)) % 360, abs=1e-6)
    assert elevation > 0
    assert ideal_place(ir.mission, ir.mission.shots[0], 15.0, 15.0)[2] == pytest.approx(2.7, abs=1e-3)


def test_a_free_bearing_goes_round_what_hides_the_subject() -> None:
    wall = "world: {zones: {wall: {keep: out, box: {center: [52, -6, 3], size: [26, 2, 6]}}}}\n"
    plain, walled = (clean(text("target: runner, size: 0.15", world=w)) for w in ("", wall))
    mission = walled.mission

    def hidden(ir: KeyframeIR) -> bool:
        shot = ir.mission.shots[0]
        return any(
            hides(mission, "runner", ideal_place(mission, shot, 15.0, t), t) for t in np.linspace(15, 23, 30)
        )

    assert hidden(plain)
    assert not hidden(walled)
    assert claim(planned(text("target: runner, size: 0.15", world=wall)), "runner visible") == 1.0


def test_two_subjects_are_seen_from_where_a_wall_does_not_hide_them() -> None:
    wall = "world: {zones: {wall: {keep: out, box: {center: [55, -5, 5], size: [40, 1, 10]}}}}\n"
    pair = ("target: runner, frame: [-0.27, 0]", "target: rider, frame: [0.27, 0]")
    plain, walled = (placed(text(*pair, world=w))[0] for w in ("", wall))
    assert plain is not None
    assert walled is not None
    course = course_of(walled.mission, walled.mission.shots[0], 15.0)
    assert course.hidden == 0.0
    assert course.blocked == 0.0
    assert course_of(walled.mission, plain.mission.shots[0], 15.0).poses == course.poses
    for t, pose in zip(course.times, course.poses, strict=True):
        assert all(hides(walled.mission, name, pose[:3], t) is None for name in ("runner", "rider"))


def test_what_a_course_has_found_is_not_searched_again() -> None:
    ir, _ = placed(text("target: runner, frame: [-0.27, 0]", "target: rider, frame: [0.27, 0]"))
    assert ir is not None
    first = course_of(ir.mission, ir.mission.shots[0], 15.0)
    searched = viewpoint.cache_info().misses
    assert course_of(ir.mission, ir.mission.shots[0], 15.0) == first
    assert viewpoint.cache_info().misses == searched


def test_silence_on_screen_is_the_middle_of_the_composition_or_where_it_is_whole() -> None:
    ir = clean(text("target: runner, size: 0.3"))
    assert ir.shots[0].subjects[0].reference == (0.0, 0.0)
    ir = clean(text("target: runner, size: 0.3, frame: left-third"))
    assert ir.shots[0].subjects[0].reference == pytest.approx((-1 / 3, 0.0))


def test_a_subject_larger_than_the_frame_keeps_its_place_without_being_whole() -> None:
    plan = planned(text("target: tower, size: medium-full, frame: lower-third, view: {azimuth: 180 deg}"))
    assert claim(plan, "tower size smallest") == pytest.approx(1.4, abs=0.01)
    assert claim(plan, "tower screen error") < 5e-3
    assert "M007" not in [d.code for d in told(text("target: tower, size: medium-full"))]


def test_a_place_at_which_a_subject_is_cropped_is_kept_and_told() -> None:
    mission = text("target: tower, size: 0.9, frame: [0.0, 0.6]")
    assert only(mission, "M007").notes[0].endswith("cropped as it is")
    ir, _ = placed(mission)
    assert ir is not None
    assert ir.shots[0].subjects[0].reference == (0.0, 0.6)


def test_two_subjects_are_at_their_places_whole_and_proved() -> None:
    plan = planned(
        text(
            "target: runner, frame: [-0.27, 0], size: 0.3",
            "target: rider, frame: [0.27, 0]",
            require="require: {in_frame: 100 %, screen_error: 0.05}, ",
        )
    )
    for name in ("runner", "rider"):
        assert claim(plan, f"{name} in frame") == 1.0
        assert claim(plan, f"{name} screen error") < 0.05
    assert claim(plan, "runner size smallest") == pytest.approx(0.3, abs=0.03)
    assert claim(plan, "distance from its place") < 1.0


def test_several_silent_subjects_have_each_place_of_the_composition_once() -> None:
    ir = clean(text("target: runner", "target: rider, size: 0.2"))
    references = [s.reference for s in ir.shots[0].subjects]
    assert None not in references
    assert len(set(references)) == 2
    ir, _ = placed(text("target: runner, frame: center", "target: rider, frame: center"))
    assert ir is None or [s.reference for s in ir.shots[0].subjects] == [(0.0, 0.0)] * 2


def test_more_than_can_be_had_is_a_compromise_told_with_numbers() -> None:
    mission = text(
        "target: runner, frame: [-0.27, 0], size: 0.3, view: {azimuth: 270 deg}",
        "target: rider, frame: [0.27, 0]",
    )
    found = only(mission, "M034")
    assert underlined(mission, found) == "runner"
    assert any("of half a frame from (-0.27, 0.00)" in note or "off its view" in note for note in found.notes)


def test_a_promise_holds_a_compromise() -> None:
    mission = text(
        "target: runner, frame: [-0.27, 0], size: 0.3, view: {azimuth: 270 deg}",
        "target: rider, frame: [0.27, 0]",
        require="require: {screen_error: 0.02}, ",
    )
    done = compiled_text(mission, "none", "m.yaml")
    assert done.plan is None
    assert "V020" in [d.code for d in done.diagnostics]


def test_a_shot_without_a_start_is_framed_for_the_time_at_which_it_begins() -> None:
    mission = text("target: runner, frame: [-0.3, 0], size: 0.1", "target: tower, frame: [0.3, 0.2]")
    plan = planned(mission.replace("start: 15, ", ""))
    ir = plan.trajectory.keyframes
    phase = next(p for p in plan.trajectory.drones[0].phases if p.shot == "s")
    begun = at_start(ir.mission, ir.shots[0].shot, phase.start)
    assert begun.ideal != ir.shots[0].shot.ideal
    assert claim(plan, "distance from its place") < 0.5
    again = read_plan(plan_bytes(plan), "plan.json").trajectory
    assert again is not None
    kept = again.keyframes
    assert at_start(kept.mission, kept.shots[0].shot, phase.start).ideal == begun.ideal


def test_a_course_is_as_fast_as_its_drone_at_most_and_smooth() -> None:
    subjects = ("target: runner, frame: [-0.3, 0]", "target: rider, frame: [0.3, 0]")
    mission = text(*subjects).replace(
        "[[0, 3, 1], [60, 3, 1], [90, 33, 1]], speed: 3", "[[90, 3, 1], [0, 3, 1]], speed: 3"
    )
    ir, _ = placed(mission)
    assert ir is not None
    course = course_of(ir.mission, ir.mission.shots[0], 15.0)
    eyes = np.array([p[:3] for p in course.poses])
    speeds = np.linalg.norm(np.diff(eyes, axis=0), axis=1) / np.diff(course.times)
    assert speeds.max() <= 0.81 * 8.0


@pytest.mark.long
@pytest.mark.parametrize(
    ("subjects", "code", "where"),
    [
        (("target: runner", "target: runner"), "M030", "runner"),
        (("target: runner, size: close-up",), "M031", "close-up"),
        (("target: runner, size: 0.3, view: {elevation: -20 deg}",), "M032", "-20 deg"),
        (("target: nobody",), "N001", "nobody"),
    ],
)
def test_what_no_camera_can_have_is_told_at_its_line(
    subjects: tuple[str, ...], code: str, where: str
) -> None:
    mission = text(*subjects)
    assert underlined(mission, only(mission, code)) == where


@pytest.mark.long
@pytest.mark.parametrize("rules", ["", "rules: {target_clearance: 3}\n"])
@pytest.mark.parametrize(
    "view",
    few(["", ", view: {elevation: 0 deg}", ", view: {azimuth: 30 deg}"], [", view: {elevation: 0 deg}"]),
)
@pytest.mark.parametrize("size", few(["close-up", "1", "0.7"], ["close-up", "0.7"]))
def test_what_lets_a_framing_be_had_does_when_it_is_written(rules: str, view: str, size: str) -> None:
    """Each remedy of M031 and M032 is written in: no error is left, whatever else the first one hid."""
    mission = text(f"target: runner, size: {size}{view}").replace("shots:", f"{rules}shots:")
    for fault in told(mission):
        for remedy in remedies(mission, fault) if fault.code in ("M031", "M032") else ():
            assert any(not has_errors(told(corrected)) for corrected in remedy.missions), remedy.text


@pytest.mark.long
def test_subjects_too_far_apart_for_their_sizes_are_told_with_the_size_there_is() -> None:
    mission = text("target: runner, size: 0.3", "target: rider, size: 0.4").replace(
        "[60, 3, 1]", "[60, 80, 1]"
    )
    found = only(mission.replace("[0, 3, 1]", "[0, 80, 1]"), "M033")
    asked, there = (float(word) for word in (found.message.split()[3], found.notes[0].split()[8]))
    assert there < asked / 2
    assert found.help.startswith(f"ask for {there:.3g} or less")


def test_what_depends_on_a_start_that_is_not_known_is_no_error_yet() -> None:
    mission = text("target: runner, size: 0.3", "target: rider, size: 0.4")
    mission = mission.replace("[60, 3, 1]", "[60, 80, 1]").replace("[0, 3, 1]", "[0, 80, 1]")
    found = only(mission.replace("start: 15, ", ""), "M034")
    assert found.notes[-1].startswith("this assumes that the shot begins at 0.0 s")


def test_a_framing_says_how_long_it_lasts() -> None:
    mission = text("target: tower").replace(", duration: 8", "")
    found = only(mission, "M003")
    assert found.message.startswith("how long does this framing last")
    assert found.help == "add `duration: ...` to `timing`"
    assert underlined(mission, found) == "{start: 15}"
    assert told(mission.replace("{start: 15}", "{start: 15, duration: 8}")) == []
    automatic = only(mission.replace("{start: 15}", "auto"), "M003")
    assert automatic.help == "write `timing: {duration: ...}`"
    assert only(mission.replace("timing: {start: 15}, ", ""), "M003").help == "add `timing: {duration: ...}`"


def test_a_view_into_a_zone_is_told_and_a_free_one_goes_beside_it() -> None:
    world = "world: {zones: {hall: {keep: out, box: {center: [30, 10, 10], size: [20, 40, 20]}}}}\n"
    mission = text("target: tower, size: 0.6, view: {azimuth: 180 deg, elevation: 0 deg}", world=world)
    found = only(mission, "M032")
    assert underlined(mission, found) == "180 deg"
    assert "hall" in found.notes[0]
    free = told(text("target: tower, size: 0.6", world=world))
    assert [d.code for d in free] == ["G023"] * 2  # who walks comes into the hall


@pytest.mark.parametrize(
    ("zone", "surface"),
    [
        ("{keep: out, box: {center: [30, 10, 50], size: [100, 40, 200]}}", 30.0),
        ("{keep: in, box: {center: [30, 40, 50], size: [100, 40, 100]}}", 20.0),
    ],
)
def test_what_a_place_lacks_counts_from_the_drones_side_of_a_zone(zone: str, surface: float) -> None:
    """The camera is deep inside a zone to keep out of, or far outside of one to stay in."""
    world = f"world: {{zones: {{hall: {zone}}}}}\n"
    mission = text("target: tower, size: 0.8, view: {azimuth: 180 deg, elevation: 0 deg}", world=world)
    (fault,) = (d for d in told(mission) if d.code == "M032")
    numbers = re.search(r"at \[30\.0, ([\d.]+), 12\.0\], where zone `hall` lacks ([\d.]+) m", fault.notes[0])
    assert numbers is not None
    place, lack = map(float, numbers.groups())
    assert lack == pytest.approx(PRESETS["x500"].radius + abs(place - surface), abs=0.06)


def test_a_view_that_the_gimbal_does_not_reach_is_told() -> None:
    mission = text("target: tower, size: 0.8, frame: center, view: {elevation: -8 deg}").replace(
        "home: [45, -20, 0]", "home: [45, -20, 0], gimbal: {pitch: [-90 deg, 0 deg]}"
    )
    assert underlined(mission, only(mission, "G013")) == "-8 deg"


@pytest.mark.parametrize(
    ("shot", "name"),
    [
        ("kind: chase, target: runner, distance: 8, altitude: 4, timing: {start: 15, duration: 5}", "runner"),
        ("kind: static, at: [30, 20, 12], look_at: tower", "tower"),
        ("kind: orbit, target: tower, radius: 45, altitude: 12, sweep: 90 deg", "tower"),
    ],
)
def test_a_size_that_the_geometry_decides_is_told_with_what_would_give_it(shot: str, name: str) -> None:
    head = text("target: runner").rsplit("  - ", 1)[0]
    mission = head + f"  - {{id: s, drone: cam1, {shot}, size: 20 %}}\n"
    found = [d for d in told(mission) if d.code == "M035"]
    assert len(found) == 1
    assert underlined(mission, found[0]) == "20 %"
    assert name in found[0].message
    assert "hfov" in found[0].notes[-1]
    real = float(found[0].notes[-1].split("its size is ")[1].split()[0])
    asked = mission.replace("size: 20 %", f"size: {100 * min(real, 1.0)} %")
    assert [d.code for d in told(asked) if d.code == "M035"] == [] or real > 1.0
    assert not has_errors(told(mission))


@pytest.mark.long
def test_a_shot_begins_later_where_the_way_to_it_would_meet_its_subjects() -> None:
    mission = text().split("targets:")[0]
    mission += """\
targets:
  a: {track: {points: [[0, 0, 0.9], [-198.4, 25.1, 0.9]], speed: 1.99}, radius: 0.4, height: 1.8}
  b: {track: {points: [[-1.0, 1.6, 0.9], [-198.6, 32.0, 0.9]], speed: 2.14}, radius: 0.4, height: 1.8}
drones: {cam1: {model: x500, home: [10, -30, 0]}}
shots:
  - {id: both, kind: framing, drone: cam1, timing: {duration: 8},
     subjects: [{target: a, frame: [-0.38, 0.10]}, {target: b, frame: [0.38, 0.10]}]}
"""
    plan = planned(mission)
    assert claim(plan, "target a") >= 1.0
    assert claim(plan, "target b") >= 1.0


def test_check_knows_all_of_it_without_a_solver() -> None:
    report = check_source(text("target: runner, size: 0.3", "target: rider").encode(), "m.yaml", None)
    assert not has_errors(report.diagnostics)
