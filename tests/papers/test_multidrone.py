"""The moving-target paper's tables: solved, checked by a second solver, and in the paper's order."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from tests.papers import multidrone
from tests.papers.chase import ACCELERATION, DT, SPEED, Chase, solve
from tests.papers.multidrone import CONFIGURATIONS, LATERAL, RECEDING, Measured
from tests.papers.report import text

DIST, RMSE, ACC, YAW_JERK, PITCH_JERK = range(5)


@cache
def flown() -> dict[str, Measured]:
    return multidrone.flybys()


def task(name: str) -> Chase:
    return multidrone._flyby_task(CONFIGURATIONS[name], 0, 100, multidrone._rest(-10.0))


def test_all_eight_configurations_are_solved_and_stay_out_of_the_no_fly_circle() -> None:
    assert len(flown()) == 8
    for name, one in flown().items():
        assert one.solved, name
        assert one.measures[DIST] > -1e-6, name


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_a_second_solver_finds_the_same_flight_within_all_limits(name: str) -> None:
    a, b = solve(task(name)), solve(task(name), "ipopt")
    assert b.solved
    assert np.abs(a.states - b.states).max() < 0.01
    x, u = a.states, a.inputs
    assert np.abs(x[0] - multidrone._rest(-10.0)).max() < 1e-5
    assert np.abs(x[1:, :3] - x[:-1, :3] - DT * (x[:-1, 3:] + DT * u / 2)).max() < 1e-6
    assert np.abs(x[1:, 3:] - x[:-1, 3:] - DT * u).max() < 1e-6
    assert np.abs(u).max() < ACCELERATION + 1e-6
    assert np.abs(x[:, 3:]).max() < SPEED + 1e-6


def test_more_weight_on_pitch_goes_wider_and_turns_the_camera_more_calmly() -> None:
    order = [
        flown()[name].measures for name in ("no cinematography", "low pitch", "medium pitch", "high pitch")
    ]
    for column in (DIST, RMSE, ACC):
        assert all(a[column] < b[column] for a, b in pairwise(order))
    for column in (YAW_JERK, PITCH_JERK):
        plain, low, *rest = (m[column] for m in order)
        assert low < 0.1 * plain
        assert max(rest) < low


def test_the_full_cost_is_as_calm_as_the_paper_s() -> None:
    for name in ("full", RECEDING):
        measures = flown()[name].measures
        assert measures[YAW_JERK] <= 0.10
        assert measures[PITCH_JERK] <= 0.03


def test_the_lateral_goes_round_the_circle_and_back() -> None:
    one = multidrone.lateral()
    assert one.solved
    assert one.measures[DIST] > -1e-6
    assert one.measures[ACC] <= min(row[1] for row in LATERAL.values())
    assert one.measures[RMSE] <= max(row[0] for row in LATERAL.values())
    assert np.abs(one.states[-1, :2] - [30.0, -8.0]).max() < 0.2


def test_the_tables_can_be_read() -> None:
    section = multidrone.section()
    flyby, lateral = (text(table) for table in section.tables)
    assert "full, receding" in flyby
    assert "(0.03)" in flyby
    assert "20 s, whole" in lateral
