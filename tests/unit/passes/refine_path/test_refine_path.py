"""What a refiner may answer, and what becomes of it."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import BODY_YAW, CAM_YAW, PathDeviation
from shotc.passes.refine_path import REFINER, RefinePath, Seat, Unusable
from tests.support.bad_refiners import PASS, ROUND, along, bumped, leg, nan, path, refine, returns, with_leg
from tests.support.records import replace


def loose(ir):
    """End the way to the first shot beside its start."""
    curve = ir.drones[0].legs[1].curve
    ctrl = curve.ctrl.copy()
    ctrl[-1, -1, 1] -= 0.5
    return with_leg(ir, 1, curve=Piecewise(curve.breaks, ctrl))


def raise_(_):
    raise RuntimeError("no luck")


def own(ir, shot, code="R012"):
    """An error of the refiner's own, about one shot."""
    mission = ir.keyframes.mission
    where = next(s.path for s in mission.shots if s.id == shot)
    return Diagnostic(code, f"no luck with {shot}", (mission.origins.key(where),), ("worst at stage 3",))


def test_none_gives_the_path_back():
    assert REFINER.refine(path(), PassContext()).value is path()
    outcome = RefinePath(Seat()).run(path(), PassContext())
    assert outcome.value is path()
    assert outcome.diagnostics == ()


def test_a_better_path_is_taken_as_it_is():
    better = bumped(path(), ROUND, along(2, 1.0))
    outcome = refine(lambda ir: Outcome(better))
    assert outcome.value is better
    assert outcome.diagnostics == ()


@pytest.mark.parametrize(
    ("act", "code", "words"),
    [
        (raise_, "R001", "RuntimeError: no luck"),
        (lambda ir: sys.exit(0), "R001", "SystemExit: 0"),
        (lambda ir: None, "R002", "NoneType, not an Outcome"),
        (lambda ir: ir, "R002", "PathIR, not an Outcome"),
        (lambda ir: Outcome("a path"), "R002", "str, not a PathIR"),
        (lambda ir: Outcome(None), "R002", "does not say why"),
        (lambda ir: Outcome(None, (Diagnostic("R999", "?"),)), "R002", "unknown codes"),
        (lambda ir: Outcome(ir, ("slow",)), "R002", "its diagnostics are not Diagnostics"),
        (lambda ir: Outcome(replace(ir, drones=())), "R002", "legs"),
        (lambda ir: Outcome(replace(ir, drones=None)), "R002", "to read it raises TypeError"),
        (returns(nan), "R002", "not finite"),
        (returns(loose), "R002", "the shot begins 0.5 from where the transit ends"),
    ],
    ids=[
        "raises", "exits", "nothing", "a bare path", "no path", "no reason", "unknown code", "no diagnostic",
        "other legs", "no legs", "nan", "loose legs",
    ],
)  # fmt: skip
def test_what_a_refiner_does_wrong_is_an_error_that_names_it_and_its_package(act, code, words):
    outcome = refine(act)
    assert outcome.value is None
    (fault,) = outcome.diagnostics
    assert fault.code == code
    assert "`odd` of package odd-maker" in fault.message
    assert words in " ".join(fault.notes)
    assert "authors of odd-maker" in fault.help


@pytest.mark.parametrize(
    "act", [raise_, returns(nan), lambda ir: Outcome(None, (own(ir, PASS),))], ids=["raises", "nan", "own"]
)
def test_where_every_shot_accepts_it_the_convex_path_is_kept_with_warnings(act):
    outcome = refine(act, PASS, ROUND)
    assert leg(outcome.value, PASS) is leg(path(PASS, ROUND), PASS)
    assert {d.code for d in outcome.diagnostics} == {"R003"}
    assert not has_errors(outcome.diagnostics)
    for warning in outcome.diagnostics:
        assert "`odd` of package odd-maker" in warning.message
        assert warning.notes


def test_a_refiner_s_own_errors_are_passed_on_with_its_package():
    outcome = refine(lambda ir: Outcome(None, (own(ir, PASS),)))
    assert outcome.value is None
    (fault,) = outcome.diagnostics
    assert fault.message == "no luck with pass"
    assert fault.notes == ("worst at stage 3", "reported by refiner `odd` of package odd-maker")


def test_a_refiner_s_warnings_are_passed_on():
    warning = Diagnostic("R013", "the second solver was used")
    outcome = refine(lambda ir: Outcome(ir, (warning,)))
    assert outcome.diagnostics == (warning,)
    assert outcome.value is path()


def convex_where_it_failed(ir):
    """Refine `round` alone, and say that `pass` could not be."""
    return Outcome(bumped(ir, ROUND, along(2, 1.0)), (own(ir, PASS),))


