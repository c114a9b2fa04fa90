"""Zoom in mission files: what is commanded, read by other readers, shows what the plan shows."""

from __future__ import annotations

import io
import json
import xml.etree.ElementTree as ET
from math import radians, tan
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from shotc.diag.registry import registry
from shotc.emit.dji import EMITTER as DJI
from shotc.emit.dji import FORMAT as WPML
from shotc.emit.litchi import EMITTER as LITCHI
from shotc.emit.litchi import FORMAT as TABLE
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.emit.mavlink.dialect import DIALECTS
from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import LensRange
from shotc.ir.path import HFOV
from shotc.ir.promise import Promise
from shotc.ir.source import ZOOM_COMMANDS
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.support.film_plans import orbit_mission
from tests.support.mavlink_flights import Move, flight, plan, straight
from tests.support.records import replace

WIDE, LONG = radians(70), radians(30)
LENS = LensRange(radians(20), radians(80), radians(30), 0.0132)
OFF = 0.05  # half frames at the edge of the picture


def zooming(trajectory: DroneTrajectory, piece: int = 1) -> DroneTrajectory:
    """The same flight, that zooms in on one piece and out again on the way back."""
    ctrl = trajectory.curve.ctrl.copy()
    ctrl[piece, :, HFOV] = np.array([WIDE, WIDE, WIDE, LONG, LONG, LONG])
    ctrl[piece + 1, :, HFOV] = np.array([LONG, LONG, LONG, WIDE, WIDE, WIDE])
    return replace(trajectory, curve=Piecewise(trajectory.curve.breaks, ctrl))


def filmed(trajectory: DroneTrajectory, promise: Promise | None = None, **drone: object) -> VerifiedIR:
    mission = orbit_mission()
    shot = replace(mission.shots[0], promise=promise or Promise())
    return plan(trajectory, mission=replace(mission, shots=(shot,)), **({"lens": LENS} | drone))


def focal_mm(hfov: float) -> float:
    return 13.2 / (2 * tan(hfov / 2))


def items(emission: object) -> list[dict[str, object]]:
    return json.loads(emission.artifacts[0].data)["mission"]["items"]  # type: ignore[attr-defined,no-any-return]


def test_px4_zooms_to_focal_lengths_of_the_sensor_that_lead_from_end_to_end() -> None:
    emission = MAVLINK.emit(filmed(zooming(straight())))
    assert emission.diagnostics == ()
    zooms = [i["params"] for i in items(emission) if i["command"] == 531]
    assert {(p[0], i["frame"]) for p, i in zip(zooms, items(emission), strict=False)} <= {(3, 2), (3, 3)}
    values = [p[1] for p in zooms]
    assert values[0] == pytest.approx(focal_mm(WIDE), abs=0.01)
    # From the first picture to the last, each step at most twice as far as either side may be off.
    steps = np.array(values[: int(np.argmax(values)) + 1])
    assert (np.diff(steps) > 0).all()
    assert (np.diff(np.log(steps)) < 2 * np.log1p(OFF)).all()
    assert steps[-1] == pytest.approx(focal_mm(LONG), rel=OFF)
    assert "the edge of the picture zooms to within 0.0" in emission.notes[0]


def test_a_zoom_stands_before_recording_begins_and_follows_the_plan_leg_by_leg() -> None:
    trajectory = zooming(straight())
    listed = items(MAVLINK.emit(filmed(trajectory)))
    names = [i["command"] for i in listed]
    first = names.index(531)
    assert first < names.index(2500)
    # Flown by nobody of ours: each filmed leg has the lens that was commanded last.
    lens, east, worst = 0.0, 0.0, 0.0
    recording = False
    lon0 = next(i["params"][5] for i in listed if i["command"] == 16)  # type: ignore[index]
    for item in listed:
        params = item["params"]
        if item["command"] == 531:
            lens = params[1]  # type: ignore[index]
        if item["command"] in (2500, 2501):
            recording = item["command"] == 2500
        if item["command"] == 16:
            reached = (params[5] - lon0) * 111320 * np.cos(np.radians(47.3769))  # type: ignore[index]
            if recording:
                time = np.linspace(8.0, 18.0, 2001)
                pose = trajectory.curve(time)
                inside = (pose[:, 0] >= east - 0.3) & (pose[:, 0] <= reached + 0.3)
                half = np.tan(pose[inside, HFOV] / 2) if inside.any() else np.array([13.2 / (2 * lens)])
                worst = max(worst, float(np.abs(half / (13.2 / (2 * lens)) - 1).max()))
            east = reached
    assert worst < OFF + 0.02


