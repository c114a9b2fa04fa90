"""The compiler on one page: its routes, and the loop that runs their passes."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from importlib import import_module
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors, stops
from shotc.ir.passes import PassContext

if TYPE_CHECKING:
    from shotc.ir.passes import Pass

    AnyPass = Pass[Any, Any]
else:
    AnyPass = Any


class PassReport(NamedTuple):
    """The record of one pass: name, output (None if it failed), wall time in seconds, diagnostics."""

    name: str
    output: Any
    seconds: float
    diagnostics: tuple[Diagnostic, ...] = ()


class PipelineRun(NamedTuple):
    """A finished run: the last IR, or None after an error, and all reports."""

    value: Any
    diagnostics: tuple[Diagnostic, ...]
    reports: tuple[PassReport, ...]


class RouteStep(NamedTuple):
    """One pass of a route, described before its module loads.

    name : in commands; takes, gives : the IRs that it lowers from and to
    home : module:class; options : the fields of ``PassSettings`` that its constructor takes
    """

    name: str
    takes: str
    gives: str
    home: str
    options: tuple[str, ...] = ()


class PassSettings(NamedTuple):
    """The arguments of passes' constructors.

    kinds : the shot kinds by name; emitters : the names of all, None if unknown
    seat : the refiner and its origin (``refine_path.Seat``); deadline : seconds that it may take
    show : the flights of fleets that cameras are planned beside (TrajectoryIR)
    """

    kinds: Any
    emitters: Any = None
    seat: Any = None
    deadline: float | None = None
    show: Any = None


ASSIGN = RouteStep(
    "assign-drones", "LoadedMission", "LoadedMission", "shotc.passes.assign_drones:AssignDrones", ("kinds",)
)
FRONT = (
    RouteStep("resolve", "LoadedMission", "MissionIR", "shotc.passes.resolve:Resolve", ("kinds", "emitters")),
    RouteStep("place-keyframes", "MissionIR", "KeyframeIR", "shotc.passes.place_keyframes:PlaceKeyframes"),
)
"""The passes without a solver; ``check`` runs them."""

VERIFY = RouteStep("verify", "TrajectoryIR", "VerifiedIR", "shotc.passes.verify:Verify")
FILM = (
    RouteStep("solve-path-qp", "KeyframeIR", "PathIR", "shotc.passes.solve_path_qp:SolvePathQp"),
    RouteStep("refine-path", "PathIR", "PathIR", "shotc.passes.refine_path:RefinePath", ("seat", "deadline")),
    RouteStep(
        "parameterize-time", "PathIR", "TrajectoryIR", "shotc.passes.parameterize_time:ParameterizeTime"
    ),
)
SHOW = (
    RouteStep("place-goals", "KeyframeIR", "GoalIR", "shotc.show.goals:PlaceGoals"),
    RouteStep("assign-goals", "GoalIR", "ShowIR", "shotc.show.assignment:AssignGoals"),
    RouteStep("bound-splines", "ShowIR", "ShowIR", "shotc.show.splines:BoundSplines"),
    RouteStep("keep-apart", "ShowIR", "TrajectoryIR", "shotc.show.separation:KeepApart"),
)
JOIN = RouteStep(
    "join-flights", "TrajectoryIR", "TrajectoryIR", "shotc.show.beside_cameras:JoinFlights", ("show",)
)
ROUTES = {
    "film": (ASSIGN, *FRONT, *FILM, VERIFY),
    "show": (ASSIGN, *FRONT, *SHOW, VERIFY),
}
"""The passes from a mission to a verified plan: for films of cameras, and for displays of fleets."""

BESIDE_SHOW = (*FILM, JOIN, VERIFY)
"""The passes after those of a show that cameras also film; one verification covers both."""

PASS_NAMES = tuple(step.name for step in (ASSIGN, *FRONT, *FILM, *SHOW, JOIN, VERIFY))


def passes_of(steps: Sequence[RouteStep], setting: PassSettings) -> tuple[AnyPass, ...]:
    """Return the passes of a part of a route.

    Raises ValueError if one does not take what the last one gives.
    """
    for last, step in pairwise(steps):
        if last.gives != step.takes:
            raise ValueError(f"{last.name} gives {last.gives}, {step.name} takes {step.takes}")
    return tuple(_pass_of(step, setting) for step in steps)


def _pass_of(step: RouteStep, setting: PassSettings) -> AnyPass:
    module, _, name = step.home.partition(":")
    single_pass: AnyPass = getattr(import_module(module), name)(*(getattr(setting, o) for o in step.options))
    return single_pass


def run(
    passes: Iterable[AnyPass],
    value: Any,
    ctx: PassContext,
    stop_after: str | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> PipelineRun:
    """Run passes in order until one fails or ``stop_after`` is done.

    An error that is only a bound does not stop the run, because a later pass has the exact number. After each
    pass the IR's ``check()`` runs, if it has one; a ValueError from it is a bug.
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
    return PipelineRun(value, tuple(diagnostics), tuple(reports))


