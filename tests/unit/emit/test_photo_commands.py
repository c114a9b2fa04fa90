"""Photos in place of films in mission files."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path
from zipfile import ZipFile

import pytest

from shotc.emit.dji import EMITTER as DJI
from shotc.emit.dji.kmz import read_kmz
from shotc.emit.litchi import EMITTER as LITCHI
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
def test_dji_fly_films_it_and_says_so() -> None:
    emission = DJI.emit(plan(straight(), mission=mission(Photos(seconds=2.0)), autopilot="dji-fly"))
    assert emission.artifacts
    (told,) = emission.diagnostics
    assert (told.code, told.notes) == ("E124", ("asked are photos every 2 s",))


def local(element: ET.Element) -> str:
    return element.tag.rpartition("}")[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("photos", "trigger", "every"),
    [(Photos(seconds=2.0), "multipleTiming", "2"), (Photos(metres=5.5), "multipleDistance", "5.5")],
)
def test_pilot_2_takes_photos_over_all_points_of_the_shot(photos, trigger, every) -> None:
    emission = DJI.emit(plan(straight(), mission=mission(photos), autopilot="pilot-2"))
    assert emission.diagnostics == ()
    with ZipFile(io.BytesIO(emission.artifacts[0].data)) as archive:
        files = [ET.fromstring(archive.read(f"wpmz/{n}")) for n in ("waylines.wpml", "template.kml")]
    film = DJI.emit(plan(straight(), mission=orbit_mission(), autopilot="pilot-2"))
    points = read_kmz(film.artifacts[0].data)
    count, kinds = len(points), [{a.kind for a in p.actions} for p in points]
    ends = [i for i, done in enumerate(kinds) if done & {"start", "stop"}]
    for root in files:
        told = [{local(e): e.text for e in g.iter()} for g in root.iter() if local(g) == "actionGroup"]
        (group,) = (g for g in told if g["actionTriggerType"] == trigger)
        assert (group["actionTriggerParam"], group["actionActuatorFunc"]) == (every, "takePhoto")
        assert [int(group[f"actionGroup{end}Index"] or "") for end in ("Start", "End")] == ends
        assert not {g.get("actionActuatorFunc") for g in told} & {"startRecord", "stopRecord"}
        assert sum(local(e) == "Placemark" for e in root.iter()) == count
    # What is read back is the same shot: its picture is judged as that of the film is.
    assert emission.notes[0].split("; films")[0] == film.notes[0].split("; films")[0]


@pytest.mark.slow
def test_a_reader_that_others_wrote_finds_the_intervals_of_litchi(tmp_path: Path) -> None:
    litchi = pytest.importorskip("litchi_wp.waypoint", reason="litchi-wp is not installed")
    emission = LITCHI.emit(plan(straight(), mission=mission(Photos(seconds=2.5)), autopilot="dji-fly"))
    file = tmp_path / "mission.csv"
    file.write_bytes(emission.artifacts[0].data)
    read = litchi.Waypoint.from_file(str(file))
    assert {w.photo.time_interval for w in read} == {2.5, -1}
    assert {w.photo.distance_interval for w in read} == {-1}


@pytest.mark.slow
def test_litchi_has_intervals_on_the_legs_of_the_shot() -> None:
    emission = LITCHI.emit(plan(straight(), mission=mission(Photos(metres=4.0)), autopilot="dji-fly"))
    assert emission.diagnostics == ()
    rows = list(csv.DictReader(io.StringIO(emission.artifacts[0].data.decode())))
    on = [float(row["photo_distinterval"]) for row in rows]
    assert {row["photo_timeinterval"] for row in rows} == {"-1"}
    first, last = on.index(4.0), len(on) - 1 - on[::-1].index(4.0)
    assert set(on[first : last + 1]) == {4.0}
    assert set(on[:first] + on[last + 1 :]) == {-1.0}
    # From where the drone begins to go East to the last point before it is 40 m on.
    assert float(rows[last + 1]["longitude"]) == max(float(row["longitude"]) for row in rows)
    assert all(row[f"actiontype{n}"] in ("-1", "0") for row in rows for n in range(1, 16))
    assert "(shot half, t = " in emission.notes[0]


@pytest.mark.slow
def test_a_shot_that_stands_is_filmed_by_formats_that_tell_intervals_of_legs() -> None:
    low, high = (0.0, -60.0, 0.0, 1.5, 0.0), (0.0, -60.0, 20.0, 1.5, 0.0)
    back = (30.0, -60.0, 20.0, 1.5, 0.0)
    moves: list[Move] = [
        ("takeoff", None, 8.0, high),
        ("shot", "half", 6.0, high),
        ("return", None, 9.0, back),
    ]
    emission = LITCHI.emit(
        plan(flight(moves, pad=low), mission=mission(Photos(seconds=2.0)), autopilot="dji-fly")
    )
    assert [d.code for d in emission.diagnostics] == ["E124"]


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
