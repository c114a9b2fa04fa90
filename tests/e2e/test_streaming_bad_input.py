"""Whatever is wrong with a vehicle is told with a code and numbers, and nothing is armed."""

from __future__ import annotations

import socket

import pytest

from shotc.stream.aim import LiveAim
from shotc.stream.endpoint import Endpoint
from tests.support.stream.autopilot import (
    ARDUPILOT,
    ARM,
    BRAKE,
    CLAIM,
    PX4,
    PX4_HOLD,
    PX4_LAND,
    SET_MODE,
    TAKE_OFF,
    VIDEO_START,
    Script,
)
from tests.support.stream.plans import brief_plan, hop_plan, with_zoom, without_origin
from tests.support.stream.worlds import World

BEFORE = {
    "no heartbeat": (Script(vanishes=0.0), "A003", "HEARTBEAT"),
    "another autopilot": (Script(kind=ARDUPILOT), "A004", "runs ArduPilot"),
    "an unknown autopilot": (Script(kind=8), "A004", "MAV_AUTOPILOT 8"),
    "a plane": (Script(vehicle=1), "A004", "MAV_TYPE 1"),
    "armed": (Script(armed=True), "A005", "armed already"),
    "calibrating": (Script(status=2), "A005", "calibrating"),
    "in an emergency": (Script(status=6), "A005", "emergency"),
    "no position": (Script(mute=frozenset({"GPS_GLOBAL_ORIGIN"})), "A006", "GPS_GLOBAL_ORIGIN"),
    "no home": (Script(mute=frozenset({"HOME_POSITION"})), "A006", "HOME_POSITION"),
    "no parameter": (Script(parameters={"COM_OBL_RC_ACT": None}), "A006", "COM_OBL_RC_ACT"),
    "position mode": (Script(parameters={"COM_OBL_RC_ACT": 0}), "A007", "COM_OBL_RC_ACT is 0"),
    "terminate": (Script(parameters={"COM_OBL_RC_ACT": 6}), "A007", "COM_OBL_RC_ACT is 6"),
    "an unknown value": (Script(parameters={"COM_OBL_RC_ACT": 99}), "A007", "COM_OBL_RC_ACT is 99"),
    "an older PX4 that goes on": (Script(parameters={"COM_OBL_ACT": -1}), "A007", "COM_OBL_ACT is -1"),
    "a silent station": (Script(parameters={"NAV_DLL_ACT": 5}), "A007", "NAV_DLL_ACT is 5"),
    "a patient PX4": (Script(parameters={"COM_OF_LOSS_T": 30.0}), "A008", "COM_OF_LOSS_T is 30 s"),
    "another place": (Script(shift=(2000.0, 0.0, 0.0)), "A009", "2.0 km"),
    "another pad": (Script(shift=(0.0, 1.2, 0.0)), "A010", "1.2 m from the plan's"),
    "another height": (Script(shift=(0.0, 0.0, 3.0)), "A010", "3.00 m in height"),
    "away from home": (Script(stands=(1.5, 0.0, 0.0)), "A010", "1.5 m from its pad"),
    "a frame far away": (Script(tie=(47.3949, 8.5417, 408.0)), "A011", "2.1 km"),
    "no gimbal": (Script(mute=frozenset({"GIMBAL_MANAGER_INFORMATION"})), "A012", "GIMBAL_MANAGER"),
    "a slow PX4": (Script(parameters={"MPC_Z_VEL_MAX_UP": 1.0}), "A014", "1.9 m/s up"),
    "a stiff gimbal": (Script(pitch=(-10.0, 10.0)), "A012", "from -10 to 10"),
}  # fmt: skip


def told(found):
    return [(d.code, "\n".join([d.message, *d.notes])) for d in found]


@pytest.mark.parametrize(("script", "code", "words"), BEFORE.values(), ids=BEFORE)
def test_nothing_is_armed_where_a_check_fails(script, code, words):
    with World(hop_plan(), cam1=script) as world:
        aboard, found = world.check()
        assert aboard == []
        ((told_code, text),) = told(found)
        assert told_code == code
        assert words in text
        assert found[0].help
        # Only messages at a rate were asked for: 511 is MAV_CMD_SET_MESSAGE_INTERVAL.
        assert {command[1] for command in world.autopilots["cam1"].commands} <= {511}


@pytest.mark.parametrize(
    ("parameters", "code"),
    [
        ({"FS_GCS_ENABLE": 0.0}, "A007"),
        ({"FS_GCS_ENABLE": 6.0}, "A007"),
        ({"GUID_TIMEOUT": 20.0}, "A008"),
        ({"FS_GCS_TIMEOUT": 60.0}, "A008"),
        ({"FS_GCS_ENABLE": 5.0, "FS_GCS_TIMEOUT": None}, None),
        ({"SYSID_MYGCS": None, "MAV_GCS_SYSID": 250.0}, None),
    ],
)
def test_ardupilot_says_what_it_does_without_a_link(parameters, code):
    with World(hop_plan(autopilot="ardupilot"), cam1=Script(parameters=parameters)) as world:
        _, found = world.check()
    assert [d.code for d in found] == ([] if code is None else [code])


