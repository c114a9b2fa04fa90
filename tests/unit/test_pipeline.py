from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, get_args, get_type_hints

import pytest

from shotc import plugins
from shotc.diag.model import Diagnostic
from shotc.ir.passes import Outcome, PassContext
from shotc.passes.refine_path import Seat
from shotc.pipeline import (
    BESIDE_SHOW,
    FRONT,
    PASS_NAMES,
    ROUTES,
    VERIFY,
    PassSettings,
    RouteStep,
    passes_of,
    run,
)


@dataclass(frozen=True)
class Number:
    """An IR that is valid while it is not negative."""

    value: int

    def check(self) -> None:
        if self.value < 0:
            raise ValueError("negative")


@dataclass(frozen=True)
class Add:
    """A pass that adds, and says what it is told to."""

    by: int
    diagnostics: tuple[Diagnostic, ...] = ()
    name: ClassVar[str] = "add"

    def run(self, ir: Number, ctx: PassContext) -> Outcome[Number]:
        ctx.progress(f"adding {self.by}")
        return Outcome(Number(ir.value + self.by), self.diagnostics)


@dataclass(frozen=True)
class Spell:
    name: ClassVar[str] = "spell"

    def run(self, ir: Number, ctx: PassContext) -> Outcome[str]:
        return Outcome(str(ir.value))


@pytest.mark.parametrize("steps", [*ROUTES.values(), BESIDE_SHOW], ids=[*ROUTES, "film beside a show"])
def test_the_passes_of_a_route_are_what_it_says_of_them(steps: Sequence[RouteStep]) -> None:
    passes = passes_of(steps, PassSettings(plugins.discover("kinds").plugins, (), Seat()))
    for step, made in zip(steps, passes, strict=True):
        hints = get_type_hints(made.run)
        (given,) = get_args(hints["return"])
        assert (made.name, hints["ir"].__name__, given.__name__) == (step.name, step.takes, step.gives)


@pytest.mark.parametrize("route", ROUTES)
def test_a_route_leads_from_a_mission_to_a_verified_plan(route: str) -> None:
    steps = ROUTES[route]
    assert (steps[0].takes, steps[-1].gives) == ("LoadedMission", "VerifiedIR")
    assert {step.name for step in steps} <= set(PASS_NAMES)


def test_passes_that_do_not_fit_together_are_not_made() -> None:
    with pytest.raises(ValueError, match="resolve gives MissionIR, verify takes TrajectoryIR"):
        passes_of((FRONT[0], VERIFY), PassSettings({}))


def test_passes_run_in_turn_and_are_timed():
    ticks = iter(range(100))
    done = run([Add(1), Add(2), Spell()], Number(0), PassContext(), clock=lambda: float(next(ticks)))
    assert done.value == "3"
    assert [(r.name, r.seconds) for r in done.reports] == [("add", 1.0), ("add", 1.0), ("spell", 1.0)]


def test_an_error_stops_the_run_and_a_warning_does_not():
    warning, error = Diagnostic("P005", "left out"), Diagnostic("P004", "not installed")
    done = run([Add(1, (warning,)), Add(2, (error,)), Add(4)], Number(0), PassContext())
    assert done.value is None
    assert done.diagnostics == (warning, error)
    assert len(done.reports) == 2


def test_stop_after_gives_the_ir_of_that_pass():
    done = run([Add(1), Spell(), Spell()], Number(0), PassContext(), stop_after="spell")
    assert done.value == "1"
    assert len(done.reports) == 2


def test_an_ir_that_breaks_its_own_invariant_is_a_bug():
    with pytest.raises(ValueError, match="negative"):
        run([Add(-1), Spell()], Number(0), PassContext())


def test_progress_hears_of_every_pass():
    heard: list[str] = []
    run([Add(1), Spell()], Number(0), PassContext(progress=heard.append))
    assert heard == ["add", "adding 1", "spell"]
