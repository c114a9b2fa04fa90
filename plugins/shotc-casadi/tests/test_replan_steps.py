"""The units of slack in a step's programme: they change how long it takes, not what it finds."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.replan import chase, evaluation, steps
from shotc_casadi.replan.chase import ShotChase

from shotc.plugin_api.replanner import Plan
from tests.support.replans import BESIDE, LIMITS, TREE, WALK, lateral, problem, situation, zone

SLOW = LIMITS._replace(speed=2.0, acceleration=1.5)


def iterations(planner: ShotChase) -> int:
    """Return how many the last programme took."""
    (solver,) = planner._flight._solvers.values()
    return int(solver._solver.result.info.iter)


def past_a_tree(pushed: float = 0.0) -> tuple[list[Plan], list[int]]:
    """Return plans of a flight beside a tree, in which next to nothing is lacking.

    pushed : standard deviation by which the drone is off its plan at every replan, metres
    """
    known, planner, plan = lateral(20, 7), ShotChase(problem(20, zone(TREE))), None
    rng = np.random.default_rng(1)
    plans, took = [], []
    for k in range(30 if pushed else 8):
        place, velocity = BESIDE + 0.5 * k * WALK, WALK
        if plan is not None and pushed:
            place, velocity = plan.places[5] + pushed * rng.standard_normal(3), plan.velocities[5]
        plan = planner.replan(known(0.5 * k, place, velocity), plan).plan
        assert plan is not None
        plans.append(plan)
        took.append(iterations(planner))
    return plans, took


def too_fast(speed: float) -> tuple[Plan, int]:
    """Return the plan of a drone that is faster than it may be, and the iterations of its last step."""
    planner = ShotChase(problem(30, limits=SLOW))
    done = planner.replan(situation(30, velocity=np.array([speed, 0.0, 0.0])), None)
    assert done.status == "opened"
    assert done.plan is not None
    return done.plan, iterations(planner)


@pytest.fixture
def in_metres(monkeypatch: pytest.MonkeyPatch):
    """Price slacks in metres, as if there were no units, for what is made from now on."""

    def use(unit: float) -> None:
        monkeypatch.setattr(evaluation, "_unit", lambda prices, lack, late: unit * ca.MX.ones(lack.shape))
        chase._horizon.cache_clear()

    yield use
    chase._horizon.cache_clear()


def test_units_halve_the_iterations_and_change_no_plan(in_metres, monkeypatch) -> None:
    plans, took = past_a_tree()
    in_metres(1.0)
    monkeypatch.setattr(steps, "TOLERANCE", 1e-8)
    monkeypatch.setattr(steps, "GAP_TOLERANCE", 1e-8)
    exact, _ = past_a_tree()
    monkeypatch.undo()
    in_metres(1.0)
    _, slower = past_a_tree()
    assert max(np.abs(a.places - b.places).max() for a, b in zip(plans, exact, strict=True)) < 2e-3
    assert sum(took[1:]) < 0.7 * sum(slower[1:])


def test_small_violations_beside_an_obstacle_cost_no_iterations(monkeypatch) -> None:
    plans, took = past_a_tree(0.1)
    monkeypatch.setattr(evaluation, "LARGE_LACK", 0.0)  # all units are as large as the violations
    chase._horizon.cache_clear()
    same, more = past_a_tree(0.1)
    chase._horizon.cache_clear()
    assert max(np.abs(a.places - b.places).max() for a, b in zip(plans, same, strict=True)) < 2e-3
    assert max(took) <= 8 < max(more)
    assert sum(took) < 0.95 * sum(more)


def test_who_lacks_much_is_solved_in_few_iterations_too(in_metres) -> None:
    few = [too_fast(speed)[1] for speed in (4.0, 6.0, 9.0)]
    assert max(few) < 16
    in_metres(1e-4)  # so little that a unit costs 1, whatever is lacking
    with pytest.raises(AssertionError):
        too_fast(6.0)