def test_a_home_a_hand_away_is_flown_with():
    with World(hop_plan(), cam1=Script(shift=(0.5, -0.5, 0.4))) as world:
        aboard, found = world.check()
    assert (len(aboard), found) == (1, [])


def test_a_dry_run_moves_nothing():
    with World(hop_plan("near", "far")) as world:
        aboard, found = world.check()
        assert (len(aboard), found) == (2, [])
        for autopilot in world.autopilots.values():
            assert autopilot.setpoints == []
            assert autopilot.aims == []
            assert {command[1] for command in autopilot.commands} <= {511}


def test_a_zoom_is_told_and_flown_without():
    with World(with_zoom(hop_plan())) as world:
        aboard, found = world.check()
    assert len(aboard) == 1
    ((code, text),) = told(found)
    assert code == "A031"
    assert "40 to 70 degrees" in text


def test_a_plan_without_a_place_is_not_streamed():
    with World(without_origin(hop_plan())) as world:
        _, found = world.check()
    assert [d.code for d in found] == ["A001"]


def test_a_port_in_use_is_told():
    with World(hop_plan()) as world, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", world.ports["cam1"]))
        _, found = world.check()
    ((code, text),) = told(found)
    assert code == "A002"
    assert f"udp:127.0.0.1:{world.ports['cam1']}" in text
    assert "in use" in text


def test_a_port_of_a_target_in_use_is_told():
    with (
        World(hop_plan(), targets=["tower"]) as world,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other,
    ):
        other.bind(("127.0.0.1", world.targets["tower"].port))
        _, found = world.check()
    ((code, text),) = told(found)
    assert code == "A002"
    assert "target `tower`" in text


@pytest.mark.slow
def test_a_vehicle_that_keeps_its_motors_on_is_told():
    with World(brief_plan(), cam1=Script(lands=False)) as world:
        flown, _ = world.fly()
    assert [d.code for d in flown.diagnostics] == ["A028"]


def test_an_address_that_is_not_of_this_machine_is_told():
    with World(hop_plan()) as world:
        found = world.session.open({"cam1": Endpoint("192.0.2.1", 14540, False)}, {})
    assert [d.code for d in found] == ["A002"]


DURING = {
    "the mode": ("px4", Script(refuses={SET_MODE: 2}), "A020", "refuses the mode OFFBOARD"),
    "to arm": ("px4", Script(refuses={ARM: 1}, texts=("Preflight Fail: compass",)), "A020", "compass"),
    "its gimbal": ("px4", Script(refuses={CLAIM: 2}), "A020", "control of its gimbal"),
    "to take off": ("ardupilot", Script(refuses={TAKE_OFF: 4}), "A020", "refuses to take off"),
    "to answer in time": ("px4", Script(answers_after=20.0), "A021", "gimbal"),
    "to move": ("ardupilot", Script(stuck=True), "A021", "to take off"),
}


@pytest.mark.slow
@pytest.mark.parametrize(("autopilot", "script", "code", "words"), DURING.values(), ids=DURING)
def test_a_vehicle_that_refuses_stays_on_the_ground(autopilot, script, code, words):
    with World(hop_plan(autopilot=autopilot), cam1=script) as world:
        flown, _ = world.fly()
        vehicle = world.autopilots["cam1"]
        assert not flown.landed
        assert code in [d.code for d in flown.diagnostics]
        assert words in "\n".join(text for c, text in told(flown.diagnostics) if c == code)
        assert vehicle.north_east_down[2] == pytest.approx(0.0, abs=1e-6)
        if code == "A020":
            assert not vehicle.armed or script.refuses.get(TAKE_OFF)


@pytest.mark.slow
def test_where_one_drone_vanishes_the_other_holds():
    with World(hop_plan("near", "far")) as world:
        world.check()
        world.autopilots["near"].script.vanishes = world.clock.time + 25.0
        aboard, _ = world.session.check()
        flown, _ = world.session.fly(aboard)
        far = world.autopilots["far"]
        assert [d.code for d in flown.diagnostics] == ["A022", "A029"]
        assert far.mode == PX4_HOLD
        assert dict(flown.holding)["far"] == "HOLD"
        # It is said within seconds, and the one that is heard stands in the air.
        silent_since = world.autopilots["near"].script.vanishes
        assert far.setpoints[-1][0] - silent_since < 3.5
        assert far.north_east_down[2] < -3


@pytest.mark.slow
@pytest.mark.parametrize(("autopilot", "hold"), [("px4", PX4_HOLD), ("ardupilot", BRAKE)])
def test_a_drone_that_its_pilot_takes_is_left_alone_and_the_others_hold(autopilot, hold):
    with World(hop_plan("near", "far", autopilot=autopilot)) as world:
        aboard, _ = world.check()
        world.autopilots["near"].script.takes_over = world.clock.time + 25.0
        flown, _ = world.session.fly(aboard)
        near, far = world.autopilots["near"], world.autopilots["far"]
        assert [d.code for d in flown.diagnostics] == ["A023"]
        assert near.mode not in (PX4_HOLD, BRAKE)
        assert sum(command[1] == SET_MODE for command in near.commands) == 1
        assert far.mode == hold


