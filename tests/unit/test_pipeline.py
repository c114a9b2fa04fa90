from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar, get_args, get_type_hints

import pytest

from shotc import plugins
from shotc.diag.model import Diagnostic
from shotc.passes.base import Outcome, PassContext
from shotc.passes.refine_path import Seat
from shotc.pipeline import (
    CAMERA_NAMES,
    SHOW_NAMES,
    AnyPass,
    default_passes,
    front_passes,
    run,
    show_passes,
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


def mismatches(passes: Sequence[AnyPass]) -> list[str]:
    """Name every joint of a pipeline at which one pass's output type is not the next one's input."""
    found = []
    for first, second in pairwise(passes):
        (given,) = get_args(get_type_hints(first.run)["return"])
        wanted = get_type_hints(second.run)["ir"]
        if given is not wanted:
            found.append(f"{first.name} gives {given.__name__}, {second.name} takes {wanted.__name__}")
    return found


def test_the_default_passes_fit_together_and_bear_their_names():
    passes = default_passes(plugins.discover("kinds").plugins, Seat())
    assert mismatches(passes) == []
    assert tuple(p.name for p in passes) == CAMERA_NAMES


def test_the_passes_of_a_show_fit_together_and_bear_their_names():
    passes = (*front_passes(plugins.discover("kinds").plugins), *show_passes())
    assert mismatches(passes) == []
    assert tuple(p.name for p in passes) == SHOW_NAMES


def test_a_joint_that_does_not_fit_is_named():
    assert mismatches([Spell(), Add(1)]) == ["spell gives str, add takes Number"]


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