def test_a_shot_that_accepts_it_flies_its_convex_path_and_the_others_stay_refined():
    outcome = refine(convex_where_it_failed, PASS)
    given = path(PASS)
    assert leg(outcome.value, PASS) is leg(given, PASS)
    assert leg(outcome.value, ROUND).curve(20.0)[2] > leg(given, ROUND).curve(20.0)[2] + 0.9
    (warning,) = outcome.diagnostics
    assert warning.code == "R003"
    assert "shot `pass`" in warning.message
    assert warning.labels[0].span.line == 10
    assert warning.notes == (
        "no luck with pass",
        "worst at stage 3",
        "reported by refiner `odd` of package odd-maker",
    )


@pytest.mark.parametrize("optional", [(), (ROUND,)], ids=["none", "another"])
def test_a_shot_that_does_not_accept_it_refuses_the_plan(optional):
    outcome = refine(convex_where_it_failed, *optional)
    assert outcome.value is None
    assert [d.code for d in outcome.diagnostics] == ["R012"]


def test_a_refiner_without_any_path_needs_the_leave_of_every_shot():
    outcome = refine(lambda ir: Outcome(None, (own(ir, PASS),)), PASS)
    assert outcome.value is None
    assert [d.code for d in outcome.diagnostics] == ["R012"]


def test_an_error_that_belongs_to_no_shot_needs_the_leave_of_every_shot():
    act = lambda ir: Outcome(ir, (Diagnostic("R012", "no luck at all"),))  # noqa: E731
    assert refine(act, PASS).value is None
    kept = refine(act, PASS, ROUND)
    assert kept.value is path(PASS, ROUND)
    assert [d.code for d in kept.diagnostics] == ["R003", "R003"]


@pytest.mark.parametrize("spoilt", [nan, lambda ir: bumped(ir, PASS, along(2, 1.0))], ids=["nan", "missed"])
def test_a_spoilt_shot_gets_its_convex_path_and_the_others_stay_refined(spoilt):
    """The ends of a spoilt shot may be anywhere: the ways to it are led anew."""
    refined = bumped(path(PASS), ROUND, along(2, 1.0))
    outcome = refine(lambda ir: Outcome(spoilt(refined)), PASS)
    assert leg(outcome.value, PASS).curve is leg(path(PASS), PASS).curve
    lifted, flat = leg(outcome.value, ROUND).curve, leg(path(PASS), ROUND).curve
    assert lifted(20.0)[2] > flat(20.0)[2] + 0.9
    outcome.value.check()
    assert [d.code for d in outcome.diagnostics] == ["R003"]


def turned_once_more(ir):
    """Turn the camera of `pass` once round on its way, so that all that follows is a turn farther."""
    curve = leg(ir, PASS).curve
    x = (curve.breaks - curve.start) / (curve.end - curve.start)
    step = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
    value, rate, bend = (
        2 * np.pi * (step.deriv(k) if k else step)(x)[:, None] / (curve.end - curve.start) ** k
        for k in range(3)
    )
    turn = quintic_hermite(curve.breaks, value, rate, bend).ctrl * np.eye(7)[[CAM_YAW, BODY_YAW]].sum(axis=0)
    return with_leg(ir, PASS, curve=Piecewise(curve.breaks, curve.ctrl + turn))


@pytest.mark.timeout(60)
def test_a_convex_path_follows_a_refined_one_a_whole_turn_farther():
    def act(ir):
        bent = (PathDeviation(PASS, 1.0, 3.0, "art"), PathDeviation(ROUND, 2.0, 3.0, "art"))
        return Outcome(replace(nan(turned_once_more(ir), ROUND), stats=(("turns", 1.0),), deviations=bent))

    outcome = refine(act, ROUND)
    assert [d.code for d in outcome.diagnostics] == ["R003"]
    given = leg(path(ROUND), ROUND).curve(5.0)
    assert leg(outcome.value, ROUND).curve(5.0) - given == pytest.approx(
        2 * np.pi * np.eye(7)[[CAM_YAW, BODY_YAW]].sum(axis=0), abs=1e-9
    )
    outcome.value.check()
    assert outcome.value.stats == (("turns", 1.0),)
    assert [d.shot for d in outcome.value.deviations] == [PASS]


def test_a_refiner_that_cannot_be_loaded_says_why():
    fault = Diagnostic("P002", "plugin `ours` cannot be loaded", notes=("of package maker",))
    seat = Seat(Unusable("ours", (fault,)), "maker")
    (error,) = RefinePath(seat).run(path(), PassContext()).diagnostics
    assert error.code == "P002"
    kept = RefinePath(seat).run(path(PASS, ROUND), PassContext())
    assert kept.value is path(PASS, ROUND)
    assert "plugin `ours` cannot be loaded" in kept.diagnostics[0].notes
