"""Replanners of other packages in a process of their own: what they fail at, and what is read of them."""

from __future__ import annotations

import pickle
from contextlib import closing

import numpy as np
import pytest
from shotc_casadi.replan.replanner import OURS

from shotc import child_process, plugins
from shotc.plugin_api.replanner import Plan
from shotc.simulation import replanner_process
from shotc.simulation.replanner_answers import fault_of
from shotc.simulation.replanner_process import (
    ReplannerFailed,
    ReplannerHangs,
    ReplannerProcess,
    replanner,
    serve,
)
from tests.support.failing_replanners import GARBAGE, LATE, LISTS, NAN, SAYS_NO, SHORT, STATUS
from tests.support.replans import DT, problem, situation

pytestmark = pytest.mark.slow

FAILING = "tests.support.failing_replanners"
STAGES = 5


def still(now=0.0):
    zeros = np.zeros((STAGES + 1, 3))
    return Plan(now + DT * np.arange(STAGES + 1), zeros, zeros.copy(), zeros[1:].copy())


def asked(name, now=0.0, seconds=30.0):
    with closing(ReplannerProcess(f"{FAILING}:{name}", seconds)) as process:
        return process.chase(problem(STAGES)).replan(situation(STAGES, now), still(now))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("RAISES", "ZeroDivisionError: no plan today"),
        ("RAISES_AT_ONCE", "LookupError: no planner today"),
        ("DIES", "its process ended with status 3 and no answer"),
        ("NOBODY", f"AttributeError: module '{FAILING}' has no attribute 'NOBODY'"),
    ],
)
def test_a_replanner_that_fails_in_its_process_has_a_reason(name, reason):
    with pytest.raises(ReplannerFailed, match=f"^{reason}$"):
        asked(name)


def test_an_answer_that_cannot_be_sent_is_a_failure_and_not_the_end_of_the_process():
    with closing(ReplannerProcess(f"{FAILING}:LAMBDA", 30.0)) as process:
        planner = process.chase(problem(STAGES))
        for now in (0.0, 0.5):
            with pytest.raises(ReplannerFailed, match="pickle"):
                planner.replan(situation(STAGES, now), still(now))


@pytest.mark.slow
def test_a_replanner_that_hangs_in_c_is_killed_and_asked_again_in_a_new_process(monkeypatch):
    with closing(ReplannerProcess(f"{FAILING}:HANGS_LATER", 0.5)) as process:
        planners = [process.chase(problem(STAGES)) for _ in range(2)]
        one, other = (planner.replan(situation(STAGES, 1.0), still()) for planner in planners)
        first = process._process
        with pytest.raises(ReplannerHangs, match=r"^it took more than 0\.5 s$"):
            planners[0].replan(situation(STAGES, 10.0), still())
        assert first.returncode is not None
        again = planners[1].replan(situation(STAGES, 1.0), still())
        assert process._process is not first
    assert np.array_equal(again.plan.times, other.plan.times)
    assert np.array_equal(one.plan.times, other.plan.times)


@pytest.mark.long
def test_a_process_that_lost_its_parent_while_it_hangs_ends_itself():
    with child_process.started(serve.__module__, serve.__name__) as process:
        order = replanner_process._ReplanRequest(0, problem(STAGES), situation(STAGES), still())
        for part in (child_process.module_path(), pickle.dumps((f"{FAILING}:HANGS", 0.2))):
            process.stdin.write(part)
        process.stdin.write(pickle.dumps(order))
        process.stdin.close()
        assert process.wait() == 1


@pytest.mark.parametrize(
    ("plugin", "reason"),
    [
        (NAN, "its plan holds numbers that are not finite"),
        (SAYS_NO, "it does not know"),
        (GARBAGE, "it returned a int and no Replan"),
        (SHORT, "`places` of its plan has the shape (5, 3), and (6, 3) is wanted"),
        (LISTS, "`places` of its plan is a list and no array of floats"),
        (LATE, "the times of its plan are not those of the stages"),
        (STATUS, "its status is 'splendid'"),
    ],
)
def test_what_cannot_be_flown_is_refused_with_a_reason(plugin, reason):
    answer = plugin.replan(situation(STAGES), still())
    assert fault_of(answer, still().times) == reason


@pytest.mark.slow
def test_a_plan_in_another_process_is_the_same_to_the_last_digit():
    known = situation(STAGES, place=np.array([0.3, -7.5, 3.1]))
    task = problem(STAGES)
    first = OURS.chase(task).replan(known, None)
    assert fault_of(first, known.time + DT * np.arange(STAGES + 1)) == ""
    with closing(ReplannerProcess("shotc_casadi.replan.replanner:OURS", 60.0)) as process:
        there = process.chase(task).replan(known, None)
    assert pickle.dumps(there.plan) == pickle.dumps(first.plan)


def test_ours_has_no_process_and_others_have_one(monkeypatch):
    with replanner("ours") as found:
        assert found is OURS
    theirs = plugins.Source(None, "theirs", f"{FAILING}:SAYS_NO")
    monkeypatch.setattr(plugins, "one", lambda _group, _name: theirs)
    with replanner("theirs") as found:
        found.chase(problem(STAGES)).replan(situation(STAGES), still())
        process = found._process
    assert process.returncode is not None
