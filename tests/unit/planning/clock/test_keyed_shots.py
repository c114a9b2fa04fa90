"""Keyframes and views from above of moving targets: what `check` tells of them, and what is flown."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import references, seen
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from shotc.planfile.layout import text
from shotc.planfile.read import read_plan
from shotc.planfile.write import document
from tests.support.compiled import compiled_text
from tests.support.few import few
from tests.support.front_passes import resolved

pytestmark = pytest.mark.slow

WALK = """\
shotc: 1
mission: walk
world: {{zones: {{shed: {{keep: out, cylinder: {{center: [60, -30], radius: 3, height: [0, 9]}}}}}}}}
targets:
  walker:
    {{track: {{points: [[0, 0, 0.9], [40, 0, 0.9], [40, 60, 0.9]], speed: 1.5}}, radius: 0.4, height: 1.8}}
  tower: {{at: [20, 40, 6], radius: 2, height: 12}}
drones:
  cam1: {{model: x500, home: [10, -25, 0]}}
shots:
  - id: s
    drone: cam1
    timing: {timing}
    {shot}
"""
GOING = "{start: 15, duration: 20}"
KEYS = """kind: keyframes
    target: walker
    allow: [fast-pan]
    keyframes:
      - {at: {from: target, offset: [-6, 1, 4], turn: course}, look_at: walker}
      - {at: {from: walker, offset: [2, -9, 5]}, look_at: walker, frame: left-third, hfov: 45 deg, hold: 2}
      - {at: [45, -22, 9], look_at: walker, hfov: 60 deg, time: 16 s, hold: 2}
"""
ABOVE = """kind: top-down
    target: walker
    altitude: 15
"""


def mission(shot: str, timing: str = GOING) -> str:
    return WALK.format(shot=shot, timing=timing)


def codes(shot: str, timing: str = GOING) -> list[str]:
    return [d.code for d in resolved(mission(shot, timing))[1]]


Planned = tuple[MissionIR, DroneTrajectory, VerifiedIR]


@cache
def compiled(shot: str, timing: str = GOING, refiner: str = "none") -> Compilation:
    return compiled_text(mission(shot, timing), refiner, "walk.yaml")


def assert_planned(shot: str, timing: str = GOING, refiner: str = "none") -> Planned:
    done = compiled(shot, timing, refiner)
    assert done.plan is not None, [d.message for d in done.diagnostics]
    (flight,) = done.plan.trajectory.drones
    return done.plan.trajectory.keyframes.mission, flight, done.plan


def beside(target: Target, t: float, east: float, north: float, up: float) -> Array:
    """Return a place that counts from a target's centre."""
    return np.array(target.at(t)) + np.array([east, north, up])


def film(flight: DroneTrajectory) -> Array:
    (phase,) = (p for p in flight.phases if p.shot == "s")
    return np.linspace(phase.start, phase.end, 201)


