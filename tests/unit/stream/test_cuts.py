"""When a camera is told to begin and to end."""

from __future__ import annotations

from dataclasses import replace

from shotc.ir.phases import Phase
from shotc.stream.pilot import RecordingTick
from shotc.stream.session import CUT_TICKS, cuts_of
from tests.support.stream.plans import hop_plan


def track(*phases):
    (found,) = hop_plan().trajectory.drones
    return replace(found, phases=tuple(Phase(*phase) for phase in phases))


def test_a_shot_is_recorded_from_its_first_frame_to_its_last():
    cuts = cuts_of(track(("takeoff", None, 0.0, 2.01), ("shot", "a", 2.01, 4.0), ("land", None, 4.0, 9.0)))
    assert cuts == (RecordingTick(101, "a", True), RecordingTick(200, "a", False))


def test_between_shots_that_follow_each_other_the_camera_stops():
    first, second = cuts_of(track(("shot", "a", 2.0, 4.0), ("shot", "b", 4.0, 6.0)))[1:3]
    assert (first.on, second.on) == (False, True)
    assert second.tick - first.tick == CUT_TICKS


def test_a_flight_without_a_shot_records_nothing():
    assert cuts_of(track(("takeoff", None, 0.0, 9.0))) == ()
