"""Litchi's table: its columns, what a reader that others wrote finds in it, and what is told."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pyproj
import pytest

from shotc.emit.litchi import EMITTER, FORMAT
from shotc.emit.litchi.table import COLUMNS, read_table, write_table
from shotc.emit.waypoints.geo import GeoPosition
from shotc.emit.waypoints.machine_files import emit_files
from shotc.emit.waypoints.route import PointAction, Waypoint
from shotc.ir.path import BODY_YAW, CAM_YAW
from tests.support.film_plans import orbit_plan
from tests.support.mavlink_flights import retold

STAY = Waypoint(
    GeoPosition(47.0, 8.0, 12.0),
    -90.0,
    -20.0,
    3.0,
    True,
    (PointAction("start"), PointAction("stay", 40.0)),
    0.2,
)


@pytest.fixture(scope="module")
def orbit():
    return EMITTER.emit(retold(orbit_plan(), autopilot="dji-fly"))


@pytest.mark.slow
def test_the_table_has_46_columns_and_a_row_for_each_point(orbit):
    (artifact,) = orbit.artifacts
    head, *rows = artifact.data.decode().splitlines()
    assert artifact.name == "cam1-litchi.csv"
    assert tuple(head.split(",")) == COLUMNS
    assert len(COLUMNS) == 46
    assert {len(row.split(",")) for row in rows} == {46}
    assert orbit.notes[0].startswith(f"dji-fly cam1-litchi.csv: {len(rows)} waypoints")
    assert "Heading Mode Custom" in orbit.notes[-1]
    assert orbit.diagnostics == ()


@pytest.mark.slow
def test_what_is_read_is_what_was_written(orbit):
    data = orbit.artifacts[0].data
    assert write_table(read_table(data)) == data
    kinds = [a.kind for p in read_table(data) for a in p.actions]
    assert kinds == ["start", "stop"]


@pytest.mark.slow
def test_a_target_that_is_looked_straight_at_is_the_point_of_interest(orbit):
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    target, home = mission.targets[0], mission.drones[0].home
    points = read_table(orbit.artifacts[0].data)
    first, last = (
        next(i for i, p in enumerate(points) if any(a.kind == kind for a in p.actions))
        for kind in ("start", "stop")
    )
    filmed = points[first : last + 1]
    assert [p for p in points if p.watched is not None] == filmed
    for point in filmed:
        assert point.watched.alt == pytest.approx(target.centre[2] - home[2], abs=0.006)
        bearing = pyproj.Geod(ellps="WGS84").inv(
            point.place.lon, point.place.lat, point.watched.lon, point.watched.lat
        )[0]
        assert abs((bearing - point.heading + 180.0) % 360.0 - 180.0) < 0.15
    ctrl = plan.trajectory.drones[0].curve.ctrl.copy()
    ctrl[..., [CAM_YAW, BODY_YAW]] += 0.1
    turned = replace(plan.trajectory.drones[0], curve=replace(plan.trajectory.drones[0].curve, ctrl=ctrl))
    beside = EMITTER.emit(
        retold(replace(plan, trajectory=replace(plan.trajectory, drones=(turned,))), autopilot="dji-fly")
    )
    assert all(p.watched is None for p in read_table(beside.artifacts[0].data))


def test_corners_are_rounded_within_half_of_their_legs(orbit):
    points = read_table(orbit.artifacts[0].data)
    assert all(0.2 <= p.curve <= 2.0 for p in points)
    assert max(p.curve for p in points) > 0.2


def test_a_long_stay_is_several_and_west_is_270_degrees():
    row = write_table([STAY, STAY]).decode().splitlines()[1].split(",")
    assert row[3] == "270.0"
    assert row[8:14] == ["2", "0", "0", "20000", "0", "20000"]
    assert row[14:16] == ["-1", "0"]
    again = read_table(write_table([STAY, STAY]))[0]
    assert again.heading == -90.0
    assert sum(a.seconds for a in again.actions) == 40.0


@pytest.mark.slow
def test_a_long_mission_becomes_several_tables_that_go_on_from_each_other(orbit):
    source = retold(orbit_plan(), autopilot="dji-fly")
    emission = emit_files(source, replace(FORMAT, most=10))
    tables = [read_table(a.data) for a in emission.artifacts]
    assert [a.name for a in emission.artifacts] == [f"cam1-{i + 1}-litchi.csv" for i in range(len(tables))]
    assert len(tables) > 2
    assert all(len(table) <= 10 for table in tables)
    assert all(a[-1].place == b[0].place for a, b in pairwise(tables))
    assert "cam1-1-litchi.csv, cam1-2-litchi.csv" in emission.notes[0]
    assert FORMAT.most == 99


@pytest.mark.slow
def test_a_machine_without_waypoints_of_its_own_is_told():
    emission = EMITTER.emit(retold(orbit_plan(), autopilot="litchi", model="mini-3-pro"))
    assert emission.artifacts
    (told,) = emission.diagnostics
    assert told.code == "E121"
    assert "`mini-3-pro`" in told.message


def test_a_reader_that_others_wrote_finds_the_same_numbers(orbit, tmp_path: Path):
    litchi = pytest.importorskip("litchi_wp.waypoint", reason="litchi-wp is not installed")
    file = tmp_path / "mission.csv"
    file.write_bytes(orbit.artifacts[0].data)
    read, ours = litchi.Waypoint.from_file(str(file)), read_table(orbit.artifacts[0].data)
    assert len(read) == len(ours)
    for theirs, point in zip(read, ours, strict=True):
        assert (theirs.lat, theirs.lon) == pytest.approx((point.place.lat, point.place.lon), abs=1e-9)
        assert theirs.altitude.value == pytest.approx(point.place.alt)
        assert theirs.heading == pytest.approx(point.heading % 360)
        assert theirs.gimbal.pitchangle == pytest.approx(point.pitch)
        assert theirs.gimbal.mode.value == 2
        assert theirs.speed == pytest.approx(point.speed)
        assert theirs.curvesize == pytest.approx(point.curve)
        names = {"START_RECORDING": "start", "STOP_RECORDING": "stop"}
        done = [names[a.type.name] for a in theirs.actions if a.type.value != -1]
        assert done == [a.kind for a in point.actions]
