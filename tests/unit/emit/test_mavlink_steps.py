from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

from shotc.emit.mavlink import EMITTER
from shotc.emit.mavlink.plan_file import read_plan
from shotc.emit.mavlink.speed import DEFAULTS, Speeds, adapted, is_steep, seconds
from shotc.emit.mavlink.steps import CORNER_CUT_M, CORNER_M_S2, WaypointStep, _radius, whole_seconds
from shotc.emit.mavlink.style import Command
from shotc.emit.mavlink.thin import StraightLeg
from shotc.ir.limits import Limits
from shotc.ir.trajectory import VerifiedIR
from tests.support.mavlink_flights import Move, flight, plan, straight

LIMITS = Limits(8.0, 4.0, 3.0, 3.0, 8.0, radians(60), radians(90))
LOW, HIGH = (0.0, -60.0, 0.0, 0.0, -0.2), (0.0, -60.0, 20.0, 0.0, -0.2)
EAST = (40.0, -60.0, 20.0, 0.0, -0.2)


def commands(source: VerifiedIR) -> list[tuple[int, tuple[float | None, ...]]]:
    data = next(a.data for a in EMITTER.emit(source).artifacts if a.name == "cam1.plan")
    return [(i.command, i.params) for i in read_plan(data)[0]]


def shot(*moves: Move) -> list[Move]:
    return [("takeoff", None, 8.0, HIGH), *moves, ("land", None, 8.0, LOW)]


def test_a_speed_item_comes_only_where_the_speed_changes() -> None:
    now = Speeds(5.0, 3.0, 1.5)
    assert adapted(now, None, 50.0, 0.0, 10.0) == now
    assert adapted(now, None, 50.0, 0.0, 9.0) == now
    assert adapted(now, None, 50.0, 0.0, 8.0).ground == 6.25


def test_upright_legs_are_paced_by_climb_and_descent() -> None:
    now = DEFAULTS["ardupilot"]
    up = adapted(now, LIMITS, 0.0, 20.0, 20.0)
    assert (up.ground, up.climb, up.descent) == (10.0, 1.0, 1.5)
    assert seconds(up, 0.0, 20.0) == pytest.approx(20.0)
    down = adapted(up, LIMITS, 40.0, -20.0, 10.0)
    assert (down.ground, down.climb, down.descent) == (4.0, 1.0, 3.0)
    assert seconds(down, 40.0, -20.0) == pytest.approx(10.0)
    assert is_steep(0.5, 20.0)
    assert not is_steep(5.0, 20.0)


def test_px4_is_told_no_vertical_speed_and_the_note_says_so() -> None:
    top = (0.0, -60.0, 40.0, 0.0, -0.2)
    source = plan(flight(shot(("shot", "half", 20.0, top), ("return", None, 10.0, HIGH)), pad=LOW))
    assert {p[0] for c, p in commands(source) if c == 178} <= {1}
    assert any("MPC_Z_V_AUTO_UP" in n for n in EMITTER.emit(source).notes)
    ardupilot = plan(source.trajectory.drones[0], autopilot="ardupilot")
    assert next(p[:2] for c, p in commands(ardupilot) if c == 178) == (2, 1)


def test_speeds_are_the_legs_mean_speeds() -> None:
    speeds = [p[1] for c, p in commands(plan(straight())) if c == 178]
    assert speeds == [4]


def test_recording_starts_and_stops_with_the_shot() -> None:
    names = {16: "fly", 22: "up", 21: "down", 2500: "start", 2501: "stop"}
    told = [names[c] for c, _ in commands(plan(straight())) if c in names]
    assert told == ["up", "fly", "start", "fly", "stop", "fly", "down"]


def test_a_hold_joins_its_waypoint_where_nothing_turns() -> None:
    moves = shot(("shot", "half", 10.0, EAST), ("shot", "half", 2.4, EAST), ("return", None, 10.0, HIGH))
    px4 = [p[0] for c, p in commands(plan(flight(moves, pad=LOW))) if c == 16]
    assert px4 == [3, 2.4, 0]
    source = plan(flight(moves, pad=LOW), autopilot="ardupilot")
    assert [p[0] for c, p in commands(source) if c == 16] == [3, 2, 0]
    assert any("off by up to 0.4 s" in n for n in EMITTER.emit(source).notes)


def test_a_still_shot_is_a_waypoint_held_for_its_length() -> None:
    moves = shot(("transit", None, 10.0, EAST), ("shot", "half", 12.0, EAST), ("return", None, 10.0, HIGH))
    told = [(c, p[0]) for c, p in commands(plan(flight(moves, pad=LOW))) if c in (16, 2500, 2501)]
    # Come to rest first, then film, then leave.
    assert told == [(16, 1), (2500, 0), (16, 12), (2501, 0), (16, 0)]


def test_whole_seconds_hand_on_what_they_lose() -> None:
    leg, command = StraightLeg(0, 1, "half", rest=True), Command(0.0, 0.0, 0.0, 0.0, 1.2)
    steps = [WaypointStep(leg, command, None, 0.0, 0.0, 0.0, hold, 0.5) for hold in (1.4, 1.4, 1.4, 0.0, 0.8)]
    assert [s.hold for s in whole_seconds(steps)] == [1, 2, 1, 0, 1]


def test_the_acceptance_radius_keeps_speed_and_corner() -> None:
    def turn(degrees: float, length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        a = radians(degrees)
        corner = np.array([length, 0.0, 0.0])
        return np.zeros(3), corner, corner + length * np.array([cos(a), sin(a), 0.0])

    gentle = _radius(*turn(10.0, 9.0), 9.0 / 8.0)
    assert gentle == pytest.approx(8.0**2 * np.tan(radians(5)) / CORNER_M_S2)
    assert gentle * np.tan(radians(2.5)) < CORNER_CUT_M
    sharp = _radius(*turn(90.0, 30.0), 30.0 / 8.0)
    assert sharp * np.tan(radians(22.5)) == pytest.approx(CORNER_CUT_M)
    assert _radius(*turn(10.0, 1.0), 1.0 / 8.0) <= 0.5
    assert _radius(*turn(180.0, 30.0), 30.0 / 8.0) >= 0.3
