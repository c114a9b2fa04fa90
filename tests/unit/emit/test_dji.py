"""DJI missions: structure as the apps write it, points for all flight models, what is refused and told."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from functools import cache
from itertools import pairwise
from math import pi
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pytest

from shotc.diag.registry import registry
from shotc.emit.dji import EMITTER, FORMAT
from shotc.emit.dji.kmz import read_kmz, write_kmz
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.emit.waypoints.machine_files import joined, split
from shotc.emit.waypoints.stations import SHORTEST_LEG_M
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.ir.mission import Zone
from shotc.ir.path import HFOV
from shotc.ir.phases import Phase
from shotc.ir.promise import Promise
from shotc.ir.trajectory import DroneTrajectory
from tests.support.film_plans import TOWER, orbit_mission, orbit_plan
from tests.support.mavlink_flights import flight, plan, retold, straight
from tests.support.records import replace

pytestmark = pytest.mark.slow  # one plan is written in all forms

FLY = [  # of a point in DJI Fly, in the order of the app
    "Point", "index", "executeHeight", "waypointSpeed", "waypointHeadingParam", "waypointTurnParam",
    "useStraightLine", "actionGroup", "waypointGimbalHeadingParam",
]  # fmt: skip
PILOT = [  # of a point in DJI Pilot 2
    "Point", "index", "executeHeight", "waypointSpeed", "waypointHeadingParam", "waypointTurnParam",
    "useStraightLine", "waypointGimbalHeadingParam", "isRisky", "actionGroup", "waypointWorkType",
]  # fmt: skip
HEADING = [
    "waypointHeadingMode", "waypointHeadingAngle", "waypointPoiPoint", "waypointHeadingAngleEnable",
    "waypointHeadingPathMode", "waypointHeadingPoiIndex",
]  # fmt: skip


def local(element):
    return element.tag.rpartition("}")[2]


def once(elements):
    """Names in order, each run of the same name once."""
    names = [local(e) for e in elements]
    return [n for i, n in enumerate(names) if i == 0 or names[i - 1] != n]


def texts(root, name):
    return [e.text for e in root.iter() if local(e) == name]


def parts(data):
    with ZipFile(io.BytesIO(data)) as archive:
        return {i.filename: (i, archive.read(i)) for i in archive.infolist()}


def emitted(source, autopilot="dji-fly"):
    return EMITTER.emit(retold(source, autopilot=autopilot))


@cache
def of_orbit(autopilot):
    """The sample plan, emitted once for all tests that read it."""
    return emitted(orbit_plan(), autopilot)


@pytest.fixture
def orbit():
    return of_orbit("dji-fly")


def waylines(emission):
    return ET.fromstring(parts(emission.artifacts[0].data)["wpmz/waylines.wpml"][1])


def test_the_file_has_two_entries_and_no_folders(orbit):
    assert [a.name for a in orbit.artifacts] == ["cam1.kmz"]
    entries = parts(orbit.artifacts[0].data)
    assert list(entries) == ["wpmz/template.kml", "wpmz/waylines.wpml"]
    assert all(info.compress_type == ZIP_DEFLATED for info, _ in entries.values())


@pytest.mark.parametrize(
    ("autopilot", "order", "space"),
    [("dji-fly", FLY, "http://www.uav.com/wpmz/1.0.2"), ("pilot-2", PILOT, "http://www.dji.com/wpmz/1.0.6")],
)
def test_elements_stand_in_the_order_of_the_app(autopilot, order, space):
    root = waylines(of_orbit(autopilot))
    marks = [e for e in root.iter() if local(e) == "Placemark"]
    assert all(once(mark) == [n for n in order if n in once(mark)] for mark in marks)
    assert once(marks[0]) == order
    assert all(e.tag.startswith(("{" + space, "{http://www.opengis.net/kml/2.2}")) for e in root.iter())
    assert [local(e) for e in marks[0][4]] == HEADING
    assert texts(root, "index") == [str(i) for i in range(len(marks))]
    turns = texts(root, "waypointTurnMode")
    assert "Stop" in turns[0]
    assert "Stop" in turns[-1]
    assert any("Pass" in turn for turn in turns)


def test_no_number_is_used_twice_and_no_two_points_are_one_place(orbit):
    root = waylines(orbit)
    ids = texts(root, "actionGroupId") + texts(root, "actionId")
    assert len(set(ids)) == len(ids)
    places = list(zip(texts(root, "coordinates"), texts(root, "executeHeight"), strict=True))
    assert len(set(places)) == len(places)
    assert "nan" not in ET.tostring(root, encoding="unicode").lower()


def test_the_gimbal_turns_evenly_to_the_pitch_of_the_next_point(orbit):
    root = waylines(orbit)
    points = texts(root, "waypointGimbalPitchAngle")
    rotations = [
        a for a in root.iter() if local(a) == "action" and "gimbalEvenlyRotate" in texts(a, local(a[1]))
    ]
    assert [texts(a, "gimbalPitchRotateAngle")[0] for a in rotations] == points[1:]


def test_the_template_holds_the_points_for_pilot_2_alone():
    sizes = {}
    for autopilot in ("dji-fly", "pilot-2"):
        data = of_orbit(autopilot).artifacts[0].data
        root = ET.fromstring(parts(data)["wpmz/template.kml"][1])
        sizes[autopilot] = len([e for e in root.iter() if local(e) == "Placemark"])
        assert texts(root, "finishAction") == ["autoLand"]
    assert sizes == {"dji-fly": 0, "pilot-2": len(read_kmz(data))}
    highest = max(p.place.alt for p in read_kmz(data))
    assert texts(root, "globalRTHHeight") == [f"{highest + 10:.0f}"]
    assert texts(root, "takeOffSecurityHeight") == [f"{read_kmz(data)[0].place.alt:.1f}"]


def test_what_is_read_is_what_was_written(orbit):
    data = orbit.artifacts[0].data
    points = read_kmz(data)
    assert read_kmz(write_kmz(points, orbit_mission().drones[0]._replace(autopilot="dji-fly"))) == points
    assert [a.kind for p in points for a in p.actions] == ["start", "stop"]


def test_few_points_keep_the_orbit_under_all_models_and_the_note_says_it(orbit):
    points = read_kmz(orbit.artifacts[0].data)
    assert orbit.diagnostics == ()
    note, _, copied = orbit.notes
    assert "take off from the pad" in copied
    assert note.startswith(f"dji-fly cam1.kmz: {len(points)} waypoints, position within ")
    worst = float(note.split("adds at most ")[1].split()[0])
    mean = float(note.split(" and ")[1].split()[0])
    assert worst <= 0.05
    assert mean <= 0.02
    assert f"of {len(FORMAT.shapes) * 3} flight models" in note
    assert len(points) < 60


@pytest.mark.slow
def test_the_same_plan_gives_the_same_bytes(orbit):
    assert emitted(orbit_plan()) == orbit


def weaving(amplitude, period):
    """East along y = -60 at 20 m, to and fro across it, the tower watched from the side."""
    time = np.linspace(0.0, 20.0, 81)
    value = np.zeros((81, 7))
    value[:, 0] = 2.0 * time - 20.0
    value[:, 1] = -60.0 + amplitude * np.cos(2 * pi * time / period)
    value[:, 2], value[:, 3], value[:, 5], value[:, HFOV] = 20.0, pi / 2, pi / 2, 1.2
    rate = np.gradient(value, time, axis=0)
    weave = quintic_hermite(time + 8.0, value, rate, np.zeros_like(value))
    pad = value[0].copy()
    pad[2] = 0.0
    still = np.zeros((2, 7))
    ends = still.copy()
    ends[1] = rate[0]
    up = quintic_hermite(np.array([0.0, 8.0]), np.stack([pad, value[0]]), ends, still)
    curve = Piecewise(np.concatenate([[0.0], weave.breaks]), np.concatenate([up.ctrl, weave.ctrl]))
    return DroneTrajectory(
        "cam1", curve, (Phase("takeoff", None, 0.0, 8.0), Phase("shot", "half", 8.0, 28.0)), (), ()
    )


@pytest.mark.long
def test_a_curve_that_would_swing_into_a_zone_is_not_written():
    """Legs as short as they may be cut the bows of this weave by 0.15 m, and a pole stands in each."""
    poles = tuple(
        Zone(
            f"pole-{i}",
            "out",
            Cylinder((-16.0 + 4.0 * i, -60.0), 0.22, 0.0, 40.0),
            ("world", "zones", f"pole-{i}"),
        )
        for i in range(8)
    )
    source = plan(weaving(1.0, 2.0), mission=replace(orbit_mission(), zones=poles), autopilot="dji-fly")
    emission = EMITTER.emit(source)
    assert emission.artifacts == ()
    codes = {d.code for d in emission.diagnostics}
    assert codes == {"E119"}
    assert registry()["E119"].severity == "error"
    told = emission.diagnostics[0]
    assert "too near to zone `pole-" in told.message
    assert "t = " in told.notes[0]
    free = replace(source.trajectory.keyframes.mission, zones=())
    assert EMITTER.emit(plan(weaving(1.0, 2.0), mission=free, autopilot="dji-fly")).artifacts


@pytest.mark.slow
def test_points_are_never_nearer_to_each_other_than_machines_take():
    geo_free = EMITTER.emit(
        plan(weaving(1.0, 2.0), mission=replace(orbit_mission(), zones=()), autopilot="dji-fly")
    )
    points = read_kmz(geo_free.artifacts[0].data)
    east = np.array([p.place.lon for p in points]) * 111320 * np.cos(np.radians(47.3769))
    north = np.array([p.place.lat for p in points]) * 110574 * 1.0055
    up = np.array([p.place.alt for p in points])
    assert np.linalg.norm(np.diff([east, north, up]), axis=0).min() > SHORTEST_LEG_M - 0.03


@pytest.mark.slow
def test_a_camera_that_turns_while_the_drone_stands_is_told_with_its_error():
    low, high, turned = (
        (0.0, -60.0, 0.0, pi / 2, 0.0),
        (0.0, -60.0, 20.0, pi / 2, 0.0),
        (0.0, -60.0, 20.0, pi / 2 + 0.6, 0.0),
    )
    moves = [
        ("takeoff", None, 8.0, high),
        ("shot", "half", 6.0, turned),
        ("return", None, 9.0, (30.0, -60.0, 20.0, pi, 0.0)),
    ]
    emission = EMITTER.emit(plan(flight(moves, pad=low), target="tower", autopilot="dji-fly"))
    (told,) = emission.diagnostics
    assert told.code == "E117"
    assert "shot half" in told.message
    assert "turns by 34 deg while the drone stands" in told.notes[1]


@pytest.mark.slow
def test_a_zoom_is_told_with_what_it_does_to_the_edge_of_the_picture():
    trajectory = straight()
    ctrl = trajectory.curve.ctrl.copy()
    ctrl[1, :, HFOV] = np.radians(np.linspace(70, 50, 6))
    zooming = replace(trajectory, curve=Piecewise(trajectory.curve.breaks, ctrl))
    mission = orbit_mission()
    mission = replace(mission, shots=(replace(mission.shots[0], promise=Promise()),))
    (told,) = EMITTER.emit(plan(zooming, mission=mission, autopilot="dji-fly")).diagnostics
    assert told.code == "E105"
    # 1 - tan 25 / tan 35 is 0.334; the last instant of the shot belongs to the way back.
    off = float(told.notes[0].split("is up to ")[1].split()[0])
    assert off == pytest.approx(1 - np.tan(np.radians(25)) / np.tan(np.radians(35)), abs=0.005)


@pytest.mark.slow
def test_a_target_that_moves_drifts_by_the_worst_time_error():
    mission = orbit_mission()
    moving = TOWER._replace(track=Track((0.0,), ((0.0, 0.0, 12.0),), after=(2.0, 0.0, 0.0)))
    emission = EMITTER.emit(
        plan(straight(), mission=replace(mission, targets=(moving,)), target="tower", autopilot="dji-fly")
    )
    told = next(d for d in emission.diagnostics if d.code == "E118")
    lag, drift = (float(told.notes[0].split("up to ")[i].split()[0]) for i in (1, 2))
    assert lag > 0.3
    assert drift == pytest.approx(2 * lag, abs=0.25)
    assert len(told.notes) == 2


@pytest.mark.slow
def test_a_target_whose_way_the_drone_crosses_is_told_as_such():
    crossing = TOWER._replace(track=Track((0.0,), ((20.0, -200.0, 12.0),), after=(0.0, 5.0, 0.0)))
    mission = replace(orbit_mission(), targets=(crossing,))
    emission = EMITTER.emit(plan(straight(), mission=mission, target="tower", autopilot="dji-fly"))
    told = next(d for d in emission.diagnostics if d.code == "E118")
    assert told.notes[2] == "timing alone keeps the drone clear of `tower`, whose way it crosses"


@pytest.mark.slow
def test_drones_that_timing_alone_keeps_apart_get_no_files():
    mission = orbit_mission()
    one = mission.drones[0]._replace(autopilot="dji-fly")
    far = one._replace(name="cam2", home=(0.0, -50.0, 0.0))
    first = straight()
    source = plan(first)

    def pair(other):
        keyframes = replace(source.trajectory.keyframes, mission=replace(mission, drones=(one, far)))
        return replace(
            source, trajectory=replace(source.trajectory, keyframes=keyframes, drones=(first, other))
        )

    meeting = EMITTER.emit(pair(replace(first, drone="cam2")))
    assert meeting.artifacts == ()
    assert [d.code for d in meeting.diagnostics] == ["E120"]
    assert registry()["E120"].severity == "error"
    up = first.curve.ctrl.copy()
    up[..., 2] += 30.0
    above = replace(first, drone="cam2", curve=Piecewise(first.curve.breaks, up))
    apart = far._replace(home=(0.0, -60.0, 30.0))
    keyframes = replace(source.trajectory.keyframes, mission=replace(mission, drones=(one, apart)))
    free = replace(source, trajectory=replace(source.trajectory, keyframes=keyframes, drones=(first, above)))
    assert "E120" not in [d.code for d in EMITTER.emit(free).diagnostics]


@pytest.mark.slow
def test_a_drone_that_timing_keeps_apart_from_one_with_a_clock_gets_no_file():
    mission = orbit_mission()
    one = mission.drones[0]._replace(autopilot="dji-fly")
    other = one._replace(name="cam2", home=(0.0, -50.0, 0.0), autopilot="px4")
    first = straight()
    source = plan(first)
    keyframes = replace(source.trajectory.keyframes, mission=replace(mission, drones=(one, other)))
    flights = (first, replace(first, drone="cam2"))
    emission = EMITTER.emit(
        replace(source, trajectory=replace(source.trajectory, keyframes=keyframes, drones=flights))
    )
    assert emission.artifacts == ()
    assert emission.diagnostics[0].message == (
        "no file is written for cam1: timing alone keeps cam1 and cam2 apart"
    )
    assert emission.notes[0] == "dji: no file for cam2 (px4), flown otherwise"


def test_a_mission_is_split_at_its_stops_and_joined_again(orbit):
    points = read_kmz(orbit.artifacts[0].data)
    blocks = split(points, np.ones(len(points) - 1), replace(FORMAT, most=9))
    assert [len(b) <= 9 for b in blocks] == [True] * len(blocks)
    assert all(a[-1].place == b[0].place for a, b in pairwise(blocks))
    again = joined(blocks)
    assert [p.place for p in again] == [p.place for p in points]
    assert [p.actions for p in again] == [p.actions for p in points]


def test_a_file_is_no_longer_than_its_format_takes(orbit):
    points = read_kmz(orbit.artifacts[0].data)
    legs = np.linspace(4.0, 12.0, len(points) - 1)
    blocks = split(points, legs, replace(FORMAT, farthest=50.0))
    assert len(blocks) > 1
    at = 0
    for block in blocks:
        assert legs[at : at + len(block) - 1].sum() <= 50.0
        at += len(block) - 1
    assert at == len(points) - 1
    assert len(split(points, legs, replace(FORMAT, farthest=1.0))) == len(points) - 1  # no leg is cut


@pytest.mark.parametrize(
    ("emitter", "autopilot", "fit"),
    [(EMITTER, "px4", "`mavlink`"), (MAVLINK, "dji-fly", "`dji` or `litchi`")],
)
def test_files_of_other_machines_are_not_written(emitter, autopilot, fit):
    emission = emitter.emit(retold(orbit_plan(), autopilot=autopilot))
    assert emission.artifacts == ()
    (told,) = emission.diagnostics
    assert told.code == "E116"
    assert fit in (told.help or "")


def test_without_an_origin_nothing_is_written():
    emission = emitted(orbit_plan(origin=False))
    assert emission.artifacts == ()
    assert [d.code for d in emission.diagnostics] == ["E101"]
