"""Flights by waypoints: who keeps the mission is let through, and who does not is told where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from shotc.emit.litchi.table import write_table
from shotc.emit.waypoints.geo import GeoPosition
from shotc.emit.waypoints.route import PointAction, Waypoint
from shotc.flightfiles.verify import FlightsReport
from shotc.importers.cameras.takes import ImportOptions
from shotc.importers.mission import imported
from shotc.ir.trajectory import Claim
from tests.support.flight_files import (
    ACROSS,
    AROUND,
    MISSION,
    TWO,
    Places,
    codes,
    globe,
    kmz,
    litchi_file,
    mark,
    plan_file,
    verified,
    waypoints_file,
    wpml_text,
)


def dji_file(places: Places, speed: float = 5.0, more: str = "", finish: str = "autoLand") -> bytes:
    return kmz(wpml_text([mark(place, speed, more) for place in places], finish=finish))


WRITERS = {
    "cam1.kmz": dji_file,
    "cam1-litchi.csv": litchi_file,
    "cam1.plan": plan_file,
    "cam1.waypoints": waypoints_file,
}


def claim(report: FlightsReport, name: str) -> Claim:
    return next(each for each in report.certificate if each.constraint == name)


@pytest.mark.parametrize("name", WRITERS)
def test_a_way_round_holds_and_one_across_does_not(name: str) -> None:
    write = WRITERS[name]
    kept = verified((name, write(AROUND)))
    assert (kept.holds, codes(kept)) == (True, [])
    broken = verified((name, write(ACROSS)))
    assert not broken.holds
    assert "V007" in codes(broken)
    first = broken.diagnostics[0].labels[0]
    assert first.file.startswith(name)
    assert first.span.line > 1
    assert first.text.startswith("on the way to ")


def test_what_has_no_clock_is_named() -> None:
    notes = " ".join(verified(("cam1.kmz", dji_file(AROUND))).notes)
    assert "framing, visibility and promises" in notes
    assert "no clock" in notes


def test_a_curve_that_leaves_its_points_is_found() -> None:
    """Points and straight legs that keep clear of the hut, and a curve of DJI's that bulges into it."""
    places = ((-40.0, -3.0, 8.0), (-7.0, -3.0, 8.0), (-7.0, 3.0, 8.0), (-40.0, 3.0, 8.0))
    straight = "<wpml:useStraightLine>1</wpml:useStraightLine>"
    kept = verified(("cam1.kmz", dji_file(places, more=straight, finish="noAction")))
    assert (kept.holds, claim(kept, "zone hut").worst) == (True, pytest.approx(2.0 - 0.6, abs=1e-3))
    report = verified(("cam1.kmz", dji_file(places, finish="noAction")))
    assert codes(report) == ["V007"]
    assert any("spline" in note or "Bezier" in note for note in report.diagnostics[0].notes)
    assert "it stays in the air" in " ".join(report.notes)


def test_a_rounded_corner_cuts_what_the_points_go_round() -> None:
    places = ((-7.0, -30.0, 8.0), (-7.0, 7.0, 8.0), (30.0, 7.0, 8.0))
    assert verified(("cam1-litchi.csv", litchi_file(places))).holds
    report = verified(("cam1-litchi.csv", litchi_file(places, curve=15.0)))
    assert codes(report) == ["V007"]
    assert "rounded corners" in " ".join(report.diagnostics[0].notes)


def test_speeds_are_those_of_the_file_by_how_steep_it_is() -> None:
    up = ((0.0, -60.0, 20.0), (-30.0, -60.0, 60.0), (0.0, -60.0, 60.0))
    report = verified(("cam1.kmz", dji_file(up)))
    assert claim(report, "climb").worst == pytest.approx(4.0, abs=2e-3)
    assert claim(report, "speed").worst == pytest.approx(5.0, abs=2e-3)
    assert claim(report, "descent").worst == 0.0
    assert codes(report) == ["V001"]


@pytest.mark.parametrize("speed", [1e-300, 1e-9, 1e8])
def test_a_speed_that_nothing_flies_is_no_trouble(speed: float) -> None:
    hovers = "<wpml:hoverTime>1e8</wpml:hoverTime>"
    report = verified(("cam1.kmz", dji_file(AROUND, speed, hovers)))
    assert "V013" in codes(report)
    assert claim(report, "zone hut").holds


def test_heights_above_the_sea_count_from_the_origin() -> None:
    places = tuple((x, y, z + 408.0) for x, y, z in AROUND)
    report = verified(("cam1.waypoints", waypoints_file(places, frame=0)))
    assert report.holds
    low = claim(report, "ground clearance")
    assert low.worst == pytest.approx(20.0 - 0.6, abs=0.01)


