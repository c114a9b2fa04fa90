"""The bound on the gain of another round: multipliers of half-spaces are slopes of the optimal cost."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from shotc_casadi.clock.gain_bound import gain_bound
from shotc_casadi.clock.problem import ClockProblem, Use, breaks_of, guess, problem, table_of
from shotc_casadi.clock.program import solve
from shotc_casadi.clock.references import ClockSubject, references_at
from shotc_casadi.clock.refiner import refine_one, subject_of
from shotc_casadi.clock.rounds import NEARLY_SHARE, REACH_M, ROOM_SHARE
from shotc_casadi.clock.symbols import PLANE_PARAMETERS
from shotc_casadi.solving import Solution

from shotc.api import PlanOptions, compile_source
from shotc.plugin_api import PathIR
from shotc.plugin_api.refiner import NO_HALF_SPACES, HalfSpaces, restrict, surroundings
from tests.unit.planning.clock.test_several_drones import HEAD, PASS, SIDE

pytestmark = pytest.mark.slow


@cache
def path() -> PathIR:
    """Two drones film one runner from the same side: the second has to go round the first."""
    done = compile_source(f"{HEAD}{SIDE}{PASS}".encode(), "two.yaml", None, PlanOptions(refiner="none"))
    return next(report.output for report in done.reports if report.name == "solve-path-qp")


@cache
def beside() -> tuple[ClockSubject, HalfSpaces]:
    of = subject_of(path(), "pass")
    breaks = breaks_of(of)
    guide = restrict(of.leg.curve.channels(0, 1, 2), breaks)
    around = surroundings(of.path, of.drone, breaks)
    return of, around.half_spaces(guide.ctrl, REACH_M, ROOM_SHARE)


def task(planes: HalfSpaces) -> ClockProblem:
    of, _ = beside()
    breaks = breaks_of(of)
    start = guess(restrict(of.leg.curve.channels(0, 1, 2), breaks), breaks)
    return problem(of, breaks, references_at(of, breaks), planes, Use(NEARLY_SHARE), start)


@cache
def solved(given_way: float = 0.0) -> Solution:
    solution = solve(task(moved(given_way)), "fatrop")
    assert solution.status == "solved"
    return solution


def moved(metres: float) -> HalfSpaces:
    """The half-spaces, each moved back by so many metres."""
    planes = beside()[1]
    return replace(planes, offset=planes.offset - metres)


@pytest.mark.parametrize("metres", [0.02, 0.1, 0.3])
def test_the_saving_is_within_the_bound_and_near_it_for_small_steps(metres: float) -> None:
    bound = gain_bound(task(moved(0.0)), solved(), moved(metres), REACH_M) * solved().objective
    saved = solved().objective - solved(metres).objective
    assert 0.0 < saved < bound
    if metres < 0.05:
        assert saved > 0.5 * bound


def test_half_spaces_that_stay_allow_no_gain() -> None:
    assert gain_bound(task(moved(0.0)), solved(), moved(0.0), REACH_M) < 1e-3


def test_a_half_space_that_faces_elsewhere_does_not_replace_the_old_one() -> None:
    planes = beside()[1]
    turned = replace(planes, normal=-planes.normal, offset=-planes.offset - 0.01)
    last = task(moved(0.0))
    for others in (turned, NO_HALF_SPACES):
        assert gain_bound(last, solved(), others, REACH_M) > gain_bound(last, solved(), moved(0.3), REACH_M)


def test_half_spaces_stand_in_the_slots_of_their_stages() -> None:
    planes = beside()[1]
    stages = task(planes).stages
    table = table_of(planes, stages)
    filled = np.abs(table[:, :, :3]).max(axis=2) > 0.0
    assert (filled.sum(axis=1) == np.bincount(planes.piece, minlength=stages)).all()
    found = {tuple(row[:4].tolist()) for row in table[filled]}
    asked = np.column_stack([planes.normal, planes.offset[:, 0]])
    assert found == {tuple(row.tolist()) for row in asked}
    assert (table[~filled] == [0.0, 0.0, 0.0, -1.0, 0.0]).all()
    assert table_of(NO_HALF_SPACES, stages).shape == (stages, 0, PLANE_PARAMETERS)


def test_a_shot_that_nothing_binds_is_solved_once_and_one_that_is_bound_more_often() -> None:
    rounds = [
        dict(refine_one(path(), shot, "ours")[0].stats)[f"{shot}.refine_rounds"] for shot in ("side", "pass")
    ]
    assert rounds[0] == 1.0
    assert rounds[1] > 1.0
