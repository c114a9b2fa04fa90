"""Return height, rally points and lost links in mission files, read by local names and as plain JSON."""

from __future__ import annotations

import io
import json
import xml.etree.ElementTree as ET
from zipfile import ZipFile

import numpy as np
import pytest

from shotc.diag.registry import registry
from shotc.emit.dji import EMITTER as DJI
from shotc.emit.litchi import EMITTER as LITCHI
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.geom.earth import of_world
from shotc.ir.drone import Safety
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.front_passes import resolved
from tests.support.mavlink_flights import plan, retold, straight

RALLY = ((30.0, -60.0, 0.0), (-30.0, -70.0, 0.0))


def config(data: bytes, name: str = "waylines.wpml") -> dict[str, str | None]:
    with ZipFile(io.BytesIO(data)) as archive:
        root = ET.fromstring(archive.read(f"wpmz/{name}"))
    (mission,) = (e for e in root.iter() if e.tag.endswith("}missionConfig"))
    return {e.tag.rpartition("}")[2]: e.text for e in mission.iter()}


@pytest.mark.slow
def test_a_plan_of_qgroundcontrol_has_the_rally_points_at_the_height_of_the_return() -> None:
    safety = Safety("return", 45.0, RALLY)
    emission = MAVLINK.emit(retold(orbit_plan(), safety=safety))
    rally = json.loads(emission.artifacts[0].data)["rallyPoints"]
    origin = orbit_mission().origin
    assert origin is not None
    assert rally["version"] == 2
    for point, place in zip(rally["points"], RALLY, strict=True):
        lat, lon, _ = of_world(np.array([place]), origin)[0]
        assert point == [pytest.approx(lat, abs=1e-8), pytest.approx(lon, abs=1e-8), 45]
    told = emission.notes[-1]
    assert "set NAV_DLL_ACT and NAV_RCL_ACT to 2 (return), and RTL_RETURN_ALT to 45 m" in told


@pytest.mark.slow
def test_without_a_height_rally_points_are_as_high_as_the_flight() -> None:
    emission = MAVLINK.emit(retold(orbit_plan(), safety=Safety(None, None, RALLY)))
    assert {p[2] for p in json.loads(emission.artifacts[0].data)["rallyPoints"]["points"]} == {20}


@pytest.mark.parametrize(
    ("autopilot", "asked", "words"),
    [
        ("px4", None, "NAV_DLL_ACT, NAV_RCL_ACT, RTL_RETURN_ALT"),
        ("px4", "land", "NAV_DLL_ACT and NAV_RCL_ACT to 3 (land)"),
        ("px4", "continue", "NAV_DLL_ACT to 0 (disabled)"),
        ("ardupilot", None, "FS_GCS_ENABLE, FS_THR_ENABLE, RTL_ALT"),
        ("ardupilot", "hover", "FS_GCS_ENABLE and FS_THR_ENABLE to 7 (brake)"),
        ("ardupilot", "return", "RTL_ALT to 4500 cm"),
    ],
)
def test_vehicles_are_told_what_is_to_be_set_in_them(autopilot, asked, words) -> None:
    safety = None if asked is None else Safety(asked, 45.0, ())
    note = MAVLINK.emit(plan(straight(), autopilot=autopilot, safety=safety)).notes[-1]
    assert note.startswith(f"{autopilot} cam1: the vehicle's own settings decide what happens when the link")
    assert words in note


@pytest.mark.long
@pytest.mark.parametrize(
    ("asked", "exit_", "action", "words"),
    [
        (None, "executeLostAction", "goBack", "returns home, as the file says"),
        ("hover", "executeLostAction", "hover", "hovers, as the file says"),
        ("land", "executeLostAction", "landing", "lands where it is"),
        ("continue", "goContinue", "goBack", "flies on, as the file says; some machines do not"),
    ],
)
def test_dji_files_say_what_is_done(asked, exit_, action, words) -> None:
    safety = None if asked is None else Safety(asked, None, ())
    emission = DJI.emit(plan(straight(), autopilot="dji-fly", safety=safety))
    for name in ("waylines.wpml", "template.kml"):
        told = config(emission.artifacts[0].data, name)
        assert (told["exitOnRCLost"], told["executeRCLostAction"]) == (exit_, action)
    assert words in emission.notes[-2]


@pytest.mark.slow
def test_pilot_2_returns_at_the_height_that_is_asked_and_rally_points_are_told_as_left_out() -> None:
    emission = DJI.emit(plan(straight(), autopilot="pilot-2", safety=Safety(None, 60.0, RALLY)))
    assert config(emission.artifacts[0].data)["globalRTHHeight"] == "60"
    assert "returns home, as the file says, 60 m above its pad" in emission.notes[-1]
    assert [d.code for d in emission.diagnostics] == ["E123"]
    assert registry()["E123"].severity == "warning"
    litchi = LITCHI.emit(plan(straight(), autopilot="dji-fly", safety=Safety("land", 60.0, ())))
    told = "not the table: set `land` and a return at 60 m"
    assert any(told in n for n in litchi.notes)


MISSION = """\
shotc: 1
mission: safe
world: {zones: {tower: {keep: out, cylinder: {center: [0, 40], radius: 5, height: [0, 30]}}}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -40, 0], safety: SAFETY}}
shots:
  - {id: look, kind: static, drone: cam, at: [0, -30, 8], look_at: mast}
"""


@pytest.mark.parametrize(
    ("safety", "code", "words"),
    [
        ("{return_height: 20}", "G053", "`cam` would return lower than zone `tower` is high"),
        ("{rally: [[20, -40], [2, 41]]}", "G054", "rally point 2 of `cam` is in zone `tower`"),
        ("{link_lost: explode}", "S", "explode"),
        ("{return_height: -3}", "S", "below"),
        ("{rally: [5]}", "S", ""),
    ],
)
def test_bad_safety_is_told_at_its_line(safety: str, code: str, words: str) -> None:
    _, found = resolved(MISSION.replace("SAFETY", safety))
    (told,) = found
    assert told.code.startswith(code)
    assert words in told.message
    assert told.labels[0].span.line == 5


def test_the_height_that_is_proposed_is_enough() -> None:
    _, (told,) = resolved(MISSION.replace("SAFETY", "{return_height: 20}"))
    # 30 m of tower, 0.6 m of body, 2 m of clearance.
    assert told.help == "write `return_height: 33 m`"
    assert resolved(MISSION.replace("SAFETY", "{return_height: 33}"))[1] == []
