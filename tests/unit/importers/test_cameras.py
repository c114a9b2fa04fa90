"""Tours, animations and waypoints become missions of keyframes: the same cameras, and what was assumed."""

from __future__ import annotations

import io
import json
import zipfile
from math import cos, radians
from typing import Any

import numpy as np
import pymap3d
import pytest
import yaml
from scipy.spatial.transform import Rotation

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.emit import kml as kml_emitter
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.geom.camera import view
from shotc.importers.cameras.thin import PICTURE_ERROR_HALF_FRAMES
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from tests.support.camera_files import (
    GOOD,
    GOOD_LITCHI,
    GOOD_TOUR,
    LAT,
    LON,
    assumed,
    camera,
    fly,
    item,
    kml,
    litchi,
    made,
    plan_file,
    tour,
    waypoint,
)
from tests.support.compiled import compiled_text
from tests.support.film_plans import orbit_plan
from tests.support.film_sets import film_set

PLAN = orbit_plan()
CURVE = PLAN.trajectory.drones[0].curve
ALT = 408.0


def mission(format: str, data: bytes, **asked: Any) -> dict[str, Any]:
    result = made(format, data, **asked)
    assert result.text is not None, result.diagnostics
    assert not has_errors(check_source(result.text.encode(), "m.yaml", None).diagnostics), result.text
    return yaml.safe_load(result.text)


def keyframes(format: str, data: bytes, shot: int = 0, **asked: Any) -> list[dict[str, Any]]:
    return mission(format, data, **asked)["shots"][shot]["keyframes"]


def deg(text: str) -> float:
    return float(text.removesuffix(" deg"))


def lens_of(found: dict[str, Any]) -> float:
    return deg(found["drones"]["cam1"]["camera"]["hfov"])


def earth(place: list[float], origin: dict[str, float]) -> np.ndarray:
    """A place of an imported mission in W of the plan that it comes from."""
    globe = pymap3d.enu2geodetic(*place, origin["lat"], origin["lon"], origin["alt"])
    return np.array(pymap3d.geodetic2enu(*globe, LAT, LON, ALT))


