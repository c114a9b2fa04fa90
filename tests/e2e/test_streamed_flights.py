"""Plans flown by simulated autopilots over loopback, in simulated time: no wall clock decides anything."""

from __future__ import annotations

import socket

import numpy as np
import pytest
from pymavlink.dialects.v20 import common as mavlink
from scipy.spatial import cKDTree

from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.stream.clock import PERIOD_S
from shotc.stream.endpoint import Endpoint
from tests.support.film_plans import orbit_plan
from tests.support.stream.autopilot import ARM, GUIDED, LAND, OFFBOARD, PX4_LAND, SET_MODE, TAKE_OFF, Script
from tests.support.stream.globe import ardupilot_place, in_world, px4_place
from tests.support.stream.plans import brief_plan, hop_plan
from tests.support.stream.worlds import World, free_port

pytestmark = pytest.mark.slow

ROUNDED_M = 0.02
"""What 1e-7 degrees in the places of origin and home and a float32 on the wire make of a setpoint."""


def on_the_plan(world, name, back=px4_place):
    """Hold every setpoint that arrived to the plan's path; return them: time, and what was asked."""
    (track,) = (t for t in world.plan.trajectory.drones if t.drone == name)
    autopilot = world.autopilots[name]
    got = np.array(autopilot.setpoints)
    path = cKDTree(track.curve(np.linspace(0.0, track.curve.end, 200_000))[:, :3])
    sent = [in_world(row, autopilot.origin, world.mission.origin, back) for row in got[:, 1:4]]
    assert path.query(sent)[0].max() < ROUNDED_M
    return got


@pytest.mark.long
def test_a_film_of_two_minutes_is_flown_and_recorded_by_px4():
    with World(orbit_plan()) as world:
        flown, (pilot,) = world.fly()
        autopilot = world.autopilots["cam1"]
        assert flown.landed
        assert flown.diagnostics == []
        assert not autopilot.armed
        assert autopilot.north_east_down == pytest.approx((0.0, 0.0, 0.0), abs=0.3)
        got = on_the_plan(world, "cam1")
        assert np.diff(got[:, 0]) == pytest.approx(PERIOD_S, abs=1e-6)
        started, ended = (when for when, on in autopilot.recording)
        assert ended - started == pytest.approx(30.0, abs=0.05)
        assert pilot.farthest < 2.0
        modes = [c[3] for c in autopilot.commands if c[1] == SET_MODE]
        assert (modes[0], modes[-1]) == (OFFBOARD >> 16, PX4_LAND >> 16 & 0xFF)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_the_camera_looks_where_the_plan_does(autopilot):
    plan = hop_plan(pans=True, autopilot=autopilot)
    with World(plan) as world:
        world.fly()
        aims = np.array(world.autopilots["cam1"].aims)
        setpoints = np.array(world.autopilots["cam1"].setpoints)
    (track,) = plan.trajectory.drones
    # The last is of the tick at which the flight ends.
    t = track.curve.end - (aims[-1, 0] - aims[:, 0])
    pose = track.curve(np.clip(t, 0, track.curve.end))
    shot = t > 2.0
    assert aims[shot, 1] == pytest.approx(pose[shot, CAM_PITCH], abs=1e-6)
    assert np.cos(aims[shot, 2]) == pytest.approx(np.sin(pose[shot, CAM_YAW]), abs=1e-6)
    assert set(aims[:, 3]) == {4 | 8 | 16}
    yaw = setpoints[-1, 10]
    assert np.cos(yaw) == pytest.approx(np.sin(track.curve(track.curve.end)[BODY_YAW]), abs=1e-6)