class TestFlown:
    @pytest.mark.long
    @pytest.mark.parametrize("refiner", few(["none", "ours"], ["none"]))
    def test_placed_keyframes_are_passed_at_their_times(self, refiner: str) -> None:
        mission, flight, _ = assert_planned(KEYS, refiner=refiner)
        walker = mission.target("walker")
        (a, b, c) = (k.time for k in flight.keyframes)
        assert a == pytest.approx(15.0)
        assert flight.curve(a)[:3] == pytest.approx(beside(walker, a, -6.0, 1.0, 3.1), abs=1e-3)
        for t in (b, b + 2.0):
            assert flight.curve(t)[:3] == pytest.approx(beside(walker, t, 2.0, -9.0, 4.1), abs=1e-3)
        assert c == pytest.approx(31.0)
        for t in (c, c + 1.0, c + 2.0):
            assert flight.curve(t)[:3] == pytest.approx([45.0, -22.0, 9.0], abs=1e-3)

    @pytest.mark.parametrize("refiner", few(["none", "ours"], ["none"]))
    def test_the_target_is_led_from_place_to_place_on_screen(self, refiner: str) -> None:
        mission, flight, _ = assert_planned(KEYS, refiner=refiner)
        t = film(flight)
        frames = seen(mission, flight, "walker", t)
        wanted = references(flight, "s", "walker", t)
        assert frames.in_frame.all()
        assert np.hypot(frames.u - wanted[:, 0], frames.v - wanted[:, 1]).max() < 0.05
        left = references(flight, "s", "walker", np.array([flight.keyframes[1].time]))
        assert left[0] == pytest.approx([-1 / 3, 0.0])

    def test_every_keyframe_has_its_lens(self) -> None:
        _, flight, _ = assert_planned(KEYS)
        lens = [np.degrees(flight.curve(k.time)[HFOV]) for k in flight.keyframes]
        assert lens[1:] == pytest.approx([45.0, 60.0])

    @pytest.mark.long
    def test_a_start_that_is_open_is_placed_when_it_is_known(self) -> None:
        mission, flight, _ = assert_planned(KEYS, "{duration: 20}")
        a = flight.keyframes[0].time
        offset = flight.curve(a)[:3] - np.array(mission.target("walker").at(a))
        assert offset == pytest.approx([-6.0, 1.0, 3.1], abs=1e-3)

    def test_keyframes_may_hand_a_moving_target_over_to_one_that_stands(self) -> None:
        shot = """kind: keyframes
    keyframes:
      - {at: {from: walker, offset: [-8, -8, 5]}, look_at: walker}
      - {at: {from: walker, offset: [-6, -10, 6]}, look_at: walker}
      - {at: [15, -8, 9], look_at: tower}
      - {at: [20, -2, 9], heading: 20 deg, pitch: -5 deg}
"""
        mission, flight, _ = assert_planned(shot)
        times = np.array([k.time for k in flight.keyframes])
        assert seen(mission, flight, "walker", times[:2]).in_frame.all()
        assert seen(mission, flight, "tower", times[2:3]).in_frame.all()
        assert np.degrees(flight.curve(times[3])[CAM_PITCH]) == pytest.approx(-5.0, abs=0.5)
        assert np.degrees(flight.curve(times[3])[CAM_YAW]) % 360 == pytest.approx(70.0, abs=1.0)

    def test_own_angles_are_composed_at_the_moment_of_the_keyframe(self) -> None:
        shot = """kind: keyframes
    target: walker
    keyframes:
      - {at: {from: target, offset: [0, -10, 3.9]}, heading: 12 deg, pitch: -16 deg}
      - {at: {from: target, offset: [0, -12, 5.9]}, look_at: walker}
"""
        _, flight, _ = assert_planned(shot)
        first = references(flight, "s", "walker", np.array([flight.keyframes[0].time]))[0]
        assert abs(first[0]) == pytest.approx(1 / 3)

    @pytest.mark.parametrize("refiner", few(["none", "ours"], ["none"]))
    def test_a_view_from_above_goes_along_and_looks_straight_down(self, refiner: str) -> None:
        mission, flight, _ = assert_planned(ABOVE, refiner=refiner)
        t = film(flight)
        foot = np.array([mission.target("walker").at(u) for u in t]) - [0.0, 0.0, 0.9]
        away = flight.curve(t)[:, :3] - foot
        assert np.abs(away - [0.0, 0.0, 15.0]).max() < 0.5
        assert np.degrees(flight.curve(t)[:, CAM_PITCH]) == pytest.approx(-90.0, abs=1e-3)

    def test_a_plan_is_read_back_as_it_was_written(self) -> None:
        _, _, plan = assert_planned(KEYS)
        back = read_plan(text(document(plan)).encode(), "plan.json")
        assert back.diagnostics == ()