def off(heading: float, pitch: float, state: np.ndarray) -> float:
    """Degrees between two ways to look, exact where they are small."""
    a, b = radians(90.0 - heading), radians(pitch)
    c, d = state[CAM_YAW], state[CAM_PITCH]
    one = np.array([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
    other = np.array([np.cos(c) * np.cos(d), np.sin(c) * np.cos(d), np.sin(d)])
    return float(np.degrees(2.0 * np.arcsin(np.linalg.norm(one - other) / 2.0)))


def tour_of(plan) -> bytes:
    return kml_emitter.EMITTER.emit(plan).artifacts[0].data


def test_a_tour_of_ours_comes_back_within_a_millimetre_and_a_hundredth_of_a_degree() -> None:
    back = mission("kml", tour_of(PLAN), every=True, ground=ALT)
    (shot,) = back["shots"]
    assert shot["id"] == "half"
    assert shot["timing"]["duration"] == pytest.approx(30.0, abs=1e-3)
    states = CURVE(np.linspace(22.0, 52.0, 61))
    assert len(shot["keyframes"]) == 61
    for keyframe, state in zip(shot["keyframes"], states, strict=True):
        assert np.linalg.norm(earth(keyframe["at"], back["world"]["origin"]) - state[:3]) < 1e-3
        assert off(deg(keyframe["heading"]), deg(keyframe["pitch"]), state) < 0.01
    assert lens_of(back) == pytest.approx(np.degrees(states[0, HFOV]), abs=1e-3)


@pytest.mark.slow
def test_what_comes_back_is_planned_through_the_same_cameras() -> None:
    text = made("kml", tour_of(PLAN), every=True, ground=ALT).text
    compiled = compiled_text(text, "none")
    assert compiled.plan is not None, compiled.diagnostics
    (drone,) = compiled.plan.trajectory.drones
    origin = yaml.safe_load(text)["world"]["origin"]
    for mark, state in zip(drone.keyframes, CURVE(np.linspace(22.0, 52.0, 61)), strict=True):
        flown = drone.curve(mark.time)
        assert np.linalg.norm(earth(flown[:3].tolist(), origin) - state[:3]) < 1e-3
        assert off(90.0 - np.degrees(flown[CAM_YAW]), np.degrees(flown[CAM_PITCH]), state) < 0.01
    (shot,) = [phase for phase in drone.phases if phase.shot]
    assert shot.end - shot.start == pytest.approx(30.0, abs=0.01)


def screen(at: np.ndarray, angles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Where a camera (heading, pitch, hfov, deg) shows points, (N, 2): by the camera of plans."""
    eye = view(radians(90.0 - angles[0]), radians(angles[1]), radians(angles[2]), 16 / 9)
    x, y, z = eye.to_camera(tuple((points - at).T))
    return np.column_stack([x / z / eye.half_width, -y / z / eye.half_height])


def ahead(at: np.ndarray, angles: np.ndarray, away: float) -> np.ndarray:
    """The middle and the corners of a camera's frame, at a depth."""
    turn = Rotation.from_euler("ZX", [-angles[0], angles[1]], degrees=True)  # of a camera that looks North
    k = np.tan(radians(angles[2]) / 2)
    frame = [(0, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)]
    return at + turn.apply([[away * u * k, away, away * v * k * 9 / 16] for u, v in frame])


@pytest.mark.slow
@pytest.mark.parametrize("plan", [PLAN, film_set()], ids=["orbit", "zoom"])
def test_cameras_that_are_left_out_are_implied_by_those_that_stay(plan) -> None:
    def rows(found: dict[str, Any]) -> np.ndarray:
        lens = found["drones"]["cam1"]["camera"].get("hfov")
        return np.array(
            [
                [*k["at"], deg(k["heading"]), deg(k["pitch"]), deg(k.get("hfov", lens))]
                for k in found["shots"][0]["keyframes"]
            ]
        )

    whole = rows(mission("kml", tour_of(plan), every=True, ground=ALT))
    kept = rows(mission("kml", tour_of(plan), ground=ALT))
    whole[:, 3], kept[:, 3] = np.unwrap(whole[:, 3], period=360), np.unwrap(kept[:, 3], period=360)
    assert len(kept) < 0.6 * len(whole)
    shares = np.linspace(0.0, 1.0, 201)[:, None]
    segment = -1
    for row in whole:
        if segment + 1 < len(kept) and np.allclose(row, kept[segment + 1]):
            segment += 1
            continue
        points = ahead(row[:3], row[3:], max(5.0, row[2]))
        own = screen(row[:3], row[3:], points)
        between = kept[segment] + shares * (kept[segment + 1] - kept[segment])
        changes = [np.linalg.norm(screen(b[:3], b[3:], points) - own, axis=1).max() for b in between]
        assert min(changes) < PICTURE_ERROR_HALF_FRAMES * 1.05
    assert segment == len(kept) - 1


def test_a_tour_that_zooms_has_a_zoom_lens_and_one_that_zooms_too_fast_no_duration() -> None:
    def zooming(seconds: float) -> dict[str, Any]:
        long = camera(lat=LAT + 1e-4).replace("<gx:horizFov>60<", "<gx:horizFov>30<")
        return mission("kml", kml(tour(fly(camera()), fly(long, seconds))))

    slow = zooming(10.0)
    short, tele = (float(f.removesuffix(" mm")) for f in slow["drones"]["cam1"]["camera"]["zoom"])
    angles = [np.degrees(2 * np.arctan(18.0 / f)) for f in (short, tele)]
    assert angles == pytest.approx([60.0, 30.0], abs=1e-3)
    assert angles[0] >= 60.0
    assert angles[1] <= 30.0
    assert [k["hfov"] for k in slow["shots"][0]["keyframes"]] == ["60.0000 deg", "30.0000 deg"]
    assert slow["shots"][0]["timing"] == {"duration": 10.0}
    assert "timing" not in zooming(3.9)["shots"][0]


def test_a_tour_keeps_its_time_its_waits_and_its_name() -> None:
    waiting = kml(
        tour(
            fly(camera(), 9.0),
            "<gx:Wait><gx:duration>3</gx:duration></gx:Wait>",
            fly(camera(lat=LAT + 2e-4), 7.0),
        )
    )
    (shot,) = mission("kml", waiting, times=True)["shots"]
    assert (shot["id"], shot["timing"]) == ("fly-past", {"duration": 10.0})
    assert [k.get("hold", 0) for k in shot["keyframes"]] == [3.0, 0]
    assert [k["time"] for k in shot["keyframes"]] == [0.0, 10.0]


def test_a_tour_that_is_too_fast_takes_what_the_drone_needs() -> None:
    result = made("kml", kml(tour(fly(camera()), fly(camera(lat=LAT + 1e-3), 2.0))))
    assert "timing" not in yaml.safe_load(result.text)["shots"][0]
    assert any("too fast for the drone" in message for _, message in assumed(result))


def test_a_place_that_is_looked_at_is_range_ahead_of_the_camera() -> None:
    look = (
        "<LookAt><longitude>8.5417</longitude><latitude>47.3769</latitude><heading>90</heading><tilt>60</tilt>"
        "<range>50</range></LookAt>"
    )
    above = camera(lat=LAT + 2e-4, alt=30, mode="relativeToGround")
    first, _ = keyframes("kml", kml(tour(fly(look), fly(above))))
    east, north, up = first["at"]
    assert up == pytest.approx(50 * cos(radians(60)), abs=1e-3)
    assert (deg(first["heading"]), deg(first["pitch"])) == (90.0, -30.0)
    origin = mission("kml", kml(tour(fly(look), fly(above))))["world"]["origin"]
    at = earth([east, north, up], origin)
    assert at[0] == pytest.approx(-50 * np.sin(radians(60)), abs=1e-2)


def test_placemarks_with_cameras_are_a_shot_and_a_kmz_is_unpacked() -> None:
    marks = kml(*(f"<Placemark>{camera(lat=LAT + k * 1e-4)}</Placemark>" for k in range(3)))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("files/photo.png", b"x")
        archive.writestr("doc.kml", marks)
    assert mission("kml", packed.getvalue()) == mission("kml", marks)
    assert len(keyframes("kml", marks, every=True)) == 3


def test_a_first_camera_above_the_continent_is_left_out() -> None:
    far = kml(tour(fly(camera(alt=3_000_000)), fly(camera()), fly(camera(lat=LAT + 2e-4))))
    result = made("kml", far)
    assert len(yaml.safe_load(result.text)["shots"][0]["keyframes"]) == 2
    assert any("3000 km from most others" in message for _, message in assumed(result))


def test_assumptions_stand_at_their_lines_and_as_comments() -> None:
    result = made(
        "kml", kml(tour(fly(camera(roll=12, tilt=150)), fly(camera(lat=LAT + 2e-4, heading="abc"))))
    )
    lines = GOOD_TOUR.decode().splitlines()
    found = {message: line for line, message in assumed(result)}
    assert lines[found["the camera is rolled by 12.0 deg"] - 1] == "<Camera>"
    assert "a pitch of 60.0 deg is out of a gimbal's range" in found
    assert "`abc` is no number" in found
    assert all(f"line {line}" in result.text for line in found.values())
    assert [d.code for d in made("kml", GOOD_TOUR, strict=True).diagnostics] == ["I005", "I005"]
    assert made("kml", GOOD_TOUR, strict=True).text is None


@pytest.mark.parametrize("form", ["euler", "degrees", "quaternion"])
def test_frames_of_blender_are_the_cameras_that_they_were(form: str) -> None:
    times = np.linspace(22.0, 52.0, 31)
    states = CURVE(times)
    turns = [
        Rotation.from_euler("Z", np.degrees(s[CAM_YAW]) - 90.0, degrees=True)
        * Rotation.from_euler("X", 90.0 + np.degrees(s[CAM_PITCH]), degrees=True)
        for s in states
    ]
    head, rotation = {
        "euler": ("rx,ry,rz", lambda r: r.as_euler("xyz")),
        "degrees": (
            "rotation_euler_x_deg,rotation_euler_y_deg,rotation_euler_z_deg",
            lambda r: r.as_euler("xyz", degrees=True),
        ),
        "quaternion": ("qw,qx,qy,qz", lambda r: r.as_quat()[[3, 0, 1, 2]]),
    }[form]
    lens = 18.0 / np.tan(states[0, HFOV] / 2) if form != "quaternion" else np.degrees(states[0, HFOV])
    rows = [
        ",".join(f"{v:.9f}" for v in [1 + 24 * (t - 22.0), *s[:3], *rotation(r), lens])
        for t, s, r in zip(times, states, turns, strict=True)
    ]
    data = "\n".join([f"frame,x,y,z,{head},{'hfov' if form == 'quaternion' else 'lens'}", *rows]).encode()
    found = mission("blender-camera", data, every=True, fps=24.0)
    assert found["shots"][0]["timing"]["duration"] == pytest.approx(30.0, abs=1e-3)
    assert lens_of(found) == pytest.approx(np.degrees(states[0, HFOV]), abs=1e-3)
    for keyframe, state in zip(found["shots"][0]["keyframes"], states, strict=True):
        assert np.linalg.norm(np.array(keyframe["at"]) - state[:3]) < 1e-3
        assert off(deg(keyframe["heading"]), deg(keyframe["pitch"]), state) < 0.01


def test_a_plan_of_waypoints_becomes_the_cameras_at_them() -> None:
    data = plan_file(
        item(22, 0, 0, 0, 0, LAT, LON, 10, frame=3),
        item(1000, -15, 20),
        waypoint(0, heading=350.0),
        item(205, -30, 0, 5),
        waypoint(20, 25.0, heading=None, hold=2),
        waypoint(40, 438.0, heading=10.0, frame=0),
        item(195, 0, 0, 0, 0, LAT, LON, 5, frame=3),
        waypoint(60),
        item(20),
        geoFence={"circles": [{"circle": {}}], "polygons": []},
    )
    found = mission("qgc", data)
    assert found["drones"]["cam1"]["home"] == [0, 0, 0]
    assert found["world"]["origin"] == {"lat": LAT, "lon": LON, "alt": ALT}
    one, two, three, four = found["shots"][0]["keyframes"]
    # What is told after a waypoint is told there.
    assert [(deg(k["heading"]), deg(k["pitch"])) for k in (one, two)] == [(355.0, -30.0), (5.0, -30.0)]
    assert two["hold"] == 2.0
    assert [k["at"][2] for k in (one, two, three)] == pytest.approx([20.0, 25.0, 30.0], abs=1e-3)
    assert three["look_at"] == four["look_at"] == pytest.approx([0.0, 0.0, 5.0], abs=1e-3)
    assert four["at"][1] == pytest.approx(66.7, abs=0.1)
    assert "`geoFence` is not imported" in [message for _, message in assumed(made("qgc", data))]


@pytest.mark.slow
def test_what_is_recorded_is_a_shot_of_its_own() -> None:
    (artifact,) = MAVLINK.emit(PLAN).artifacts
    items = json.loads(artifact.data)["mission"]["items"]
    on, stop = ([i["command"] for i in items].index(c) for c in (2500, 2501))
    filmed = [i for i in items[:stop] if i["command"] == 16][
        sum(i["command"] == 16 for i in items[:on]) - 1 :
    ]
    found = mission("qgc", artifact.data)
    (shot,) = found["shots"]
    assert len(shot["keyframes"]) == len(filmed)
    ends = [earth(shot["keyframes"][i]["at"], found["world"]["origin"]) for i in (0, -1)]
    assert np.abs(ends - CURVE(np.array([22.0, 52.0]))[:, :3]).max() < 0.01


def test_focal_lengths_and_photos_of_qgroundcontrol_are_lenses_and_takes() -> None:
    data = plan_file(
        item(22, 0, 0, 0, 0, LAT, LON, 10, frame=3),
        item(531, 3, 24),
        item(1000, -15, 0),
        waypoint(0, heading=0.0),
        item(530, 0, 0),
        item(2000, 0, 2),
        item(532, 3, 20),
        waypoint(20, heading=0.0),
        item(531, 3, 50),
        waypoint(40, heading=0.0),
        item(2001),
        item(206, 5, 0, 1),
        waypoint(60, heading=0.0),
        item(206, 0),
        item(531, 2, 50),
        item(20),
    )
    found = mission("qgc", data)
    first, second = found["shots"]
    # 24 and 50 mm on a frame 36 mm wide; the second take begins where the first one ends.
    assert [deg(k["hfov"]) for k in first["keyframes"]] == pytest.approx([73.74, 39.598, 39.598], abs=0.01)
    assert len(second["keyframes"]) == 2
    told = [message for _, message in assumed(made("qgc", data))]
    for words in (
        "a focal length without the sensor's width",
        "a zoom that is no focal length",
        "photos are taken",
    ):
        assert told.count(words) == 1
    assert not any("which no camera needs" in words for words in told)


def test_waypoints_of_litchi_become_the_cameras_at_them() -> None:
    one, two, three = keyframes("litchi", GOOD_LITCHI)
    assert [(deg(k["heading"]), deg(k["pitch"])) for k in (one, two)] == [(0.0, -10.0), (30.0, -20.0)]
    assert (one["at"], two["hold"]) == ([0.0, 0.0, 20.0], 3.0)
    assert three["look_at"] == pytest.approx([0.0, 0.0, 5.0], abs=1e-3)
    feet = GOOD_LITCHI.replace(b"altitude(m),heading", b"altitude(ft),heading")
    assert keyframes("litchi", feet)[0]["at"][2] == pytest.approx(20 * 0.3048, abs=1e-4)
    recorded = litchi(
        *(
            f"{LAT + k * 1e-4},{LON},20,0,0,0,2,-10,{kind},0,0,0,0,0,0"
            for k, kind in enumerate((-1, 2, -1, 3, -1))
        )
    )
    assert len(keyframes("litchi", recorded, every=True)) == 3


@pytest.mark.parametrize("format", GOOD)
def test_what_is_thinned_keeps_both_ends(format: str) -> None:
    whole, kept = keyframes(format, GOOD[format], every=True), keyframes(format, GOOD[format])
    assert (whole[0], whole[-1]) == (kept[0], kept[-1])
