"""The papers' films in wind and beside a walker who weaves: what is measured, on one small mission each."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.simulation import judge, runs
from shotc.simulation.conditions import Conditions
from shotc.simulation.gimbal import axes_of
from shotc.simulation.sensors import Gps
from tests.experiments.papers import flown, framing, lenses, tracked, weaving
from tests.experiments.papers.missions import convex_path

pytestmark = pytest.mark.slow

EXACT = Gps(noise=1e-6)

PAIR = b"""\
shotc: 1
mission: pair
targets: {walker: {track: {start: [0, 0, 0.9], velocity: [1.0, 0, 0]}, radius: 0.3, height: 1.8}}
drones:
  cam1: {model: x500, home: [8, -10, 0]}
  cam2: {model: x500, home: [8, 8, 0], priority: 2}
shots:
  - {id: side, kind: lateral, drone: cam1, target: walker, side: right, distance: 10, altitude: 3,
     timing: {start: 14, duration: 6}}
  - {id: other, kind: lateral, drone: cam2, target: walker, side: left, distance: 8, altitude: 4,
     timing: {start: 14, duration: 6}}
"""


SHORT = "lens-50-2"
"""A film of 20 s, of one target."""


@pytest.fixture(scope="module")
def draft():
    return next(each for each in lenses.drawn(50, 3) if each.name == SHORT)


@pytest.mark.long
def test_what_a_flight_shows_is_what_simulate_s_judge_sees(draft):
    made = framing.fly("none", convex_path(draft))
    ir, windy = made.plan.trajectory, Conditions(wind=flown.WIND)
    world, tracks = runs.flown(ir, windy, (0,))
    (judged,) = judge.judged(world, ir, tracks)
    (picture,), (course,) = judged.pictures, judged.courses
    (mine,) = flown.rehearse("one", made, windy, 1)
    assert mine.seen.error.mean() == pytest.approx(picture.error, rel=0.05)
    assert mine.seen.error.max() == pytest.approx(picture.worst, rel=0.05)
    assert (mine.seen.margin >= 0.0).mean() == pytest.approx(picture.in_frame, abs=0.02)
    assert mine.stray == pytest.approx(course.farthest)
    assert mine.roll == pytest.approx(course.roll)


@pytest.mark.long
def test_in_wind_the_table_has_a_row_for_the_plan_and_a_worse_one_for_each_loop(draft):
    table = flown.in_wind([draft], 2, lambda _said: None)
    assert [name for name, *_ in table.rows] == ["as planned", "flown, `replay`", "flown, `track`"]
    planned, replayed, tracked = (float(cells[1]) for cells in table.rows)
    assert planned < tracked < replayed < 0.5
    assert 0.2 < float(table.rows[1][-1]) < 2.0
    assert "1 of 1 missions" in table.notes[0]


@pytest.mark.long
def test_beside_a_steady_walker_the_measures_of_table_4_are_those_of_geometry():
    done = compile_source(PAIR, "pair.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    exact = Conditions(loop="replan", gps=EXACT, detector=None)
    found = weaving.fly(done.plan.trajectory, exact, 1, (16.0, 20.0))
    for told in (found["cam1"][0], found["cam2"][0]):
        assert told.way == pytest.approx(3.9, abs=0.1)  # 4 s at 1 m/s, but for the last step
        assert told.acceleration < 0.1
        assert told.apart == pytest.approx(18.0, abs=0.5)
        assert told.whole == 1.0
        assert told.off < 0.02
    assert weaving.row("case", "cam1", found["cam1"])[4] == f"{found['cam1'][0].apart:.2f} (9.54)"


def test_the_mean_acceleration_of_a_circle_is_its_centripetal_one():
    t = np.arange(0.0, 60.0, weaving.STEP_S)[:, None]
    place = np.hstack([np.cos(0.3 * t), np.sin(0.3 * t), 0 * t]) * 5.0
    velocity = np.hstack([-np.sin(0.3 * t), np.cos(0.3 * t), 0 * t]) * 1.5
    way, acceleration = weaving._motion(place, velocity)
    assert way == pytest.approx(1.5 * 59.9, rel=1e-3)
    assert acceleration == pytest.approx(0.45, rel=1e-3)


def test_a_camera_that_looks_beside_a_target_is_off_by_that_angle_and_may_lose_it():
    away = np.tile([2.0, 0.0, 0.0], (50, 1))
    yaw = np.repeat([0.3, 0.9], 25)
    told = tracked.measured(away, yaw, axes_of(yaw, 0 * yaw), np.full((50, 2), np.tan(0.6)), 0.1)
    assert told.out == 0.5
    assert told.off == pytest.approx(0.6)
    assert told.turning == pytest.approx(0.6 / 49 / 0.1)
    assert (told.away, told.spread) == (2.0, 0.0)


@pytest.mark.long
def test_a_robot_that_keeps_its_way_is_in_the_middle_and_as_far_as_planned():
    ir = tracked.trajectory()
    (told,) = tracked.fly(ir, Conditions(loop="track", gps=EXACT), 1, (22.0, 26.0))
    assert told.out == 0.0
    assert told.off < 0.02
    assert told.away == pytest.approx(np.hypot(1.8, 0.9), abs=0.05)
