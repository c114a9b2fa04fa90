"""Photos in place of films in mission files."""

from __future__ import annotations

import json

import pytest

from shotc.emit.dji import EMITTER as DJI
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.ir.mission import MissionIR
from shotc.ir.photos import Photos
from tests.support.film_plans import orbit_mission
from tests.support.front_passes import resolved
from tests.support.mavlink_flights import Move, flight, plan, straight
from tests.support.records import replace


def mission(photos: Photos) -> MissionIR:
    sample = orbit_mission()
    return replace(sample, shots=(replace(sample.shots[0], photos=photos),))


def commands(emission: object) -> list[tuple[int, list[float]]]:
    items = json.loads(emission.artifacts[0].data)["mission"]["items"]  # type: ignore[attr-defined]
    shown = (530, 2000, 2001, 206, 2500, 2501)
    return [(i["command"], i["params"][:3]) for i in items if i["command"] in shown]


@pytest.mark.parametrize(
    ("photos", "begin", "end"),
    [
        (Photos(seconds=2.5), (2000, [0, 2.5, 0]), (2001, [0, 0, 0])),
        (Photos(metres=4.0), (206, [4, 0, 1]), (206, [0, 0, 0])),
    ],
)
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_shot_takes_photos_from_its_begin_to_its_end(photos, begin, end, autopilot) -> None:
    emission = MAVLINK.emit(plan(straight(), mission=mission(photos), autopilot=autopilot))
    mode = [(530, [0, 0, 0])] if autopilot == "px4" else []
    assert commands(emission) == [*mode, begin, end]
    # The same stretch counts as the shot in the re-flight.
    assert "(shot half, t = " in emission.notes[0]


def test_a_film_after_photos_has_the_camera_film_again() -> None:
    low, high = (0.0, -60.0, 0.0, 1.5, 0.0), (0.0, -60.0, 20.0, 1.5, 0.0)
    east, north = (40.0, -60.0, 20.0, 1.5, 0.0), (40.0, -20.0, 20.0, 1.5, 0.0)
    moves: list[Move] = [
        ("takeoff", None, 8.0, high),
        ("shot", "half", 10.0, east),
        ("shot", "film", 10.0, north),
        ("return", None, 10.0, high),
        ("land", None, 8.0, low),
    ]
    sample = mission(Photos(seconds=1.0))
    two = replace(sample, shots=(*sample.shots, replace(sample.shots[0], id="film", photos=None)))
    assert [name for name, _ in commands(MAVLINK.emit(plan(flight(moves, pad=low), mission=two)))] == [
        *(530, 2000, 2001),
        *(530, 2500, 2501),
    ]


@pytest.mark.slow
def test_dji_films_it_and_says_so() -> None:
    emission = DJI.emit(plan(straight(), mission=mission(Photos(seconds=2.0)), autopilot="dji-fly"))
    assert emission.artifacts
    (told,) = emission.diagnostics
    assert (told.code, told.notes) == ("E124", ("asked are photos every 2 s",))


TEXT = """\
shotc: 1
mission: photos
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -40, 0]}}
shots:
  - {id: look, kind: static, drone: cam, at: [0, -30, 8], look_at: mast, photos: PHOTOS}
"""


@pytest.mark.parametrize(
    ("written", "seconds", "metres"), [("2 s", 2.0, None), ("0.5 min", 30.0, None), ("5 m", None, 5.0)]
)
def test_intervals_are_times_or_ways(written: str, seconds: float | None, metres: float | None) -> None:
    read, found = resolved(TEXT.replace("PHOTOS", f"{{every: {written}}}"))
    assert found == []
    assert read.shots[0].photos == Photos(seconds, metres)


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("{every: 2}", "expected a time or a distance"),
        ("{every: 0 s}", "below"),
        ("{every: 5 kg}", "mass"),
        ("{each: 2 s}", "each"),
    ],
)
def test_bad_intervals_are_told_at_their_line(written: str, words: str) -> None:
    _, found = resolved(TEXT.replace("PHOTOS", written))
    assert words in " ".join(d.message for d in found)
    assert {d.labels[0].span.line for d in found} == {6}
