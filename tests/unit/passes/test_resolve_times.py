"""What resolve finds of times: flights shorter, starts earlier and batteries larger than can be."""

from __future__ import annotations

from tests.resolve_missions import FIRST, at, faults, mission, only, span


def test_a_flight_shorter_than_a_straight_line_allows() -> None:
    shot = (
        "id: a, kind: keyframes, timing: {duration: 10}, keyframes: [{at: [-45, -50, 10], look_at: tower}, "
        "{at: [50, -50, 10], look_at: tower}]"
    )
    d = only(mission(shot))
    # 95 m at 8 m/s take 11.9 s, and 8 / 3 s more for starting and stopping at 3 m/s^2.
    assert d.code == "K004"
    assert "95.0 m" in d.notes[0]
    assert "14.6 s" in d.notes[0]
    assert "14.6 s" in d.help
    line = mission(shot).splitlines()[FIRST - 1]
    assert span(d) == (FIRST, line.index("10}") + 1, line.index("10}") + 3)
    assert faults(mission(shot.replace("duration: 10", "duration: 14.6"))) == []


def test_a_keyframe_sooner_than_a_straight_line_from_the_start_allows() -> None:
    shot = (
        "id: a, kind: keyframes, keyframes: [{at: [-45, -50, 10], look_at: tower, hold: 2}, "
        "{at: [-5, -50, 10], look_at: tower}, {at: [51, -50, 10], look_at: tower, time: 5}]"
    )
    d = only(mission(shot))
    # 96 m at 8 m/s take 12 s, after a hold of 2 s.
    assert (d.code, d.message) == ("K004", "nobody gets there in the 5.0 s between keyframes 1 and 3")
    assert d.notes == ("the 96.0 m between them need at least 14.0 s",)
    assert faults(mission(shot.replace("time: 5", "time: 14.0"))) == []


def test_a_keyframe_past_the_end_needs_the_time_of_what_follows_it() -> None:
    shot = (
        "id: a, kind: keyframes, timing: {duration: 10}, keyframes: ["
        "{at: [0, -50, 10], heading: 0 deg, pitch: 0 deg}, "
        "{at: [0, -40, 10], heading: 0 deg, pitch: 0 deg, time: 12, hold: 2}, LAST]"
    )
    last = "{at: [0, -24, 10], heading: 0 deg, pitch: 0 deg}"
    d = only(mission(shot.replace("LAST", last)))
    assert (d.code, "more than 16.0 s" in d.help) == ("K002", True)
    d = only(mission(shot.replace(", LAST", "")))
    assert (d.code, d.help) == ("K002", "give the shot a duration of 14.0 s or more")
    assert faults(mission(shot.replace(", LAST", "").replace("duration: 10", "duration: 14"))) == []


def test_vertical_limits_bound_the_time_too() -> None:
    shot = "id: a, kind: elevator, target: tower, azimuth: 180 deg, distance: 60, altitude: [45, 5], "
    shot += "timing: {duration: 14}"
    d = only(mission(shot))
    # 40 m down at 3 m/s, and 1 s for starting and stopping at 3 m/s^2.
    assert (d.code, "14.4 s" in d.notes[0]) == ("K004", True)


def test_a_start_that_cannot_be_met_names_the_earliest() -> None:
    d = only(mission(at(0, 50, 10) + ", timing: {start: 5}"))
    # 110 m at 8 m/s from rest to rest.
    assert (d.code, "16.5 s" in d.help) == ("K008", True)
    assert faults(mission(at(0, 50, 10) + ", timing: {start: 16.5}")) == []


def test_endurance_counts_the_whole_flight() -> None:
    text = mission(at(0, -50, 10) + ", timing: {duration: 50}").replace(
        "radius: 0.6,", "radius: 0.6, endurance: 55,"
    )
    d = only(text)
    assert (d.code, "take longer" in d.message) == ("K005", True)
    one = text.replace("duration: 50", "duration: 60")
    assert "is longer than drone" in only(one).message
