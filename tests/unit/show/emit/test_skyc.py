"""The show file, read back by a reader of its own: where the drones are, how they shine, what is said."""

from __future__ import annotations

import itertools
from base64 import b64decode
from functools import cache
from io import BytesIO
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest

from shotc.emit.audience import ASPECT, audience
from shotc.geom.fleet_spline import places
from shotc.geom.solids import Cylinder
from shotc.ir.light_colors import light_colors
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.skyc import EMITTER
from shotc.show.emit.skyc.light_programs import program
from tests.support import show_flights, skyc_reader
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.skyc_reader import color_at, place_at

STEPS = (0.5, 0.4737)


def read(plan: VerifiedIR) -> dict[str, Any]:
    (artifact,) = EMITTER.emit(plan).artifacts
    with ZipFile(BytesIO(artifact.data)) as zipped:
        assert zipped.namelist() == ["show.json"]
    return skyc_reader.read(artifact.data)


@cache
def content(step: float = 0.5) -> dict[str, Any]:
    return read(show_flights.plan(step=step))


def north_west_up(points: np.ndarray) -> np.ndarray:
    return np.stack([points[..., 1], -points[..., 0], points[..., 2]], axis=-1)


@pytest.mark.slow
@pytest.mark.parametrize("step", STEPS)
def test_drones_are_where_the_plan_has_them(step: float) -> None:
    flight = show_flights.plan(step=step).trajectory.fleets[0]
    times = np.linspace(0.0, float(flight.breaks[-1]), 701)
    wanted = north_west_up(places(flight.breaks, flight.coef, times))
    (note,) = EMITTER.emit(show_flights.plan(step=step)).notes
    promised = float(note.split(" mm")[0].split()[-1]) / 1e3
    assert promised < 1e-3
    for drone, path in list(zip(content(step)["swarm"]["drones"], wanted, strict=True))[::7]:
        found = [place_at(drone["settings"]["trajectory"], t) for t in times]
        assert np.linalg.norm(np.array(found) - path, axis=1).max() <= promised + 5e-6


@pytest.mark.slow
@pytest.mark.parametrize("step", STEPS)
def test_key_points_are_as_the_server_wants_them(step: float) -> None:
    for drone in content(step)["swarm"]["drones"]:
        settings = drone["settings"]
        trajectory = settings["trajectory"]
        points = trajectory["points"]
        millis = [round(t * 1000) for t, _, _ in points]
        assert [t * 1000 for t, _, _ in points] == pytest.approx(millis, abs=1e-9)
        assert millis[0] == 0
        assert all(b > a for a, b in itertools.pairwise(millis))
        assert points[0][2] == []
        assert {len(control) for _, _, control in points} <= {0, 2}
        assert settings["home"] == points[0][1]
        assert settings["landAt"] == points[-1][1]
        assert trajectory["landingTime"] == pytest.approx(trajectory["takeoffTime"] + points[-1][0])
        assert trajectory["version"] == 1


@pytest.mark.long
@pytest.mark.parametrize("name", skyc_reader.DAMAGE)
def test_the_reader_knows_what_the_loader_refuses(name: str) -> None:
    assert list(skyc_reader.faults(skyc_reader.damaged(content(), name)))


def test_it_takes_few_points_and_no_waiting() -> None:
    trajectory = content()["swarm"]["drones"][0]["settings"]["trajectory"]
    # Three seconds on the pad before take-off, three after landing: the control points round the corner move.
    assert 2.0 <= trajectory["takeoffTime"] <= 3.0
    assert 67.0 <= trajectory["landingTime"] <= 68.0
    assert len(trajectory["points"]) < len(show_flights.plan().trajectory.fleets[0].breaks) / 3
    assert any(control == [] for _, _, control in trajectory["points"][1:])


def test_lights_shine_as_planned() -> None:
    flight = show_flights.plan().trajectory.fleets[0]
    times = np.arange(0.0, 75.0, 0.25)
    wanted = light_colors(flight, times)[0]
    code = b64decode(content()["swarm"]["drones"][0]["settings"]["lights"]["data"])
    found = np.array([color_at(code, t) for t in times])
    assert np.abs(found - wanted).max() <= 1.0


def test_light_programs() -> None:
    red, blue = bytes([255, 0, 0]), bytes([0, 0, 255])
    assert program([0], [red]) == bytes([4, 255, 0, 0, 1, 0])
    # A jump is a colour that is set; 200 steps are two bytes, the low seven bits first.
    assert program([200, 200, 210], [red, blue, blue]) == bytes([4, 255, 0, 0, 0xC8, 1, 4, 0, 0, 255, 10, 0])
    fade = program([50, 100], [red, blue])
    assert fade == bytes([4, 255, 0, 0, 50, 8, 0, 0, 255, 50, 4, 0, 0, 255, 1, 0])


def test_the_last_order_stands() -> None:
    code = b64decode(content()["swarm"]["drones"][0]["settings"]["lights"]["data"])
    assert code[-6] == 4
    assert code[-1] == 0


