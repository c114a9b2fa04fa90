from __future__ import annotations

import json
from math import radians

import numpy as np
import pytest

from shotc.diag.registry import registry
from shotc.emit.mavlink import EMITTER
from shotc.emit.mavlink.items import MissionItem
from shotc.emit.mavlink.wpl import read_waypoints, write_waypoints
from shotc.emit.waypoints.geo import tie
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.mavlink_flights import flight, plan, retold
from tests.support.records import replace


def restless() -> DroneTrajectory:
    """Circle for minutes on end: far more bends than an autopilot holds."""
    time = np.arange(0.0, 400.0, 0.25)
    low = np.array([0.0, -60.0, 0.0, 0.0, -0.2, 0.0, 1.2])
    value = np.tile(low, (len(time), 1))
    value[:, 0] = time / 8 + 4 * np.cos(2 * time)
    value[:, 1] += 4 * np.sin(2 * time)
    value[:, 2] = 20.0
    rate = np.zeros_like(value)
    rate[1:-1] = (value[2:] - value[:-2]) / 0.5
    up = quintic_hermite(np.array([-8.0, 0.0]), np.stack([low, value[0]]), np.zeros((2, 7)), np.zeros((2, 7)))
    weave = quintic_hermite(time, value, rate, np.zeros_like(value))
    ctrl = np.concatenate([up.ctrl, weave.ctrl])
    curve = Piecewise(np.concatenate([[0.0], weave.breaks + 8.0]), ctrl)
    phases = (Phase("takeoff", None, 0.0, 8.0), Phase("shot", "half", 8.0, float(time[-1]) + 8.0))
    return DroneTrajectory("cam1", curve, phases, (), ())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("autopilot", "names"), [("px4", ["cam1.plan"]), ("ardupilot", ["cam1.plan", "cam1.waypoints"])]
)
def test_files_by_autopilot(autopilot: str, names: list[str]) -> None:
    emission = EMITTER.emit(retold(orbit_plan(), autopilot=autopilot))
    assert [a.name for a in emission.artifacts] == names
    assert emission.diagnostics == ()
    firmware = json.loads(emission.artifacts[0].data)["mission"]["firmwareType"]
    assert firmware == {"px4": 12, "ardupilot": 3}[autopilot]


def test_without_an_origin_nothing_is_written_and_one_warning_says_so() -> None:
    emission = EMITTER.emit(orbit_plan(origin=False))
    assert emission.artifacts == ()
    assert [d.code for d in emission.diagnostics] == ["E101"]
    assert registry()["E101"].severity == "warning"


@pytest.mark.slow
def test_the_note_states_count_tolerances_and_the_worst_frame() -> None:
    emission = EMITTER.emit(orbit_plan())
    count = emission.artifacts[0].data.count(b"SimpleItem")
    assert emission.notes[0].startswith(f"px4 cam1.plan: {count} items, position within 0.")
    assert "(shot half, t = " in emission.notes[0]
    assert emission.notes[0].endswith("; its waypoints take about 31 s where the plan films 30 s")


@pytest.mark.slow
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_the_same_plan_gives_the_same_bytes(autopilot: str) -> None:
    source = retold(orbit_plan(), autopilot=autopilot)
    assert EMITTER.emit(source) == EMITTER.emit(source)


@pytest.mark.long
@pytest.mark.parametrize(("autopilot", "most"), [("px4", 500), ("ardupilot", 649)])
def test_a_flight_too_long_for_the_autopilot_is_coarsened_and_says_how_far(autopilot: str, most: int) -> None:
    emission = EMITTER.emit(plan(restless(), autopilot=autopilot))
    assert 0 < emission.artifacts[0].data.count(b"SimpleItem") <= most
    warning = next(d for d in emission.diagnostics if d.code == "E103")
    assert "reached: " in warning.notes[0]
    reached = float(warning.notes[0].split()[1])
    assert 0.25 < reached < 8.0


def test_a_low_take_off_is_raised_for_px4_alone() -> None:
    low, high, east = (0.0, -60.0, 0.0, 0.0, 0.0), (0.0, -60.0, 2.5, 0.0, 0.0), (40.0, -60.0, 2.5, 0.0, 0.0)
    moves = [("takeoff", None, 4.0, high), ("shot", "half", 10.0, east), ("land", None, 4.0, low)]
    trajectory = flight(moves, pad=low)
    emission = EMITTER.emit(plan(trajectory))
    assert [d.code for d in emission.diagnostics] == ["E104"]
    assert "3.0 m instead of 2.5 m" in emission.diagnostics[0].message
    assert json.loads(emission.artifacts[0].data)["mission"]["items"][0]["params"][6] == 3
    assert EMITTER.emit(plan(trajectory, autopilot="ardupilot")).diagnostics == ()


@pytest.mark.slow
def test_every_drone_gets_its_files() -> None:
    mission = orbit_mission()
    one = mission.drones[0]
    pair = replace(mission, drones=(one, replace(one, name="cam2", autopilot="ardupilot")))
    source = orbit_plan()
    first = source.trajectory.drones[0]
    trajectory = replace(
        source.trajectory,
        keyframes=replace(source.trajectory.keyframes, mission=pair),
        drones=(first, replace(first, drone="cam2")),
    )
    emission = EMITTER.emit(replace(source, trajectory=trajectory))
    assert [a.name for a in emission.artifacts] == ["cam1.plan", "cam2.plan", "cam2.waypoints"]
    # Both fly one way: what keeps them apart is no part of their files.
    (meeting,) = (d for d in emission.diagnostics if d.code == "E145")
    assert "cam1 and cam2" in meeting.message
    assert "within 0.00 m" in meeting.notes[0]
    assert "shotc stream" in meeting.help


def test_the_take_off_is_relative_to_a_raised_pad() -> None:
    low, high, east = (0.0, -60.0, 5.0, 0.0, 0.0), (0.0, -60.0, 25.0, 0.0, 0.0), (40.0, -60.0, 25.0, 0.0, 0.0)
    moves = [("takeoff", None, 8.0, high), ("shot", "half", 10.0, east), ("land", None, 4.0, low)]
    emission = EMITTER.emit(plan(flight(moves, pad=low), home=(0.0, -60.0, 5.0)))
    mission = json.loads(emission.artifacts[0].data)["mission"]
    assert mission["plannedHomePosition"][2] == pytest.approx(413.0, abs=1e-2)
    assert mission["items"][0]["params"][6] == pytest.approx(20.0, abs=1e-3)
    assert mission["items"][-1]["params"][6] == 0


def test_text_waypoints_refuse_empty_parameters() -> None:
    origin = orbit_mission().origin
    assert origin is not None
    geo = tie(origin, (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="no empty parameters"):
        write_waypoints([MissionItem(1000, 2, (0.0, 0.0, None, None, 12.0, 0.0, 0.0))], geo)
    with pytest.raises(ValueError, match="not a waypoint file"):
        read_waypoints(b"QGC WPL 100\n")


@pytest.mark.slow
def test_no_angle_is_written_as_radians() -> None:
    source = retold(orbit_plan(), autopilot="ardupilot")
    items, _ = read_waypoints(EMITTER.emit(source).artifacts[1].data)
    pitches = [i.params[0] for i in items if i.command == 205]
    # The camera looks down at the tower from 8 m above it, 40 m away.
    assert pitches[0] == pytest.approx(np.degrees(np.arctan2(-8, 40)), abs=1e-3)
    assert radians(1.0) < 0.02