def test_ardupilot_takes_off_by_itself_and_is_taken_over_above_its_pad():
    with World(hop_plan(autopilot="ardupilot")) as world:
        flown, _ = world.fly()
        autopilot = world.autopilots["cam1"]
        assert flown.landed
        assert flown.diagnostics == []
        order = [c[1] for c in autopilot.commands]
        assert order.index(SET_MODE) < order.index(ARM) < order.index(TAKE_OFF)
        rises = next(c for c in autopilot.commands if c[1] == TAKE_OFF)
        assert rises[8] == pytest.approx(1.0, abs=0.05)
        modes = [c[3] for c in autopilot.commands if c[1] == SET_MODE]
        assert (modes[0], modes[-1]) == (GUIDED, LAND)
        assert 0.8 < autopilot.taken_over_at < 1.1
        got = on_the_plan(world, "cam1", ardupilot_place)
        # Nothing is asked below the height at which it was taken over before the way down.
        assert (-got[: len(got) // 2, 3]).min() >= rises[8] - 1e-3
        # It minds the silence of its own ground station, so that is whose name is used.
        assert 252 in autopilot.stations


@pytest.mark.long
def test_two_drones_fly_by_one_clock():
    plan = hop_plan("near", "far", waits=5.0)
    with World(plan) as world:
        flown, pilots = world.fly()
        assert flown.landed
        assert flown.diagnostics == []
        assert [pilot.done for pilot in pilots] == [True, True]
        near, far = (np.array(world.autopilots[name].setpoints) for name in ("near", "far"))
    # Both rise 5 s after each other, to the tick.
    leaves = [rows[np.argmax(rows[:, 3] < rows[0, 3] - 1.0), 0] for rows in (near, far)]
    assert leaves[1] - leaves[0] == pytest.approx(5.0, abs=1e-6)


def test_a_camera_of_its_own_records():
    with World(hop_plan(), cam1=Script(camera=True)) as world:
        flown, _ = world.fly()
        assert flown.diagnostics == []
        assert [on for _, on in world.autopilots["cam1"].recording] == [True, False]


def test_a_vehicle_is_called_where_it_waits():
    with World(brief_plan()) as world:
        autopilot = world.autopilots["cam1"]
        autopilot.to = ("127.0.0.1", free_port())
        there = Endpoint("127.0.0.1", autopilot.socket.getsockname()[1], True)
        assert world.session.open({"cam1": there}, {}) == []
        aboard, found = world.session.check()
        assert found == []
        assert world.session.fly(aboard)[0].landed


@pytest.mark.parametrize("system", [1, 9], ids=["from elsewhere", "by the same radio"])
def test_what_others_send_to_the_port_is_not_believed(system):
    with World(brief_plan()) as world, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        aboard, _ = world.check()
        mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=1)
        port = ("127.0.0.1", world.ports["cam1"])
        stranger = other if system == 1 else world.autopilots["cam1"].socket

        def lie():
            stranger.sendto(mav.heartbeat_encode(2, 12, 129, 3 << 16, 4).pack(mav), port)
            stranger.sendto(mav.local_position_ned_encode(0, 500.0, 0.0, 0.0, 0.0, 0.0, 0.0).pack(mav), port)
            world.clock.events.append((world.clock.time + 0.3, lie))

        lie()
        flown, _ = world.session.fly(aboard)
    assert flown.landed
    assert flown.diagnostics == []


@pytest.mark.long
def test_a_local_frame_that_begins_elsewhere_changes_nothing_on_the_globe():
    plan = hop_plan()
    tie = (47.3769 + 0.004, 8.5417 - 0.006, 395.0)
    with World(plan) as here, World(plan, cam1=Script(tie=tie)) as there:
        assert here.fly()[0].landed
        assert there.fly()[0].landed
        straight, tied = (np.array(w.autopilots["cam1"].setpoints) for w in (here, there))
        pads = [w.autopilots["cam1"].pad[0] for w in (here, there)]
    assert np.linalg.norm(pads[1]) > 500
    away = (tied[:, 1:4] - pads[1]) - (straight[:, 1:4] - pads[0])
    assert np.abs(away).max() < ROUNDED_M