def test_what_is_said_of_the_show() -> None:
    found = content()
    assert found["version"] == 1
    assert found["meta"]["title"] == "shapes-in-the-sky"
    assert found["meta"]["segments"] == {"takeoff": [0.0, 9.0], "show": [9.0, 56.0], "landing": [56.0, 70.0]}
    assert found["environment"]["type"] == "outdoor"
    assert found["environment"]["location"] == {"origin": [47.3769, 8.5417, 408.0], "orientation": 0}
    settings = found["settings"]
    assert [(c["name"], c["time"]) for c in settings["cues"]["items"]] == [
        ("shapes: sphere", 26.0),
        ("shapes: cube", 39.0),
    ]
    assert settings["validation"] == {
        "maxAltitude": 90.0,
        "maxVelocityXY": 8.0,
        "maxVelocityZ": 3.0,
        "maxVelocityZUp": 4.0,
        "minDistance": 1.0,
    }
    (fence,) = settings["geofence"]["polygons"]
    assert fence["isInclusion"]
    assert fence["points"][0] == [-30.0, 60.0, 0.0]  # the corner in the South-West: 30 m South, 60 m West
    names = [drone["settings"]["name"] for drone in found["swarm"]["drones"]]
    assert names[0] == "swarm-01"
    assert names[-1] == "swarm-60"


@pytest.mark.slow
@pytest.mark.parametrize(
    "eye", [(0.0, -50.0, 2.0), (80.0, 60.0, 40.0), (5.0, 160.0, 1.0), (-70.0, 0.0, 90.0), None]
)
def test_the_camera_sees_the_show(eye: tuple[float, float, float] | None) -> None:
    plan = show_flights.plan(show_flights.mission(displays=(show_flights.display(viewpoint=eye),)))
    (camera,) = read(plan)["environment"]["cameras"]
    seen = audience(plan, plan.trajectory.keyframes.mission.displays[0], ASPECT)
    w, x, y, z = camera["orientation"]
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    ahead, right = turn @ [0.0, 0.0, -1.0], turn @ [1.0, 0.0, 0.0]
    look = np.array(
        [np.cos(seen.pitch) * np.cos(seen.yaw), np.cos(seen.pitch) * np.sin(seen.yaw), np.sin(seen.pitch)]
    )
    assert ahead == pytest.approx(north_west_up(look), abs=1e-7)
    assert right[2] == pytest.approx(0.0, abs=1e-8)
    assert camera["position"] == pytest.approx(north_west_up(np.array(seen.eye)).tolist(), abs=1e-4)
    # Every drone of the shot is inside a frame of this focal length on a sensor 36 mm wide.
    flight = plan.trajectory.fleets[0]
    cloud = north_west_up(places(flight.breaks, flight.coef, np.linspace(26.0, 42.0, 30)).reshape(-1, 3))
    local = (cloud - camera["position"]) @ turn
    half = 18.0 / camera["focalLength"]
    assert (local[:, 2] < 0).all()
    assert np.abs(local[:, 0] / local[:, 2]).max() < half
    assert np.abs(local[:, 1] / local[:, 2]).max() < half / ASPECT


@pytest.mark.slow
def test_the_same_plan_gives_the_same_bytes() -> None:
    assert EMITTER.emit(show_flights.plan()).artifacts == EMITTER.emit(show_flights.plan()).artifacts


@pytest.mark.slow
def test_without_an_origin_the_show_has_no_place() -> None:
    plan = show_flights.plan(show_flights.mission(origin=None))
    assert [d.code for d in EMITTER.emit(plan).diagnostics] == ["E111"]
    assert "location" not in read(plan)["environment"]


def test_a_show_may_be_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shotc.show.emit.skyc.MOST_DRONES", 59)
    emission = EMITTER.emit(show_flights.plan())
    assert emission.artifacts == ()
    assert [d.code for d in emission.diagnostics] == ["E112"]


@pytest.mark.slow
def test_a_zone_that_the_pads_are_outside_of_is_no_fence() -> None:
    stage = replace(show_flights.FIELD, name="stage", solid=Cylinder((0.0, 60.0), 30.0, 20.0, 80.0))
    plan = show_flights.plan(show_flights.mission(zones=(show_flights.FIELD, stage)))
    assert [d.code for d in EMITTER.emit(plan).diagnostics] == ["E113"]
    found = read(plan)["settings"]
    assert len(found["geofence"]["polygons"]) == 1
    assert found["validation"]["maxAltitude"] == 80.0


def test_two_fleets_are_one_show() -> None:
    others = show_flights.fleet(12, "others", (60.0, 0.0, 0.0))
    asked = show_flights.mission(fleets=(show_flights.fleet(20), others), zones=())
    found = read(show_flights.plan(asked))
    assert len(found["swarm"]["drones"]) == 32
    assert found["settings"]["validation"]["maxAltitude"] == float(np.ceil(55.0))


def test_no_fleet_no_file() -> None:
    emission = EMITTER.emit(orbit_plan())
    assert emission.artifacts == ()
    assert emission.diagnostics == ()
    assert len(emission.notes) == 1