class TestChecked:
    def test_what_is_planned_checks_clean(self) -> None:
        assert codes(KEYS) == []

    def test_it_has_to_say_how_long_it_lasts(self) -> None:
        shot = KEYS.replace(", time: 16 s", "")
        assert codes(shot, "{start: 15}") == ["M003"]

    def test_the_time_of_the_last_keyframe_says_how_long_it_lasts(self) -> None:
        value, found = resolved(mission(KEYS, "{start: 15}"))
        assert found == []
        assert value is not None
        assert value.shots[0].timing.duration == 18.0

    def test_a_place_too_near_its_own_target_is_told_with_an_offset_that_is_free(self) -> None:
        shot = KEYS.replace("[2, -9, 5]", "[0.5, -0.5, 3]")
        (fault,) = resolved(mission(shot, "{duration: 20}"))[1]
        assert fault.code == "G004"
        offset = fault.help[fault.help.index("[") : -1]
        assert codes(KEYS.replace("[2, -9, 5]", offset), "{duration: 20}") == []

    def test_a_place_under_the_ground_clearance_is_told(self) -> None:
        assert codes(KEYS.replace("[2, -9, 5]", "[2, -9, 1]"), "{duration: 20}") == ["G001"]

    def test_a_place_in_a_zone_is_told_where_the_moment_is_known(self) -> None:
        there = KEYS.replace("[45, -22, 9]", "[60, -30, 5]")
        assert codes(there, "{duration: 20}") == ["G002"]
        carried = KEYS.replace("[2, -9, 5]", "[32, -30, 5]")
        assert codes(carried, "{duration: 20}") == []

    @pytest.mark.parametrize(
        ("change", "code"),
        [
            (("time: 16 s", "time: 1 s"), "K001"),
            (("time: 16 s", "time: 19 s"), "K002"),
            (("time: 16 s", "time: 0 s"), "K001"),
            (("hold: 2}\n      - ", "hold: 30}\n      - "), "K003"),
        ],
    )
    def test_times_that_cannot_be_met_are_told(self, change: tuple[str, str], code: str) -> None:
        assert codes(KEYS.replace(*change)) == [code]

    def test_a_way_that_no_drone_flies_is_told(self) -> None:
        assert codes(KEYS.replace("[45, -22, 9]", "[400, -22, 9]")) == ["M005"]

    def test_a_shot_that_reaches_beyond_the_track_is_told(self) -> None:
        moved = mission(KEYS).replace("speed: 1.5", "times: [16, 40, 80]")
        assert [d.code for d in resolved(moved)[1]] == ["M004"]

    def test_an_unknown_target_is_told_where_it_is_written(self) -> None:
        (fault,) = resolved(mission(KEYS.replace("from: walker", "from: wlaker")))[1]
        assert fault.code == "N001"
        assert fault.labels[0].span.line == 19

    def test_a_place_without_an_offset_is_told(self) -> None:
        (fault,) = resolved(mission(KEYS.replace(", offset: [2, -9, 5]", "")))[1]
        assert fault.message == "missing key `offset`"

    def test_positions_elsewhere_count_from_nothing(self) -> None:
        shot = "kind: static\n    at: {from: walker, offset: [0, 0, 5]}\n    look_at: walker"
        (fault, *_) = resolved(mission(shot))[1]
        assert fault.labels[0].span.line == 15


ZIGZAG = """kind: keyframes
    target: walker
    keyframes:
      - {at: {from: target, offset: [0, -9, 4]}, look_at: walker}
      - {at: {from: target, offset: [9, -9, 4]}, look_at: walker, time: 1.5}
      - {at: {from: target, offset: [0, -9, 6]}, look_at: walker, time: 3.0}
      - {at: {from: target, offset: [0, -9, 6]}, look_at: walker}
"""


