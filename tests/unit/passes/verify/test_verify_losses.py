"""A target that strays from its place on screen: told once a shot, with frame, time and limits met."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.solids import Cylinder
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, PathDeviation
from shotc.ir.promise import Promise
from shotc.passes.verify.loss import at_limit
from tests.support.records import replace
from tests.support.tampered_plans import (
    MISSION,
    PLAN,
    shifted,
    with_gimbal,
    with_mission,
    with_shot,
    with_track,
    zone,
)
from tests.support.verdicts import codes, verdict_on

TRACK = PLAN.drones[0]
FILMED = 40.0
"""Seconds; a time in the middle of the shot."""


def told(ir):
    (found,) = [d for d in verdict_on(ir).diagnostics if d.code == "V032"]
    return found


def turned(degrees: float):
    """The plan with its camera turned, and without a promise."""
    shot = replace(MISSION.shots[0], promise=Promise())
    return with_mission(shifted(CAM_YAW, radians(degrees)), shots=(shot,))


def off(degrees: float) -> float:
    """How far the target goes from the centre of the screen, in half frames, when the camera turns."""
    return np.tan(radians(degrees)) / np.tan(radians(35))


@pytest.mark.parametrize(("turn", "tells"), [(0.0, False), (1.9, False), (2.1, True)])
def test_a_twentieth_of_half_a_frame_is_worth_telling(turn, tells):
    assert off(1.9) < 0.05 < off(2.1)
    assert ("V032" in codes(turned(turn))) is tells


def test_it_is_told_with_its_error_frame_and_time():
    found = told(turned(10.0))
    error = float(found.message.split("up to ")[1].split()[0])
    assert error == pytest.approx(off(10.0), rel=0.02)
    assert "shot `half`" in found.message
    note = found.notes[0]
    time = float(note.split("t = ")[1].split(" s")[0])
    start = next(p.start for p in TRACK.phases if p.shot == "half")
    assert f"{time - start:.3f} s into the shot" in note
    assert f"frame {round(time * MISSION.rate)} at {MISSION.rate:g} Hz" in note
    assert "screen_error" in found.help
    assert "move the keyframes next to it" in found.help  # it has one subject and a path of its own


def test_what_bent_the_path_is_told():
    bent = replace(turned(10.0), deviations=(PathDeviation("half", 1.5, 3.0, "zone tree"),))
    assert "round zone `tree`" in told(bent).notes[2]


def test_behind_the_camera_there_is_no_number():
    assert "behind the camera" in told(turned(180.0)).message


@pytest.mark.parametrize(
    ("promise", "code"), [(Promise(screen_error=0.05), "V020"), (Promise(screen_error=0.9), None)]
)
def test_a_promise_of_its_own_is_judged_instead(promise, code):
    found = codes(replace(turned(10.0), keyframes=with_shot(promise=promise).keyframes))
    assert "V032" not in found
    assert ("V020" in found) is (code == "V020")


def test_a_shot_that_asks_no_composition_is_not_judged():
    watched = tuple(replace(f, reference=None) for f in TRACK.framing)
    aside = turned(10.0)
    assert "V032" not in codes(with_track(aside, framing=watched))


def test_what_is_at_its_limit_is_named():
    pitch = float(TRACK.curve(FILMED)[CAM_PITCH])
    tight = with_gimbal(pitch=(pitch, radians(30.0)))
    assert at_limit(tight.keyframes.mission, TRACK, FILMED) == [f"gimbal pitch ({np.degrees(pitch):.1f} deg)"]
    relative = float(TRACK.curve(FILMED)[CAM_YAW] - TRACK.curve(FILMED)[BODY_YAW])
    aside = with_gimbal(yaw=(relative - 1.0 + 2 * pi, relative + 2 * pi))
    assert [text.split(" (")[0] for text in at_limit(aside.keyframes.mission, TRACK, FILMED)] == [
        "gimbal yaw"
    ]


def test_a_rate_at_its_limit_is_named():
    """The body stands, so that the gimbal turns as the camera does."""
    ctrl = TRACK.curve.ctrl.copy()
    ctrl[:, :, BODY_YAW] = 0.0
    track = replace(TRACK, curve=Piecewise(TRACK.curve.breaks, ctrl))
    rate = abs(float(TRACK.curve.derivative(1)(FILMED)[CAM_YAW]))
    for limit, named in ((rate * 1.01, ["gimbal yaw rate"]), (rate * 1.1, [])):
        mission = with_gimbal(rate=limit, yaw=(-10.0, 10.0)).keyframes.mission
        assert [text.split(" (")[0] for text in at_limit(mission, track, FILMED)] == named


def test_a_zone_that_is_near_is_named():
    x, y, _ = map(float, TRACK.curve(FILMED)[:3])
    radius = MISSION.drones[0].radius
    beside = Cylinder((x + 2.0 + radius, y), 2.0 - 0.05, 0.0, 60.0)
    mission = with_mission(zones=zone("out", beside)).keyframes.mission
    assert at_limit(mission, TRACK, FILMED) == ["zone `extra`"]
    inside = Cylinder((x - 30.0 + radius, y), 30.0 + 0.05, 0.0, 60.0)
    mission = with_mission(zones=zone("in", inside)).keyframes.mission
    assert at_limit(mission, TRACK, FILMED) == ["zone `extra`"]


def test_the_ground_and_a_target_that_are_near_are_named():
    x, y, z = map(float, TRACK.curve(FILMED)[:3])
    radius = MISSION.drones[0].radius
    rules = replace(MISSION.rules, ground_clearance=z - radius - 0.05)
    mission = with_mission(rules=rules).keyframes.mission
    assert [t.split(" (")[0] for t in at_limit(mission, TRACK, FILMED)] == ["ground clearance"]
    tower = MISSION.targets[0]
    away = np.hypot(x - tower.centre[0], y - tower.centre[1]) - tower.radius
    rules = replace(MISSION.rules, target_clearance=away - radius - 0.05)
    mission = with_mission(rules=rules).keyframes.mission
    assert [t.split(" (")[0] for t in at_limit(mission, TRACK, FILMED)] == ["the clearance of target `tower`"]


def test_nothing_is_blamed_where_nothing_is_at_its_limit():
    assert at_limit(MISSION, TRACK, FILMED) == []
    assert "no limit of gimbal or space is met there" in told(turned(10.0)).notes[1]
