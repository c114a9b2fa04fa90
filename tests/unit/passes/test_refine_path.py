from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Piecewise
from shotc.passes.base import Outcome, PassContext
from shotc.passes.refine_path import REFINER, RefinePath
from tests.records import replace

TEMPLATE = Path(__file__).parents[3] / "shotc" / "templates" / "orbit.yaml"


class Odd:
    """A refiner that does what it is told."""

    name, summary, api = "odd", "odd", 1

    def __init__(self, act):
        self.refine = lambda path, ctx: act(path)


@cache
def path(optional: bool = False):
    text = TEMPLATE.read_text()
    if optional:
        text = text.replace(
            "    composition: center", "    composition: center\n    refine: {optional: true}"
        )
    done = compile_source(text.encode(), "orbit.yaml", None, PlanOptions(stop_after="solve-path-qp"))
    return done.reports[-1].output


def refine(act, optional=False):
    return RefinePath(Odd(act)).run(path(optional), PassContext())


def with_first_leg(ir, **changes):
    first, *others = ir.drones[0].legs
    return replace(ir, drones=(replace(ir.drones[0], legs=(replace(first, **changes), *others)),))


def raise_(_):
    raise RuntimeError("no luck")


def nan(ir):
    return Outcome(with_first_leg(ir, pose=(float("nan"),) * 7))


def loose(ir):
    """Lift one leg off the ground, so that the next does not begin where it ends."""
    curve = ir.drones[0].legs[0].curve
    return Outcome(with_first_leg(ir, curve=Piecewise(curve.breaks, curve.ctrl + np.eye(7)[2])))


def test_none_gives_the_path_back():
    assert REFINER.refine(path(), PassContext()).value is path()


@pytest.mark.parametrize(
    ("act", "code", "words"),
    [
        (raise_, "R001", "RuntimeError: no luck"),
        (lambda ir: None, "R002", "NoneType"),
        (lambda ir: Outcome("a path"), "R002", "str, not PathIR"),
        (lambda ir: Outcome(replace(ir, drones=())), "R002", "legs"),
        (nan, "R002", ""),
        (loose, "R002", "does not start where the last leg ended"),
    ],
    ids=["raises", "nothing", "not a path", "other legs", "nan", "loose legs"],
)
def test_what_a_refiner_does_wrong_is_an_error_that_names_it(act, code, words):
    outcome = refine(act)
    assert outcome.value is None
    (fault,) = outcome.diagnostics
    assert fault.code == code
    assert "`odd`" in fault.message
    assert words in " ".join(fault.notes)


@pytest.mark.parametrize("act", [raise_, nan, loose])
def test_where_every_shot_accepts_it_the_convex_path_is_kept_with_a_warning(act):
    outcome = refine(act, optional=True)
    assert outcome.value is path(True)
    assert [d.code for d in outcome.diagnostics] == ["R003"]
    assert not has_errors(outcome.diagnostics)


def test_a_refiner_s_own_errors_are_passed_on():
    own = Diagnostic("R001", "the tower is in the way")
    outcome = refine(lambda ir: Outcome(None, (own,)))
    assert outcome.value is None
    assert outcome.diagnostics == (own,)