class TestRefused:
    @pytest.mark.long
    def test_keyframes_out_of_reach_are_told_with_the_times_that_do(self) -> None:
        done = compiled(ZIGZAG)
        (fault,) = [d for d in done.diagnostics if d.code == "M015"]
        assert done.plan is None
        found = re.match(
            r"give the shot `duration: ([\d.]+) s`, and every `time` ([\d.]+) times as late", fault.help
        )
        assert found is not None
        lasts, times = float(found[1]), float(found[2])
        slower = re.sub(r"time: ([\d.]+)", lambda at: f"time: {float(at[1]) * times}", ZIGZAG)
        assert_planned(slower, f"{{start: 15, duration: {lasts}}}")

    @pytest.mark.long
    def test_a_target_that_has_moved_on_is_told_with_a_framing_that_does(self) -> None:
        shot = KEYS.replace("[45, -22, 9], look_at: walker", "[45, -22, 9], heading: 180 deg, pitch: 0 deg")
        (fault,) = [d for d in compiled(shot, "{duration: 20}").diagnostics if d.code == "M016"]
        angles, start = re.findall(r"`(heading: [^`]*|start: [^`]*)`", fault.help)
        corrected = KEYS.replace("[45, -22, 9], look_at: walker", f"[45, -22, 9], {angles}")
        assert_planned(corrected, f"{{{start}, duration: 20}}")

    @pytest.mark.long
    def test_a_keyframe_that_another_drone_is_too_near_to_is_told_with_both(self) -> None:
        beside = """\
shotc: 1
mission: beside
targets:
  walker: {track: {points: [[0, 0, 0.9], [90, 0, 0.9]], speed: 1.5 m/s}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [20, -20, 0], priority: 1}
  cam2: {model: x500, home: [40, 20, 0], priority: 2}
rules: {separation: 6 m}
shots:
  - id: a
    drone: cam1
    kind: keyframes
    target: walker
    keyframes:
      - {at: {from: walker, offset: [0, 5, 5.1]}, look_at: walker, time: 0 s}
      - {at: {from: walker, offset: [0, 5, 5.1]}, look_at: walker, time: 8 s}
    timing: {start: 20, duration: 8}
  - id: b
    drone: cam2
    kind: keyframes
    target: walker
    keyframes:
      - {at: {from: walker, offset: [1, 6, 4]}, look_at: walker}
      - {at: {from: walker, offset: [9, 6, 5]}, look_at: walker}
    timing: {start: 24, duration: 9}
"""
        done = compile_source(beside.encode(), "beside.yaml", None, PlanOptions())
        (fault,) = [d for d in done.diagnostics if d.code == "M015"]
        assert done.plan is None
        (lack,) = re.findall(
            r"at t = 24.0 s its place is ([\d.]+) m too near to drone `cam1`", fault.notes[0]
        )
        assert 0.0 < float(lack) < 6.0
        assert fault.labels[-1].text == "too near then"
        assert fault.labels[-1].span.line == 6
        assert "move keyframe 1 by that much" in fault.help
        assert "`limits`" not in fault.help


ZOOMED = """kind: keyframes
    target: walker
    allow: [fast-pan]
    keyframes:
      - {at: {from: walker, offset: [0, -12, 5]}, look_at: walker, hfov: 60 deg, time: 0 s, hold: 4}
      - {at: {from: walker, offset: [2, -12, 5]}, look_at: walker, hfov: 30 deg, time: 14 s, hold: 4}
"""


def zooming(rate: str) -> str:
    lens = f"home: [10, -25, 0], camera: {{zoom: [24 mm, 70 mm], zoom_rate: {rate}}}"
    return mission(ZOOMED).replace("home: [10, -25, 0]", lens)


@pytest.mark.long
@pytest.mark.parametrize("rate", [3.2, 4.5, 20.0])
def test_a_zoom_by_the_mission_clock_keeps_the_rate_of_the_lens(rate: float) -> None:
    # 30 deg in 10 s: the step of least jerk would take 5.6 deg/s.
    plan = compiled_text(zooming(f"{rate} deg/s"), "none").plan
    assert plan is not None
    claim = next(c for c in plan.certificate if c.constraint == "zoom rate")
    assert (claim.method, claim.holds) == ("bounded", True)
    assert np.degrees(claim.worst) <= min(rate, 5.625) + 1e-3
    assert np.degrees(claim.worst) > 3.0
    flight = plan.trajectory.drones[0]
    (phase,) = (p for p in flight.phases if p.shot == "s")
    for time, hfov in ((0.0, 60.0), (4.0, 60.0), (14.0, 30.0), (20.0, 30.0)):
        assert np.degrees(flight.curve(phase.start + time)[HFOV]) == pytest.approx(hfov, abs=1e-6)
    # The aim goes with the lens: the walker stays in its place while the picture narrows.
    t = np.linspace(phase.start + 4.0, phase.start + 14.0, 101)
    frames = seen(plan.trajectory.keyframes.mission, flight, "walker", t)
    wanted = references(flight, "s", "walker", t)
    assert np.hypot(frames.u - wanted[:, 0], frames.v - wanted[:, 1]).max() < 0.02


def test_a_lens_too_slow_for_its_time_is_told_with_what_it_reaches() -> None:
    _, (told,) = resolved(zooming("2 deg/s"))
    assert told.code == "K020"
    assert "from 60 to 30 deg in 10 s" in told.message
    assert told.help.startswith("write `hfov: 40.6 deg`, or ")
    found = compiled_text(zooming("2 deg/s").replace("30 deg", "40.6 deg"))
    assert found.plan is not None
