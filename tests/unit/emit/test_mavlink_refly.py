from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from shotc.emit.mavlink import EMITTER
from shotc.emit.mavlink.items import MissionItem
from shotc.emit.mavlink.plan_file import read_plan
from shotc.emit.mavlink.refly import refly
from shotc.emit.mavlink.wpl import read_waypoints
from shotc.emit.waypoints.compare import Error, compare
from shotc.emit.waypoints.geo import Geo
from shotc.emit.waypoints.reflown import ReflownSamples
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.mavlink_flights import flight, plan, retold, straight
from tests.support.records import replace

PX4, ARDUPILOT = "px4", "ardupilot"


def artifact(source: VerifiedIR, name: str) -> bytes:
    return next(a.data for a in EMITTER.emit(source).artifacts if a.name == name)


def fly(source: VerifiedIR, items: list[MissionItem], home: tuple[float, float, float]) -> ReflownSamples:
    mission = source.trajectory.keyframes.mission
    assert mission.origin is not None
    return refly(items, Geo(mission.origin, *home), mission.drones[0])


def measured(source: VerifiedIR) -> Error:
    flown = fly(source, *read_plan(artifact(source, "cam1.plan")))
    return compare(source.trajectory.keyframes.mission, source.trajectory.drones[0], flown)


def turning(yaw: float, *, steady: bool = False):
    low, high = (0.0, -60.0, 0.0, 0.0, -0.2), (0.0, -60.0, 20.0, 0.0, -0.2)
    east = (40.0, -60.0, 20.0, yaw, -0.2)
    moves = [("takeoff", None, 8.0, high), ("shot", "half", 10.0, east), ("land", None, 8.0, low)]
    return flight(moves, pad=low, steady=steady)


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
def test_a_straight_flight_comes_back_exactly(autopilot: str) -> None:
    error = measured(plan(straight(), autopilot=autopilot))
    assert error.position < 1e-3
    assert error.heading < 1e-4
    assert error.screen < 2e-4


def test_ardupilot_turns_evenly_over_a_leg_so_an_even_turn_comes_back_exactly() -> None:
    error = measured(plan(turning(radians(40)), autopilot=ARDUPILOT))
    assert error.heading < radians(0.01)
    assert error.screen < 1e-3


def test_px4_holds_the_middle_of_a_legs_turn() -> None:
    error = measured(plan(turning(radians(40)), autopilot=PX4))
    assert radians(1.0) < error.heading <= radians(3.2)


@pytest.mark.slow
def test_files_of_both_formats_fly_alike() -> None:
    source = retold(orbit_plan(), autopilot=ARDUPILOT)
    one = fly(source, *read_plan(artifact(source, "cam1.plan")))
    other = fly(source, *read_waypoints(artifact(source, "cam1.waypoints")))
    assert np.abs(one.position - other.position).max() < 1e-6
    assert np.abs(one.cam_yaw - other.cam_yaw).max() < 1e-9


@pytest.mark.slow
def test_an_edited_file_is_noticed() -> None:
    source = orbit_plan()
    items, home = read_plan(artifact(source, "cam1.plan"))
    index = [i for i, item in enumerate(items) if item.command == 16][15]
    params = list(items[index].params)
    params[6] = params[6] + 2.0
    items[index] = replace(items[index], params=tuple(params))
    mission, drone = source.trajectory.keyframes.mission, source.trajectory.drones[0]
    assert compare(mission, drone, fly(source, items, home)).position == pytest.approx(2.0, abs=0.3)
    original, _ = read_plan(artifact(source, "cam1.plan"))
    aside = [
        replace(i, params=(*i.params[:4], i.params[4] + 5e-4, *i.params[5:])) if i.command == 195 else i
        for i in original
    ]
    assert compare(mission, drone, fly(source, aside, home)).screen > 0.5


def test_the_screen_error_is_the_angle_seen_through_the_lens() -> None:
    # Turn every gimbal pitch of a flight that films no target by one degree: v shifts by tan(1 deg)
    # over the half height, at the optical axis.
    source = plan(straight(), body="forward", gimbal=replace(GIMBAL, yaw=(0.0, 0.0)))
    items, home = read_plan(artifact(source, "cam1.plan"))
    tilted = [
        replace(i, params=(i.params[0] + 1.0, *i.params[1:])) if i.command == 1000 else i for i in items
    ]
    error = compare(
        source.trajectory.keyframes.mission, source.trajectory.drones[0], fly(source, tilted, home)
    )
    half_height = np.tan(radians(35)) * 9 / 16
    assert error.screen == pytest.approx(np.tan(radians(1.0)) / half_height, rel=1e-2)
    assert error.shot == "half"


GIMBAL = orbit_plan().trajectory.keyframes.mission.drones[0].gimbal


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
@pytest.mark.parametrize("off", [-0.6, 0.6])
def test_a_gimbal_that_looks_aside_looks_to_the_planned_side(autopilot: str, off: float) -> None:
    low, high = (0.0, -60.0, 0.0, 0.3, -0.2), (0.0, -60.0, 20.0, 0.3, -0.2)
    moves = [
        ("takeoff", None, 8.0, high),
        ("shot", "half", 10.0, high),
        ("land", None, 8.0, low),
    ]
    source = plan(flight(moves, pad=low, camera_off=off), autopilot=autopilot, body="free")
    items, home = read_plan(artifact(source, "cam1.plan"))
    assert 195 not in {i.command for i in items}
    flown = fly(source, items, home)
    assert flown.cam_yaw[flown.part == 1] == pytest.approx(0.3 + off, abs=1e-5)
    assert flown.body_yaw[flown.part == 1] == pytest.approx(0.3, abs=1e-5)


@pytest.mark.slow
def test_progress_pairs_a_turn_on_the_spot_with_its_own_instant() -> None:
    low, high = (0.0, -60.0, 0.0, 0.0, -0.2), (0.0, -60.0, 20.0, 0.0, -0.2)
    turned = (0.0, -60.0, 20.0, pi / 2, -0.2)
    moves = [("takeoff", None, 8.0, high), ("shot", "half", 20.0, turned), ("land", None, 8.0, low)]
    error = measured(plan(flight(moves, pad=low, steady=True), autopilot=ARDUPILOT))
    assert error.heading < radians(3.5)
    assert error.filmed == pytest.approx(20.0, abs=1.0)


@pytest.mark.slow
def test_a_body_without_a_swivelling_gimbal_is_turned_by_ardupilot_itself() -> None:
    fixed = replace(GIMBAL, yaw=(0.0, 0.0))
    source = retold(orbit_plan(), autopilot=ARDUPILOT, gimbal=fixed)
    items, _ = read_plan(artifact(source, "cam1.plan"))
    commands = [i.command for i in items]
    assert 115 not in commands[commands.index(2500) : commands.index(2501)]
    assert measured(source).screen < 0.01
