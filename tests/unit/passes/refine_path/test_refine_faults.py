"""What refiners say of their solvers: stage, time, place, the worst constraint and its line."""

from __future__ import annotations

from functools import cache
from math import nan, radians
from pathlib import Path

import pytest

from shotc import plugin_api
from shotc.api import PlanOptions, compile_source
from shotc.diag.registry import severity_of
from shotc.passes.solver_reports import SolverState, fallback, impossible, solver_nan, stopped_early

TEMPLATE = Path(__file__).parents[4] / "shotc" / "templates" / "keyframes.yaml"
TEXT = TEMPLATE.read_text()


@cache
def path():
    done = compile_source(
        TEXT.encode(), "m.yaml", None, PlanOptions(refiner="none", stop_after="solve-path-qp")
    )
    return done.reports[-1].output


def shot_leg():
    return next(leg for leg in path().drones[0].legs if leg.shot)


def state(**changes):
    leg = shot_leg()
    limit = (*path().keyframes.mission.drones[0].path, "limits")
    made = SolverState(
        leg.shot, "ours", "fatrop", 37, 100, leg.marks[1].s + 0.3, 4.21, "gimbal pitch rate",
        radians(1.5), "rad/s", limit,
    )  # fmt: skip
    return made._replace(**changes)


WAYS = {
    "R010": solver_nan,
    "R011": lambda p, s: stopped_early(p, s, "300 iterations"),
    "R012": impossible,
}


@pytest.mark.parametrize("code", WAYS)
def test_a_solver_s_fault_tells_stage_time_place_and_the_worst_constraint(code):
    leg = shot_leg()
    fault = WAYS[code](path(), state())
    assert fault.code == code
    assert severity_of(fault) == "error"
    for word in ("fatrop", "`ours`", f"`{leg.shot}`"):
        assert word in fault.message
    told = " ".join(fault.notes)
    at = leg.marks[1].s + 0.3
    for word in ("stage 37 of 100", "4.21 s into the shot", f"{at:.1f} m along", "nearest keyframe 2"):
        assert word in told
    assert "gimbal pitch rate was broken by 1.5 deg/s" in told
    assert ("loosen gimbal pitch rate" in fault.help) is (code != "R010")
    assert "refine:" not in fault.help  # whether the convex path would do is not known yet


@pytest.mark.parametrize("code", WAYS)
def test_a_solver_s_fault_points_at_the_shot_and_at_the_limit(code):
    mission = path().keyframes.mission
    shot, limit = WAYS[code](path(), state()).labels
    assert shot.span == mission.origins.key(shot_leg().path).span
    assert limit.span == mission.origins.value(state().limit).span
    assert len(WAYS[code](path(), state(limit=())).labels) == 1


def test_how_long_a_solver_was_let_run_is_told():
    assert "after 300 iterations" in stopped_early(path(), state(), "300 iterations").message


def test_numbers_that_are_not_known_are_not_made_up():
    told = " ".join(solver_nan(path(), state(excess=nan, time=None)).notes)
    assert "gimbal pitch rate" in told
    assert "into the shot" not in told
    assert "nan" not in told


@pytest.mark.parametrize("code", WAYS)
def test_where_nothing_is_broken_no_stage_and_no_number_is_told(code):
    fault = WAYS[code](path(), state(stage=None, constraint="", excess=0.0, limit=()))
    (told,) = fault.notes
    assert "no constraint is broken" in told
    assert "stage" not in told
    assert fault.help == ""


def test_where_there_are_no_numbers_that_is_told():
    (told,) = solver_nan(path(), state(stage=None, constraint="", excess=nan, time=None)).notes
    assert "left no numbers" in told


def test_what_no_mission_can_loosen_is_not_to_be_loosened():
    assert impossible(path(), state(inner=True)).help == "move the keyframes next to it"


def test_an_announced_fallback_is_a_warning():
    warning = fallback(path(), shot_leg().shot, ("fatrop", "IPOPT"), "300 iterations")
    assert severity_of(warning) == "warning"
    assert "IPOPT" in warning.message
    assert warning.notes == ("fatrop: 300 iterations",)


@pytest.mark.parametrize("name", plugin_api.__all__)
def test_all_that_a_plugin_may_import_is_there(name):
    assert getattr(plugin_api, name) is not None