@pytest.mark.slow
def test_drones_that_time_alone_would_keep_apart_are_refused() -> None:
    other = ((12.0, -60.0, 20.0), (-40.0, 0.0, 20.5), (12.0, -60.0, 20.0))
    files = ("cam1.kmz", dji_file(AROUND)), ("cam2.plan", plan_file(other))
    report = verified(*files, text=TWO)
    assert codes(report) == ["V022"]
    assert claim(report, "separation from cam2").worst == pytest.approx(0.16, abs=0.02)
    higher = tuple((x, y, z + 15.0) for x, y, z in other)
    assert verified(files[0], ("cam2.plan", plan_file(higher)), text=TWO).holds


def test_a_landing_elsewhere_and_angles_out_of_reach_are_told() -> None:
    report = verified(("cam1.kmz", dji_file(AROUND[:3])))
    assert codes(report) == ["V012"]
    tilt = "<wpml:waypointGimbalPitchAngle>60</wpml:waypointGimbalPitchAngle>"
    assert codes(verified(("cam1.kmz", dji_file(AROUND, more=tilt)))) == ["V005"]


@pytest.mark.slow
def test_parts_of_one_flight_are_one() -> None:
    whole = verified(("cam1.kmz", dji_file(AROUND)))
    parts = verified(("cam1-2.kmz", dji_file(AROUND[2:])), ("cam1-1.kmz", dji_file(AROUND[:3])))
    assert [c.constraint for c in parts.certificate] == [c.constraint for c in whole.certificate]
    worst = np.array([[a.worst, b.worst] for a, b in zip(parts.certificate, whole.certificate, strict=True)])
    assert worst[:, 0] == pytest.approx(worst[:, 1])


@pytest.mark.slow
def test_whose_a_file_is() -> None:
    flight = dji_file(AROUND)
    assert verified(("flight.kmz", flight)).holds  # of the only drone
    assert codes(verified(("flight.kmz", flight), text=TWO)) == ["I013"]
    assert verified(("flight.kmz", flight), text=TWO, drones=["cam1"]).holds
    assert codes(verified(("flight.kmz", flight), drones=["cam9"])) == ["I013"]
    assert codes(verified(("flight.kmz", flight), drones=["cam1", "cam1"])) == ["I013"]
    assert codes(verified(("cam1.kmz", flight), ("cam1.plan", plan_file(AROUND)))) == ["I013"]


def test_a_mission_without_an_origin_is_told() -> None:
    text = MISSION.replace("  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n", "")
    assert codes(verified(("cam1.kmz", dji_file(AROUND)), text=text)) == ["I014"]


def test_a_survey_of_qgroundcontrol_is_flown_by_the_items_in_it() -> None:
    inner = [{"command": 16, "frame": 3, "params": [0, 0, 0, None, *globe(place)]} for place in AROUND[:3]]
    survey = {"complexItemType": "survey", "TransectStyleComplexItem": {"Items": inner}}
    report = verified(("cam1.plan", plan_file((), items=[survey])))
    assert report.holds
    assert "3 waypoints" in report.notes[0]


def test_our_litchi_files_are_imported_as_they_are_written() -> None:
    """Every waypoint of ours comes back as a camera: its place, its heading and its pitch."""
    asked = [(10.0, 0.0, 20.0), (10.0, 30.0, 25.0), (-10.0, 45.0, 22.0)]
    points = [
        Waypoint(GeoPosition(*globe(place)), heading, -12.5 - i, 4.0, stops=False)
        for i, (place, heading) in enumerate(zip(asked, (-90.0, 10.0, 170.0), strict=True))
    ]
    points[0] = replace(points[0], stops=True, actions=(PointAction("start"), PointAction("stay", 3.0)))
    points[2] = replace(points[2], stops=True, actions=(PointAction("stop"),))
    made = imported(
        "litchi",
        write_table(points),
        "ours.csv",
        strict=False,
        options=ImportOptions(every=True, ground=408.0),
    )
    assert made.text is not None
    assert (made.shots, made.keyframes) == (1, 3)
    for heading, pitch in ((270.0, -12.5), (10.0, -13.5), (170.0, -14.5)):
        assert f"heading: {heading:.4f} deg, pitch: {pitch:.4f} deg" in made.text
    assert "hold: 3.000" in made.text
    first = globe(asked[0])
    assert f"origin: {{lat: {first[0]:.7f}, lon: {first[1]:.7f}, alt: 408.000}}" in made.text