def test_ardupilot_takes_a_share_of_the_range_of_focal_lengths(tmp_path: Path) -> None:
    emission = MAVLINK.emit(filmed(zooming(straight()), autopilot="ardupilot"))
    assert emission.diagnostics == ()
    zooms = [i["params"] for i in items(emission) if i["command"] == 531]
    assert {p[0] for p in zooms} == {2}  # type: ignore[index]
    short, long = focal_mm(LENS.widest), focal_mm(LENS.longest)
    share = 100 * (focal_mm(WIDE) - short) / (long - short)
    assert zooms[0][1] == pytest.approx(share, abs=0.01)  # type: ignore[index]
    mavwp = pytest.importorskip("pymavlink.mavwp", reason="pymavlink is not installed")
    file = tmp_path / "cam1.waypoints"
    file.write_bytes(emission.artifacts[1].data)
    loader = mavwp.MAVWPLoader()
    loader.load(str(file))
    read = [loader.wp(i) for i in range(loader.count())]
    told = [(wp.param1, wp.param2) for wp in read if wp.command == 531]
    assert told == [(z[0], pytest.approx(z[1], abs=1e-3)) for z in zooms]


def wpml(data: bytes) -> ET.Element:
    with ZipFile(io.BytesIO(data)) as archive:
        return ET.fromstring(archive.read("wpmz/waylines.wpml"))


def local(element: ET.Element) -> str:
    return element.tag.rpartition("}")[2]


def lenses(root: ET.Element) -> list[tuple[int, float, str]]:
    """Index of the point, focal length and mode of the group of every zoom."""
    found = []
    for group in (e for e in root.iter() if local(e) == "actionGroup"):
        text = {local(e): e.text for e in group.iter()}
        for action in (e for e in group.iter() if local(e) == "action"):
            told = {local(e): e.text or "" for e in action.iter()}
            if told["actionActuatorFunc"] == "zoom":
                assert told["isUseFocalFactor"] == told["payloadPositionIndex"] == "0"
                index = int(text["actionGroupStartIndex"] or "")
                found.append((index, float(told["focalLength"]), text["actionTriggerType"] or ""))
    return found


@pytest.mark.slow
def test_pilot_2_zooms_at_its_points() -> None:
    emission = DJI.emit(filmed(zooming(straight()), autopilot="pilot-2"))
    assert emission.diagnostics == ()
    found = lenses(wpml(emission.artifacts[0].data))
    values = np.array([focal for _, focal, _ in found])
    assert {trigger for _, _, trigger in found} == {"reachPoint"}
    rise = values[: int(values.argmax()) + 1]
    assert (np.diff(rise) > 0).all()
    assert (np.diff(np.log(rise)) < 2 * np.log1p(OFF)).all()
    assert values.max() == pytest.approx(focal_mm(LONG), rel=OFF)
    assert values.min() == pytest.approx(focal_mm(WIDE), rel=OFF)


@pytest.mark.slow
def test_pilot_2_zooms_while_it_stands_by_turns_of_zooming_and_waiting() -> None:
    low, high = (0.0, -60.0, 0.0, 1.5, 0.0), (0.0, -60.0, 20.0, 1.5, 0.0)
    back = (30.0, -60.0, 20.0, 1.5, 0.0)
    moves: list[Move] = [
        ("takeoff", None, 8.0, high),
        ("shot", "half", 12.0, high),
        ("return", None, 9.0, back),
    ]
    emission = DJI.emit(filmed(zooming(flight(moves, pad=low)), autopilot="pilot-2"))
    assert emission.diagnostics == ()
    root = wpml(emission.artifacts[0].data)
    at_first = [focal for index, focal, _ in lenses(root) if index == 0]
    assert len(at_first) > 5
    stays = [float(e.text or "") for e in root.iter() if local(e) == "hoverTime"]
    assert sum(stays) == pytest.approx(12.0, abs=0.11)
    assert "films 12 s" in emission.notes[0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("emitter", "drone"),
    [
        (MAVLINK, {"lens": None}),
        (DJI, {"autopilot": "dji-fly"}),
        (LITCHI, {"autopilot": "dji-fly"}),
    ],
)
def test_what_knows_no_zoom_is_told_and_refused_where_framing_is_promised(emitter, drone) -> None:
    emission = emitter.emit(filmed(zooming(straight()), **drone))
    assert emission.artifacts
    assert [d.code for d in emission.diagnostics] == ["E105"]
    refused = emitter.emit(filmed(zooming(straight()), Promise(in_frame=0.5), **drone))
    assert refused.artifacts == ()
    assert [d.code for d in refused.diagnostics] == ["E122"]
    assert registry()["E122"].severity == "error"


def test_a_picture_that_promises_only_to_be_unhidden_needs_no_zoom() -> None:
    emission = MAVLINK.emit(filmed(zooming(straight()), Promise(visible=0.5), lens=None))
    assert [d.code for d in emission.diagnostics] == ["E105"]


def test_one_field_of_view_that_is_not_the_lens_as_it_stands_is_told() -> None:
    emission = MAVLINK.emit(filmed(straight(), lens=None, hfov=radians(50)))
    (told,) = emission.diagnostics
    assert told.code == "E105"
    assert "the field of view is 70.0 deg, the lens has 50.0 deg" in told.notes[0]


def test_the_autopilots_that_are_said_to_zoom_are_those_whose_files_do():
    assert set(ZOOM_COMMANDS) == {*DIALECTS, *WPML.zooms, *TABLE.zooms}
