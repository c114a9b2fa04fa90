"""The compiler in one screen: the default passes, and the loop that runs them.

LoadedMission --resolve--> MissionIR --place-keyframes--> KeyframeIR --solve-path-qp--> PathIR
--refine-path--> PathIR --parameterize-time--> TrajectoryIR --verify--> VerifiedIR

and, for what fleets display,

KeyframeIR --place-goals--> GoalIR --assign-goals--> ShowIR --bound-splines--> ShowIR
--keep-apart--> TrajectoryIR --verify--> VerifiedIR
"""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors, stops
from shotc.passes.base import PassContext
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.resolve import Resolve

if TYPE_CHECKING:
    from shotc.passes.base import Pass

    AnyPass = Pass[Any, Any]
else:
    AnyPass = Any


class PassReport(NamedTuple):
    """What one pass did: its name, its output (None where it failed), wall seconds, and what it said."""

    name: str
    output: Any
    seconds: float
    diagnostics: tuple[Diagnostic, ...] = ()


class Run(NamedTuple):
    """A finished run: the last IR that was reached, or None after an error, and all reports."""

    value: Any
    diagnostics: tuple[Diagnostic, ...]
    reports: tuple[PassReport, ...]


def front_passes(kinds: Any, emitters: Any = None) -> tuple[AnyPass, ...]:
    """Return the passes that need no solver: what ``check`` runs; emitters are the known names, if known."""
    return (Resolve(kinds, emitters), PlaceKeyframes())


def default_passes(kinds: Any, seat: Any, deadline: float | None = None) -> tuple[AnyPass, ...]:
    """Return the whole compiler.

    seat : the refiner and where it comes from (``refine_path.Seat``); deadline : seconds that it may take
    """
    from shotc.passes.parameterize_time import ParameterizeTime
    from shotc.passes.refine_path import RefinePath
    from shotc.passes.solve_path_qp import SolvePathQp
    from shotc.passes.verify import Verify

    refine = RefinePath(seat, deadline)
    return (*front_passes(kinds), SolvePathQp(), refine, ParameterizeTime(), Verify())


def show_passes() -> tuple[AnyPass, ...]:
    """Return what follows the front passes in a mission with displays."""
    from shotc.passes.assign_goals import AssignGoals
    from shotc.passes.bound_splines import BoundSplines
    from shotc.passes.keep_apart import KeepApart
    from shotc.passes.place_goals import PlaceGoals
    from shotc.passes.verify import Verify

    return (PlaceGoals(), AssignGoals(), BoundSplines(), KeepApart(), Verify())


FRONT_NAMES = ("resolve", "place-keyframes")
CAMERA_NAMES = (*FRONT_NAMES, "solve-path-qp", "refine-path", "parameterize-time", "verify")
SHOW_NAMES = (*FRONT_NAMES, "place-goals", "assign-goals", "bound-splines", "keep-apart", "verify")
PASS_NAMES = tuple(dict.fromkeys((*CAMERA_NAMES[:-1], *SHOW_NAMES)))


def run(
    passes: Iterable[AnyPass],
    value: Any,
    ctx: PassContext,
    stop_after: str | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> Run:
    """Run passes in turn until one fails or ``stop_after`` is done.

    An error that knows a bound only does not stop the run: a later pass has the exact number.
    After each pass the IR's own ``check()`` runs, where it has one: a ValueError from it is a bug.
    """
    diagnostics: list[Diagnostic] = []
    reports: list[PassReport] = []
    for step in passes:
        ctx.progress(step.name)
        began = clock()
        outcome = step.run(value, ctx)
        diagnostics.extend(outcome.diagnostics)
        failed = outcome.value is None or stops(outcome.diagnostics)
        value = None if failed else outcome.value
        reports.append(PassReport(step.name, outcome.value, clock() - began, outcome.diagnostics))
        if failed:
            break
        if hasattr(value, "check"):
            value.check()
        if step.name == stop_after:
            break
    return Run(value, tuple(diagnostics), tuple(reports))


def run_refined(
    passes: Sequence[AnyPass], value: Any, ctx: PassContext, seat: Any, stop_after: str | None = None
) -> Run:
    """Run passes, and where a refined path is refused that could be flown unrefined, blame its refiner.

    seat : as in ``default_passes``. Where the mission allows it, the unrefined path is flown instead. Where
    the refiner gives no path, the later passes judge the unrefined one, and its errors say what came of it.
    Where a refined shot does not fit into the time of its unrefined path, all is planned again with more.
    """
    from shotc.passes.refine_path import blame, needed, shortest_refined, still_true
    from shotc.passes.solve_path_qp import SolvePathQp

    done = run(passes, value, ctx, stop_after)
    k = next((i for i, report in enumerate(done.reports) if report.name == "refine-path"), 0)
    outputs: list[Any] = [report.output for report in done.reports]
    if not k:
        return done
    if outputs[k] is None:
        return _with_convex(done, passes[k + 1 :], outputs[k - 1], ctx)
    convex, refined = outputs[k - 1], outputs[k]
    longer, solve = needed(refined), passes[k - 1]
    if longer and isinstance(solve, SolvePathQp) and not solve.durations:
        slower = (*passes[: k - 1], replace(solve, durations=longer), *passes[k:])
        again = run_refined(slower, value, ctx, seat, stop_after)
        if not has_errors(again.diagnostics):
            return again
    late = tuple(d for report in done.reports[k + 1 :] for d in report.diagnostics)
    if not has_errors(late):
        true = done._replace(diagnostics=still_true((convex, refined), done.diagnostics))
        return _accounted(true, seat, (convex, refined))
    if refined is convex:
        return done
    again = run(passes[k + 1 :], convex, ctx, stop_after)
    if has_errors(again.diagnostics):
        return done._replace(diagnostics=shortest_refined(seat, done.diagnostics, again.diagnostics))
    verdict = blame(seat, (convex, refined), tuple(d for d in late if has_errors([d])))
    early = tuple(d for report in done.reports[: k + 1] for d in report.diagnostics)
    if not verdict.convex:
        return Run(None, (*early, *verdict.diagnostics), done.reports)
    said = (*early, *verdict.diagnostics, *again.diagnostics)
    flown = Run(again.value, said, (*done.reports[: k + 1], *again.reports))
    return _accounted(flown, seat, (convex, convex))


def _with_convex(done: Run, later: Sequence[AnyPass], convex: Any, ctx: PassContext) -> Run:
    """Return a run that ends at the refiner, whose errors say what becomes of the convex path."""
    from shotc.passes.refine_path import with_convex

    judged = run(later, convex, ctx)
    return done._replace(diagnostics=with_convex(convex, done.diagnostics, judged.diagnostics))


def _accounted(done: Run, seat: Any, paths: tuple[Any, Any]) -> Run:
    """Return a run that tells of every shot whether it is refined; paths : as in ``account``."""
    from shotc.passes.refine_path import account

    told = account(seat, paths, done.diagnostics)
    return done._replace(value=told.noted_in(done.value), diagnostics=(*done.diagnostics, *told.warnings))
