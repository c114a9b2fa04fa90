"""Solvers that fail, cameras that do not hold, ways that do not lead back: each is told as what it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shotc_casadi import program, refiner, rounds
from shotc_casadi.camera import NoFit
from shotc_casadi.margins import Check
from shotc_casadi.refiner import ANG, FRAMING_ONLY, LOOK_AT, OURS, OURS_4PT
from shotc_casadi.rounds import MOST_ROUNDS, SOLVERS

from shotc import plugins
from shotc.diag.registry import has_errors
from shotc.ir.passes import PassContext
from shotc.passes.refine_path import RefinePath, Seat
from shotc.plugin_api.refiner import NoTransit, rejoined
from tests.support.bad_refiners import PASS, ROUND, leg, path

pytestmark = pytest.mark.slow

REAL = program.solve


def failing(*names, status="stopped", **more):
    """A solve that fails for some solvers, after as many iterations as it may have."""

    def solve(task, solver):
        solution = REAL(task, solver)
        if solver not in names:
            return solution
        given = {"status": status, "iterations": 300, "residual": 2.5, "stage": 40, "constraint": "speed"}
        return replace(solution, **given | more)

    return solve


def only(shot, monkeypatch):
    """Refine one shot of the mission only."""
    every = refiner.subjects
    monkeypatch.setattr(refiner, "subjects", lambda ir: [s for s in every(ir) if s.leg.shot == shot])


def refined(ir=None):
    return OURS.refine(ir or path(), PassContext())


def test_the_seat_knows_all_five():
    names = plugins.names("refiners")
    for made in (OURS, OURS_4PT, FRAMING_ONLY, LOOK_AT, ANG):
        assert made.name in names
        assert plugins.one("refiners", made.name).plugin is made
        assert made.api == 1
        assert made.summary


def test_without_a_fault_nothing_is_said():
    outcome = refined()
    assert outcome.diagnostics == ()
    stats = dict(outcome.value.stats)
    assert {name.split(".")[0] for name in stats if "refine" in name} == {PASS, ROUND}
    assert all(stats[f"{shot}.refine_solver"] == SOLVERS[0] for shot in (PASS, ROUND))


@pytest.mark.long
@pytest.mark.parametrize(("status", "code"), [("nan", "R010"), ("stopped", "R011"), ("infeasible", "R012")])
def test_a_shot_that_no_solver_solves_is_an_error_with_its_stage(monkeypatch, status, code):
    only(PASS, monkeypatch)
    monkeypatch.setattr(rounds, "solve", failing(*SOLVERS, status=status))
    outcome = refined()
    (told,) = outcome.diagnostics
    assert told.code == code
    assert PASS in told.message
    assert "ours" in told.message
    assert SOLVERS[1] in told.message
    text = " ".join((told.message, *told.notes))
    assert "stage 40 of 100" in text
    assert "speed" in text
    assert np.array_equal(leg(outcome.value, PASS).curve.ctrl, leg(path(), PASS).curve.ctrl)


@pytest.mark.parametrize(
    ("residual", "words"), [(0.0, "no constraint is broken"), (np.nan, "left no numbers")]
)
def test_where_nothing_is_known_to_be_broken_no_stage_is_named(monkeypatch, residual, words):
    only(PASS, monkeypatch)
    given = {"stage": 0, "constraint": "", "residual": residual}
    monkeypatch.setattr(rounds, "solve", failing(*SOLVERS, **given))
    (told,) = refined().diagnostics
    assert told.code == "R011"
    assert words in told.notes[0]
    assert "stage" not in " ".join(told.notes)
    assert "broken by" not in " ".join(told.notes)
    assert told.help == ""


def test_an_iterate_that_is_no_number_has_no_time(monkeypatch):
    only(PASS, monkeypatch)

    def solve(task, solver):
        solution = REAL(task, solver)
        return replace(solution, status="nan", states=np.full_like(solution.states, np.nan), residual=np.nan)

    monkeypatch.setattr(rounds, "solve", solve)
    (told,) = refined().diagnostics
    assert told.code == "R010"
    assert "nan" not in " ".join(told.notes)


def test_where_fatrop_fails_ipopt_is_used_and_announced(monkeypatch):
    only(ROUND, monkeypatch)
    monkeypatch.setattr(rounds, "solve", failing("fatrop"))
    outcome = refined()
    (told,) = outcome.diagnostics
    assert told.code == "R013"
    assert not has_errors(outcome.diagnostics)
    assert "ipopt" in told.message
    assert "fatrop" in told.message
    assert told.notes == ("fatrop: 300 iterations",)
    assert dict(outcome.value.stats)[f"{ROUND}.refine_solver"] == "ipopt"
    assert not np.array_equal(leg(outcome.value, ROUND).curve.ctrl, leg(path(), ROUND).curve.ctrl)
    settled = RefinePath(Seat(OURS, "shotc-casadi")).run(path(), PassContext())
    assert [d.code for d in settled.diagnostics] == ["R013"]
    assert not np.array_equal(leg(settled.value, ROUND).curve.ctrl, leg(path(), ROUND).curve.ctrl)


def test_a_solver_that_did_not_end_is_called_so(monkeypatch):
    only(ROUND, monkeypatch)
    monkeypatch.setattr(rounds, "solve", failing("fatrop", iterations=0))
    (told,) = refined().diagnostics
    assert told.notes == ("fatrop: 30 s of processor time without an end",)


def test_one_shot_that_fails_leaves_the_other_refined(monkeypatch):
    calls = []

    def solve(task, solver):
        calls.append(task.stages)
        return failing(*SOLVERS)(task, solver) if len(calls) <= 2 else REAL(task, solver)

    monkeypatch.setattr(rounds, "solve", solve)
    outcome = refined(path(PASS))
    assert [d.code for d in outcome.diagnostics] == ["R011"]
    assert np.array_equal(leg(outcome.value, PASS).curve.ctrl, leg(path(PASS), PASS).curve.ctrl)
    assert not np.array_equal(leg(outcome.value, ROUND).curve.ctrl, leg(path(PASS), ROUND).curve.ctrl)
    calls.clear()
    settled = RefinePath(Seat(OURS, "shotc-casadi")).run(path(PASS), PassContext())
    assert [d.code for d in settled.diagnostics] == ["R003"]


def test_a_camera_that_is_never_clear_is_told_by_its_clearance(monkeypatch):
    only(PASS, monkeypatch)
    seen = []

    def never(subject, condition, camera):
        seen.append(camera)
        return Check(1.0 / len(seen), 0.0, 0.0, 0.0)

    monkeypatch.setattr(rounds, "checked", never)
    outcome = refined()
    assert len(seen) == MOST_ROUNDS
    (told,) = outcome.diagnostics
    assert told.code == "R012"
    assert "clearances between stages" in told.message
    assert "iterations" not in told.message
    assert np.array_equal(leg(outcome.value, PASS).curve.ctrl, leg(path(), PASS).curve.ctrl)


def test_nodes_that_no_camera_goes_through_are_told_by_the_gimbal(monkeypatch):
    only(PASS, monkeypatch)

    def none(*_):
        raise NoFit

    monkeypatch.setattr(rounds, "camera", none)
    (told,) = refined().diagnostics
    assert told.code == "R012"
    assert "gimbal" in told.message


def test_the_best_round_is_kept_with_the_solver_that_made_it(monkeypatch):
    """The second round crops less but fails in both solvers: the first one's camera is flown."""
    only(PASS, monkeypatch)
    seen = []

    def cropped(subject, condition, camera):
        seen.append(camera)
        return Check(0.0, 0.0, 0.0, 0.01)

    def solve(task, solver):
        return failing(*SOLVERS)(task, solver) if seen else REAL(task, solver)

    monkeypatch.setattr(rounds, "checked", cropped)
    monkeypatch.setattr(rounds, "solve", solve)
    outcome = refined()
    assert outcome.diagnostics == ()
    stats = dict(outcome.value.stats)
    assert stats[f"{PASS}.refine_solver"] == "fatrop"
    assert stats[f"{PASS}.refine_status"] == "solved"
    assert stats[f"{PASS}.refine_rounds"] == 2.0
    assert leg(outcome.value, PASS).curve(leg(path(), PASS).curve.end)[:5] == pytest.approx(
        seen[0](seen[0].end)
    )


def test_a_shot_whose_new_ends_cannot_be_reached_keeps_its_convex_path(monkeypatch):
    def blocked(ir, cameras):
        if PASS in cameras:
            raise NoTransit("no way leads to shot pass")
        return rejoined(ir, cameras)

    monkeypatch.setattr(refiner, "rejoined", blocked)
    outcome = refined()
    (told,) = outcome.diagnostics
    assert told.code == "R012"
    assert "no way leads to shot pass" in told.message
    assert np.array_equal(leg(outcome.value, PASS).curve.ctrl, leg(path(), PASS).curve.ctrl)
    assert not np.array_equal(leg(outcome.value, ROUND).curve.ctrl, leg(path(), ROUND).curve.ctrl)
