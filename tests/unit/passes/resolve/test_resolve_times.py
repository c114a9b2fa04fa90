"""What resolve finds of times: flights shorter, starts earlier and batteries larger than can be."""

from __future__ import annotations

import re

import pytest

from tests.support.resolve_missions import FIRST, at, faults, mission, only, span


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
    assert (d.code, d.message) == ("K004", "no drone gets there in the 5.0 s between keyframes 1 and 3")
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


GALE = "id: a, kind: dolly, target: tower, azimuth: 180 deg, distance: [40, 60], altitude: 15"


def windy(duration: str, wind: str = "7.7 m/s") -> str:
    return mission(GALE + duration).replace("world:", f"world:\n  wind: {wind}")


@pytest.mark.parametrize("seconds", [10, 30, 60])
def test_a_duration_that_the_wind_makes_too_short_is_cured_by_less_wind(seconds: int) -> None:
    given = f", timing: {{duration: {seconds}}}"
    # 20 m at 0.3 m/s take more than a minute.
    d = only(windy(given))
    assert (d.code, "0.3 m/s across (8.0 less 7.7 of wind)" in d.notes[0]) == ("K004", True)
    calm, fast = re.findall(r"([0-9.]+ m/s)", d.help)
    assert faults(windy(given, calm)) == []
    assert faults(windy(given).replace("speed: 8", f"speed: {fast}")) == []
    assert d.help.endswith(", give it more than 66.8 s, or write `timing: auto`")


def test_a_duration_too_short_is_told_before_an_endurance_too_short() -> None:
    given = ", timing: {duration: 30}"
    d = only(windy(given).replace("radius: 0.6,", "radius: 0.6, endurance: 60,"))
    assert d.code == "K004"
    assert "longer than the endurance of 60.0 s" in d.notes[1]
    assert "give it" not in d.help
    (calm, _) = re.findall(r"([0-9.]+ m/s)", d.help)
    assert "K004" not in {f.code for f in faults(windy(given, calm))}


def test_an_endurance_that_the_wind_makes_too_short_names_the_wind() -> None:
    d = only(windy("").replace("radius: 0.6,", "radius: 0.6, endurance: 60,"))
    assert (d.code, "of wind" in d.notes[1]) == ("K005", True)
    assert d.notes[0] == "the shot takes at least 66.8 s, the endurance is 60.0 s"
    assert d.help == "wait for wind below 7.6 m/s, or take a drone that flies more than 8.1 m/s"


def test_a_drone_that_the_wind_stops_is_left_half_its_speed() -> None:
    d = only(windy("", "9 m/s"))
    assert (d.code, d.help.partition(" (")[0]) == (
        "K011",
        "wait for wind below 4.0 m/s, which leaves it half its speed",
    )
