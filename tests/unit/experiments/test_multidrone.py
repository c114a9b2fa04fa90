"""The moving-target paper's tables: solved, checked by a second solver, and in the paper's order."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from tests.experiments.papers import multidrone
from tests.experiments.papers.chase import ACCELERATION, DT, SPEED, Chase, Weights, solve
from tests.experiments.papers.flyby import Measured, Reading, cubic, from_step, whole
from tests.experiments.papers.multidrone import (
    CONFIGURATIONS,
    LATERAL,
    PITCH_UP,
    PRINTED,
    REACHED,
    RECEDING,
    SCENE,
)
from tests.experiments.papers.report import text

pytestmark = pytest.mark.slow

DIST, RMSE, ACC, YAW_JERK, PITCH_JERK = range(5)
both = pytest.mark.parametrize("reading", [REACHED, PRINTED], ids=lambda reading: reading.name)


@cache
def flown(reading: Reading) -> dict[str, Measured]:
    return multidrone.flybys(reading)


def task(name: str, reading: Reading) -> Chase:
    return from_step(CONFIGURATIONS[name], reading, SCENE, (0, SCENE.steps), reading.start(SCENE))


def test_what_a_reading_starts_from_and_wants() -> None:
    assert REACHED.start(SCENE).tolist() == [-10.0, 0.0, 3.0, 0.0, 0.0, 0.0]
    assert REACHED.wanted(SCENE, 100) == pytest.approx([25.0, 0.0, 3.0, 0.0, 0.0, 0.0])
    assert PRINTED.start(SCENE).tolist() == [-10.0, 0.0, 3.0, 1.5, 0.0, 0.0]
    assert PRINTED.wanted(SCENE, 100) == pytest.approx([25.0, 0.0, 3.0, 3.5, 0.0, 0.0])
    for reading in (REACHED, PRINTED):
        assert reading.wanted(SCENE, 50) == pytest.approx([7.5, 0.0, 3.0, 3.5, 0.0, 0.0])


def test_a_cubic_has_the_velocities_of_its_ends() -> None:
    start, end = np.arange(6.0), np.array([7.0, -2.0, 4.0, 1.0, 0.5, -3.0])
    s = DT * np.arange(21)
    for axis, places in enumerate(cubic(start, end, 20).T):
        found = np.polynomial.Polynomial.fit(s, places, 3)
        assert [found(0.0), found(2.0)] == pytest.approx([start[axis], end[axis]])
        slope = found.deriv()
        assert [slope(0.0), slope(2.0)] == pytest.approx([start[axis + 3], end[axis + 3]])


@pytest.mark.long
@both
def test_all_eight_configurations_are_solved_and_stay_out_of_the_no_fly_circle(reading: Reading) -> None:
    assert len(flown(reading)) == 8
    for name, one in flown(reading).items():
        assert one.solved, name
        assert one.measures[DIST] > -1e-6, name


@pytest.mark.long
@both
def test_no_configuration_planned_whole_needs_many_iterations(reading: Reading) -> None:
    assert max(flown(reading)[name].iterations for name in CONFIGURATIONS) <= 20


@both
@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_a_second_solver_finds_the_same_flight_within_all_limits(name: str, reading: Reading) -> None:
    a, b = solve(task(name, reading)), solve(task(name, reading), "ipopt")
    assert b.solved
    assert np.abs(a.states - b.states).max() < 0.01
    x, u = a.states, a.inputs
    assert np.abs(x[0] - reading.start(SCENE)).max() < 1e-5
    assert np.abs(x[1:, :3] - x[:-1, :3] - DT * (x[:-1, 3:] + DT * u / 2)).max() < 1e-6
    assert np.abs(x[1:, 3:] - x[:-1, 3:] - DT * u).max() < 1e-6
    assert np.abs(u).max() < ACCELERATION + 1e-6
    assert np.abs(x[:, 3:]).max() < SPEED + 1e-6


@pytest.mark.slow
def test_with_the_weights_as_printed_the_paper_s_order_holds_at_each_step() -> None:
    order = [flown(PRINTED)[name].measures for name in PITCH_UP]
    for a, b in pairwise(order):
        assert a[DIST] < b[DIST]
        assert a[RMSE] < b[RMSE]
        assert a[ACC] < b[ACC]
        assert a[YAW_JERK] > b[YAW_JERK]
        assert a[PITCH_JERK] > b[PITCH_JERK]
    assert multidrone.in_order(PRINTED, SCENE)


@pytest.mark.slow
def test_with_the_end_reached_flights_go_wider_and_the_camera_calms_down_to_medium() -> None:
    order = [flown(REACHED)[name].measures for name in PITCH_UP]
    for column in (DIST, RMSE, ACC):
        assert all(a[column] < b[column] for a, b in pairwise(order))
    for column in (YAW_JERK, PITCH_JERK):
        plain, low, medium, high = (m[column] for m in order)
        assert low < 0.1 * plain
        assert medium < high < low
    assert not multidrone.in_order(REACHED, SCENE)


def test_with_the_end_reached_the_jerk_tends_to_that_of_half_a_circle_from_rest_to_rest() -> None:
    half_a_circle = 12.0 * np.pi / (DT * SCENE.steps) ** 3
    limit = whole(Weights(pitch=1e6), REACHED, SCENE)
    assert limit.solved
    assert limit.measures[YAW_JERK] == pytest.approx(half_a_circle, rel=0.05)
    assert flown(REACHED)["medium pitch"].measures[YAW_JERK] < 0.9 * half_a_circle
    target = np.column_stack([SCENE.speed * DT * np.arange(SCENE.steps + 1), np.zeros(SCENE.steps + 1)])
    apart = np.linalg.norm(limit.states[:, :2] - target, axis=1)
    assert np.abs(apart - 10.0).max() < 0.25


def test_how_far_from_the_wanted_end_each_reading_stays() -> None:
    assert max(flown(REACHED)[name].missed for name in CONFIGURATIONS) < 1.0
    missed = [flown(PRINTED)[name].missed for name in PITCH_UP]
    assert missed == sorted(missed)
    assert 5.0 < missed[-1] < 6.0


@both
def test_the_full_cost_is_as_calm_as_the_paper_s(reading: Reading) -> None:
    for name in ("full", RECEDING):
        measures = flown(reading)[name].measures
        assert measures[YAW_JERK] <= 0.10
        assert measures[PITCH_JERK] <= 0.03


@pytest.mark.slow
def test_the_lateral_goes_round_the_circle_and_back() -> None:
    one = multidrone.lateral()
    assert one.solved
    assert one.measures[DIST] > -1e-6
    assert one.measures[ACC] <= min(row[1] for row in LATERAL.values())
    assert one.measures[RMSE] <= max(row[0] for row in LATERAL.values())
    assert np.abs(one.states[-1, :2] - [30.0, -8.0]).max() < 0.2


@pytest.mark.slow
def test_the_tables_can_be_read() -> None:
    for reading in (REACHED, PRINTED):
        flyby = text(multidrone.flyby_table(reading, flown(reading), ("a note",)))
        assert reading.name in flyby
        assert "full, receding" in flyby
        assert "(0.03)" in flyby
        assert "a note" in flyby
    assert "20 s, whole" in text(multidrone.lateral_table(multidrone.lateral()))
