"""Pans as they are flown: told once a shot, with the number that is flown, and a remedy that corrects it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import quintic_hermite
from shotc.geom.pan import slowest
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.pans import PEAK_RATIO, RESHAPED_RATIO, FastestTurn, _enough, fastest

SWEEP = """\
shotc: 1
mission: pan
targets: {mast: {at: [0, -30, 6], radius: 0.5, height: 12}}
drones: {cam: {model: x500, home: [0, -60, 0]}}
shots:
  - id: sweep
    kind: keyframes
    drone: cam
    timing: TIMING
    keyframes:
      - {at: [0, -50, 15], heading: 320 deg, pitch: 0 deg}
      - {at: [4, -50, 15], heading: 20 deg, pitch: 0 deg}
"""
PANS = ("F005", "V051")


def planned(timing: str, text: str = SWEEP) -> Compilation:
    done = compile_source(
        text.replace("TIMING", timing).encode(), "m.yaml", None, PlanOptions(refiner="none")
    )
    assert done.plan is not None
    return done


def told(done: Compilation) -> list[str]:
    return [d.code for d in done.diagnostics if d.code in PANS]


def test_a_pan_whose_time_was_not_known_is_told_with_what_is_flown() -> None:
    done = planned("auto")
    assert told(done) == ["V051"]
    (found,) = (d for d in done.diagnostics if d.code == "V051")
    assert done.plan is not None
    (track,) = done.plan.trajectory.drones
    (phase,) = (p for p in track.phases if p.shot == "sweep")
    starts = np.linspace(phase.start, phase.end - 1, 500)
    turned = np.abs(track.curve(starts + 1)[:, CAM_YAW] - track.curve(starts)[:, CAM_YAW]).max()
    width = 2 * np.tan(np.radians(35)) / turned
    assert f"goes by in {width:.1f} s" in found.notes[0]
    assert found.labels[0].span.line == 6


def test_a_pan_that_check_tells_is_told_once_a_shot() -> None:
    assert told(planned("{duration: 5}")) == ["V051"]


@pytest.mark.slow
def test_the_duration_of_the_remedy_mends_it() -> None:
    (found,) = (d for d in planned("auto").diagnostics if d.code == "V051")
    asked = re.search(r"duration: [\d.]+ s", found.help or "")
    assert asked is not None
    assert told(planned(f"{{{asked[0]}}}")) == []


@pytest.mark.slow
def test_what_is_meant_is_not_told() -> None:
    assert told(planned("auto", SWEEP.replace("drone: cam", "drone: cam\n    allow: [fast-pan]"))) == []
    assert told(planned("auto", SWEEP.replace("shots:", "rules: {allow: [fast-pan]}\nshots:"))) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("look", "found"), [("look_at: mast", []), ("heading: 53 deg, pitch: 0 deg", ["V051"])]
)
def test_a_subject_that_is_followed_holds_the_eye(look: str, found: list[str]) -> None:
    """The same places: at the rate at which a free camera judders, one that follows its target does not."""
    text = SWEEP.replace("heading: 20 deg, pitch: 0 deg", "look_at: mast").replace(
        "[4, -50, 15]", "[16, -42, 9]"
    )
    text = text.replace("[0, -50, 15], heading: 320 deg, pitch: 0 deg", f"[-16, -42, 9], {look}")
    codes = told(planned("{duration: 14}", text))
    assert codes == found


def turning(channel: int, by_deg: float, seconds: float, pitch_deg: float = 0.0) -> DroneTrajectory:
    """A camera with a field of view of 70 deg that turns evenly about one axis."""
    value = np.zeros((2, 7))
    value[:, HFOV], value[:, CAM_PITCH] = np.radians(70), np.radians(pitch_deg)
    value[1, channel] += np.radians(by_deg)
    rate = np.tile((value[1] - value[0]) / seconds, (2, 1))
    curve = quintic_hermite(np.array([0.0, seconds]), value, rate, np.zeros((2, 7)))
    return DroneTrajectory("cam", curve, (Phase("shot", "sweep", 0.0, seconds),), (), ())


@pytest.mark.parametrize(
    ("channel", "pitch", "angle"),
    [
        (CAM_YAW, 0.0, 12.0),
        (CAM_PITCH, 0.0, 12.0),
        (CAM_PITCH, -40.0, 12.0),
        (CAM_YAW, -60.0, 2 * np.degrees(np.arcsin(0.5 * np.sin(np.radians(6.0))))),  # cos 60 deg of the chord
    ],
)
def test_a_pan_is_as_fast_as_the_axis_turns(channel: int, pitch: float, angle: float) -> None:
    track = turning(channel, 120.0, 10.0, pitch)
    if channel == CAM_PITCH:
        track = turning(channel, 24.0, 2.0, pitch)
    found = fastest(track, track.phases[0])
    assert found is not None
    # Of a second of it: 12 deg of yaw or pitch, and the frame is 2 tan(35 deg) wide.
    assert found.width == pytest.approx(2 * np.tan(np.radians(35)) / np.radians(angle), rel=1e-4)


def test_a_shot_that_does_not_turn_has_no_pan() -> None:
    track = turning(CAM_YAW, 0.0, 5.0)
    assert fastest(track, track.phases[0]) is None
    assert fastest(track, Phase("shot", "sweep", 3.0, 3.0)) is None


def test_a_shot_is_long_enough_for_its_fastest_turn_and_for_all_of_it() -> None:
    width = 2 * np.tan(np.radians(35))
    even = turning(CAM_YAW, 60.0, 3.0)
    (phase,) = even.phases
    pan = fastest(even, phase)
    assert pan is not None
    turned = np.radians(60.0) / width
    for free in (False, True):
        whole = PEAK_RATIO * turned * slowest(None)
        assert _enough(even, phase, pan, free) == pytest.approx(
            max(3.0 * pan.pace * (1.05 if free else 1), whole), rel=1e-3
        )
    hasty = pan._replace(width=pan.width / 9)
    assert _enough(even, phase, hasty, False) == pytest.approx(3.0 * hasty.pace)
    assert _enough(even, phase, hasty, True) == pytest.approx(3.0 * hasty.pace * RESHAPED_RATIO)


def test_a_camera_that_turns_there_and_back_has_turned_twice() -> None:
    value, none = np.zeros((5, 7)), np.zeros((5, 7))
    value[:, HFOV], value[1::2, CAM_YAW] = np.radians(70), np.radians(40)
    curve = quintic_hermite(np.linspace(0.0, 8.0, 5), value, none, none)
    track = DroneTrajectory("cam", curve, (Phase("shot", "sweep", 0.0, 8.0),), (), ())
    slow = FastestTurn(1e9, 0.0, None)
    turned = np.radians(4 * 40) / (2 * np.tan(np.radians(35)))
    assert _enough(track, track.phases[0], slow, False) == pytest.approx(
        PEAK_RATIO * turned * slowest(None), rel=1e-3
    )


@pytest.mark.parametrize("centre", [1.3, 1.8, 3.7])
def test_the_fastest_turn_is_looked_for_every_tenth_of_a_second(centre: float) -> None:
    """A turn of one second about a moment is found where it begins; a shot of five seconds has 41 windows."""
    times = np.array([0.0, centre - 0.5, centre + 0.5, 5.0])
    value = np.zeros((4, 7))
    value[:, HFOV], value[2:, CAM_YAW] = np.radians(70), np.radians(40)
    curve = quintic_hermite(times, value, np.zeros((4, 7)), np.zeros((4, 7)))
    track = DroneTrajectory("cam", curve, (Phase("shot", "sweep", 0.0, 5.0),), (), ())
    found = fastest(track, track.phases[0])
    assert found is not None
    assert found.time == pytest.approx(centre - 0.5, abs=1e-9)
    assert found.width == pytest.approx(2 * np.tan(np.radians(35)) / np.radians(40))