@pytest.mark.slow
def test_interrupted_it_asks_for_hold_and_says_so():
    def stop():
        raise KeyboardInterrupt

    with World(hop_plan()) as world:
        aboard, _ = world.check()
        world.clock.events.append((world.clock.time + 20.0, stop))
        flown, _ = world.session.fly(aboard)
        assert flown.interrupted
        assert not flown.landed
        assert flown.holding == [("cam1", "HOLD")]
        assert world.autopilots["cam1"].mode == PX4_HOLD
    assert any("interrupted" in line for line in world.lines)


@pytest.mark.slow
def test_interrupted_before_it_lifts_off_it_disarms():
    def stop():
        raise KeyboardInterrupt

    with World(hop_plan()) as world:
        aboard, _ = world.check()
        world.clock.events.append((world.clock.time + 5.0, stop))
        flown, _ = world.session.fly(aboard)
        assert flown.interrupted
        assert flown.holding == []
        assert not world.autopilots["cam1"].armed


@pytest.mark.slow
def test_a_machine_that_sleeps_sends_no_jump():
    with World(hop_plan()) as world:
        aboard, _ = world.check()

        def sleep():
            world.clock.time += 0.8

        world.clock.events.append((world.clock.time + 20.0, sleep))
        flown, _ = world.session.fly(aboard)
        assert [d.code for d in flown.diagnostics] == ["A025"]
        assert world.autopilots["cam1"].mode == PX4_HOLD


@pytest.mark.slow
def test_a_short_gap_leaves_moments_out_and_flies_on():
    with World(hop_plan()) as world:
        aboard, _ = world.check()

        def busy():
            world.clock.time += 0.13

        world.clock.events.append((world.clock.time + 20.0, busy))
        flown, _ = world.session.fly(aboard)
        assert flown.landed
        assert flown.times.skipped == 6
        assert flown.times.worst == pytest.approx(0.13)
        assert flown.times.late == 1


@pytest.mark.slow
def test_a_vehicle_that_does_not_follow_is_stopped():
    with World(hop_plan()) as world:
        aboard, _ = world.check()

        def blown():
            world.autopilots["cam1"].state.position[0, 0] += 15.0

        world.clock.events.append((world.clock.time + 20.0, blown))
        flown, _ = world.session.fly(aboard)
    assert [d.code for d in flown.diagnostics] == ["A024"]


@pytest.mark.slow
def test_a_vehicle_that_was_moved_while_it_waited_is_not_armed():
    with World(hop_plan("near", "far", waits=15.0)) as world:
        aboard, _ = world.check()
        near, far = world.autopilots["near"], world.autopilots["far"]

        def pushed():
            far.state.position[0, 1] += 3.0

        world.clock.events.append((world.clock.time + 10.0, pushed))
        flown, _ = world.session.fly(aboard)
        assert [d.code for d in flown.diagnostics] == ["A024"]
        assert not far.armed
        assert ARM not in [command[1] for command in far.commands]
        assert near.mode == PX4_HOLD


@pytest.mark.slow
def test_a_camera_that_does_not_answer_is_told_of_and_the_flight_goes_on():
    with World(hop_plan(), cam1=Script(refuses={VIDEO_START: 4})) as world:
        flown, _ = world.fly()
    assert flown.landed
    assert [d.code for d in flown.diagnostics] == ["A027"]


@pytest.mark.slow
def test_a_bug_on_the_way_leaves_no_drone_without_a_command(monkeypatch):
    with World(hop_plan("near", "far")) as world:
        aboard, _ = world.check()
        end = world.clock.time + 22.0
        aim = LiveAim.at

        def breaks(self, tick, now):
            if now > end:
                raise ZeroDivisionError
            return aim(self, tick, now)

        monkeypatch.setattr(LiveAim, "at", breaks)
        with pytest.raises(ZeroDivisionError):
            world.session.fly(aboard)
        assert {autopilot.mode for autopilot in world.autopilots.values()} == {PX4_HOLD}
        assert all(autopilot.north_east_down[2] < -3 for autopilot in world.autopilots.values())


@pytest.mark.slow
def test_interrupted_while_it_lands_it_lands():
    def stop():
        raise KeyboardInterrupt

    with World(hop_plan()) as world:
        aboard, _ = world.check()
        world.clock.events.append((world.clock.time + 38.2, stop))
        flown, _ = world.session.fly(aboard)
        assert flown.interrupted
        assert flown.holding == []
        assert world.autopilots["cam1"].mode == PX4_LAND


def test_px4_reads_whole_numbers_by_their_bytes():
    with World(hop_plan(), cam1=Script(kind=PX4, parameters={"COM_OBL_RC_ACT": 4})) as world:
        (who,), _ = world.check()
    assert who.ready.vehicle.parameters["COM_OBL_RC_ACT"] == 4.0