def run_refined(
    passes: Sequence[AnyPass], value: Any, ctx: PassContext, seat: Any, stop_after: str | None = None
) -> PipelineRun:
    """Run passes with a refiner; if only the refined path is refused, report its refiner.

    seat : as in ``PassSettings``. If the mission allows it, the convex path then replaces the refined one. If
    the refiner gives no path, the later passes judge the convex one, and the errors state the result. If a
    refined shot does not fit the duration of its convex path, the run is repeated with a longer one.
    """
    from shotc.passes.refine_path import blame, needed, shortest_refined, valid_on_refined
    from shotc.passes.solve_path_qp import SolvePathQp

    lowered = run(passes, value, ctx, stop_after)
    k = next((i for i, report in enumerate(lowered.reports) if report.name == "refine-path"), 0)
    outputs: list[Any] = [report.output for report in lowered.reports]
    if not k:
        return lowered
    if outputs[k] is None:
        return _with_convex(lowered, passes[k + 1 :], outputs[k - 1], ctx)
    convex, refined = outputs[k - 1], outputs[k]
    longer, solve = needed(refined), passes[k - 1]
    if longer and isinstance(solve, SolvePathQp) and not solve.durations:
        slower = (*passes[: k - 1], replace(solve, durations=longer), *passes[k:])
        again = run_refined(slower, value, ctx, seat, stop_after)
        if not has_errors(again.diagnostics):
            return again
    late = tuple(d for report in lowered.reports[k + 1 :] for d in report.diagnostics)
    if not has_errors(late):
        true = lowered._replace(diagnostics=valid_on_refined((convex, refined), lowered.diagnostics))
        return _accounted(true, seat, (convex, refined))
    if refined is convex:
        return lowered
    again = run(passes[k + 1 :], convex, ctx, stop_after)
    if has_errors(again.diagnostics):
        return lowered._replace(diagnostics=shortest_refined(seat, lowered.diagnostics, again.diagnostics))
    verdict = blame(seat, (convex, refined), tuple(d for d in late if has_errors([d])))
    early = tuple(d for report in lowered.reports[: k + 1] for d in report.diagnostics)
    if not verdict.convex:
        return PipelineRun(None, (*early, *verdict.diagnostics), lowered.reports)
    diagnostics = (*early, *verdict.diagnostics, *again.diagnostics)
    flown = PipelineRun(again.value, diagnostics, (*lowered.reports[: k + 1], *again.reports))
    return _accounted(flown, seat, (convex, convex))


def _with_convex(
    refused: PipelineRun, later: Sequence[AnyPass], convex: Any, ctx: PassContext
) -> PipelineRun:
    """Return a run that ends at the refiner, with errors that state the result of the convex path."""
    from shotc.passes.refine_path import with_convex

    judged = run(later, convex, ctx)
    return refused._replace(diagnostics=with_convex(convex, refused.diagnostics, judged.diagnostics))


def _accounted(done: PipelineRun, seat: Any, paths: tuple[Any, Any]) -> PipelineRun:
    """Return a run that reports for every shot whether it is refined; paths : as in ``account``."""
    from shotc.passes.refine_path import account

    noted = account(seat, paths, done.diagnostics)
    return done._replace(value=noted.noted_in(done.value), diagnostics=(*done.diagnostics, *noted.warnings))
