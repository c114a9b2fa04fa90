"""compile, emit and verify: with ``checking`` and ``output.write``, the functions behind the command line.

Functions here take bytes and return values. Only ``write`` writes to the disk.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import AbstractContextManager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from shotc import emission, plugins
from shotc.checking import models_of
from shotc.diag.model import Diagnostic
from shotc.diag.plugin_faults import plugin_failed
from shotc.diag.registry import has_errors, stops, without_answered
from shotc.emit.base import Artifact, Emission, Emitter
from shotc.ir.keyframes import KeyframeIR, Lowered
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext, silent
from shotc.ir.source import Autopilot, MissionSource
from shotc.lowering import lower, lower_kept, with_autopilot, with_smoothing
from shotc.passes.resolve.checks.timing import waits_longer
from shotc.passes.resolve.lower.names import AUTO
from shotc.pipeline import (
    ASSIGN,
    BESIDE_SHOW,
    FILM,
    FRONT,
    SHOW,
    VERIFY,
    PassReport,
    PassSettings,
    PipelineRun,
    RouteStep,
    passes_of,
    run,
    run_refined,
)
from shotc.source.file import SourceFile
from shotc.spec.load import LoadedMission, load
from shotc.spec.presets import LARGE_OUTPUTS, MANY_DRONES
from shotc.spec.schema import json_schema as schema_of

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import Claim, VerifiedIR
    from shotc.passes.refine_path import Seat

SOLVERS = ("numpy", "scipy", "clarabel", "matplotlib", "pymap3d", "threadpoolctl")


def _ignore(_mission: MissionIR) -> None:
    pass


class PlanOptions(NamedTuple):
    """The options of a compilation.

    refiner : its name; None means ``plugins.usual_refiner()``
    deadline : seconds that the refiner may take; it then runs in its own process
    headings : method of ``solvers.headings.METHODS`` for a camera without a target; None means its
        ``DEFAULT``
    autopilot : of every drone, replaces that of its model
    smoothing : seconds, of all shots, replaces that of the mission; only for plans that are not saved
    stop_after : the name of the last pass to run; progress : called with each pass's name
    on_mission : called with the mission when it can be planned, before the solvers load
    """

    refiner: str | None = None
    deadline: float | None = None
    autopilot: Autopilot | None = None
    stop_after: str | None = None
    seed: int = 0
    progress: Callable[[str], None] = silent
    on_mission: Callable[[MissionIR], None] = _ignore
    headings: str | None = None
    smoothing: float | None = None


class Compilation(NamedTuple):
    """A compiled mission.

    plan : the verified plan, or None after an error or an early stop
    mission : its name, None if the file has none
    """

    plan: VerifiedIR | None
    reports: tuple[PassReport, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    mission: str | None = None


class Emitted(NamedTuple):
    """Output files of a plan, and notes on what their formats cannot represent."""

    artifacts: tuple[Artifact, ...]
    diagnostics: tuple[Diagnostic, ...]
    notes: tuple[str, ...]


class PlanReport(NamedTuple):
    """The verification of a plan file.

    plan : None if it violates a hard claim, differs from its own certificate, or is no plan
    certificate : every claim as proved now, with the violated ones
    sources : the mission in the plan, which the diagnostics refer to
    """

    plan: VerifiedIR | None
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of a mission, with all installed kinds."""
    return schema_of(models_of(plugins.shot_kinds().plugins))


def compile_source(data: bytes, name: str, folder: Path | None, options: PlanOptions) -> Compilation:
    """Compile one mission into a verified plan.

    options.refiner must be None or one of ``plugins.names("refiners")``
    """
    kinds = plugins.shot_kinds()
    loaded = load(data, name, folder, models_of(kinds.plugins), kinds.unusable)
    sources = {name: loaded.file}
    diagnostics = [*loaded.diagnostics]
    stopped = Compilation(None, (), tuple(diagnostics), sources, loaded.title)
    if loaded.mission is None or has_errors(diagnostics):
        return stopped
    ctx = PassContext(options.seed, options.progress, options.headings)
    missing = _missing_for_choice(loaded.mission)
    if missing:
        return stopped._replace(diagnostics=(*diagnostics, *missing))
    setting = PassSettings(kinds.plugins, plugins.names("emitters"))
    front = run(passes_of((ASSIGN, *FRONT), setting), loaded.mission, ctx, options.stop_after)
    diagnostics += front.diagnostics
    stopped = stopped._replace(reports=front.reports, diagnostics=tuple(diagnostics))
    if front.value is None and not has_errors(diagnostics):
        missing = _missing_libraries("planning", SOLVERS)
        return stopped._replace(diagnostics=(*diagnostics, *missing))
    if front.value is None or not isinstance(front.value, KeyframeIR):
        return stopped
    refusals = _refusals(front.value.mission)
    if refusals or options.stop_after == front.reports[-1].name:
        return stopped._replace(diagnostics=(*diagnostics, *refusals))
    back = _lower(with_smoothing(front.value, options.smoothing), setting, options, ctx)
    diagnostics = [*without_answered(diagnostics, back.diagnostics), *back.diagnostics]
    # A run with ``stop_after`` gives no plan to write, even after the last pass.
    plan = None if options.stop_after or has_errors(diagnostics) else back.value
    return stopped._replace(plan=plan, reports=front.reports + back.reports, diagnostics=tuple(diagnostics))


def _lower(checked: KeyframeIR, setting: PassSettings, options: PlanOptions, ctx: PassContext) -> PipelineRun:
    """Plan a mission after the front passes: displays of fleets, and shots of cameras."""
    keyframes = with_autopilot(checked, options.autopilot)
    mission = checked.mission
    if mission.displays and not mission.shots:
        options.on_mission(mission)
        return _lower_show(keyframes, (*SHOW, VERIFY), setting, options, ctx)
    seat, faults = _seat(options.refiner or plugins.usual_refiner(), checked.mission)
    if seat is None or stops(faults):
        return PipelineRun(None, faults, ())
    options.on_mission(mission)
    seated = setting._replace(seat=seat, deadline=options.deadline)
    if mission.displays:
        return _lower_both(keyframes, seated, options, ctx)
    lowered = run_refined(passes_of((*FILM, VERIFY), seated), keyframes, ctx, seat, options.stop_after)
    return lowered._replace(diagnostics=(*faults, *lowered.diagnostics))


def _lower_both(
    keyframes: KeyframeIR, setting: PassSettings, options: PlanOptions, ctx: PassContext
) -> PipelineRun:
    """Plan the displays of fleets, then the shots of cameras outside their airspace; verify both together."""
    lowered_show = _lower_show(keyframes, SHOW, setting, options, ctx)
    if lowered_show.value is None or options.stop_after == lowered_show.reports[-1].name:
        return lowered_show
    from shotc.show.beside_cameras import beside, too_early

    early = [waits_longer(keyframes.mission, shot, end) for shot, end in too_early(lowered_show.value)]
    if early:
        return lowered_show._replace(value=None, diagnostics=(*lowered_show.diagnostics, *early))
    passes = passes_of(BESIDE_SHOW, setting._replace(show=lowered_show.value))
    filmed = run_refined(passes, beside(lowered_show.value), ctx, setting.seat, options.stop_after)
    diagnostics = (*lowered_show.diagnostics, *filmed.diagnostics)
    return filmed._replace(diagnostics=diagnostics, reports=(*lowered_show.reports, *filmed.reports))


def _lower_show(
    keyframes: KeyframeIR,
    steps: Sequence[RouteStep],
    setting: PassSettings,
    options: PlanOptions,
    ctx: PassContext,
) -> PipelineRun:
    """Plan the displays of fleets with one BLAS thread.

    The operations are many and short: threads would make them several times slower, and would change the
    order of summation between machines.
    """
    from threadpoolctl import threadpool_limits

    passes = passes_of(steps, setting)  # loads the libraries that the limit applies to
    with threadpool_limits(1, "blas"):
        return run(passes, keyframes, ctx, options.stop_after)


def _missing_for_choice(mission: LoadedMission) -> tuple[Diagnostic, ...]:
    """Return a diagnostic if shots leave their drone open and the solver for the choice is not installed."""
    if not any(shot.drone == AUTO for shot in mission.spec.shots):
        return ()
    return _missing_libraries("planning", SOLVERS)


def _seat(name: str, mission: MissionIR) -> tuple[Seat | None, tuple[Diagnostic, ...]]:
    """Return the refiner, or None and the diagnostics.

    If a mission accepts the convex path in all its shots, an unusable refiner is no error.
    """
    from shotc.passes.refine_path import Seat, Unusable

    source = plugins.one("refiners", name)
    if source.plugin is not None:
        return Seat(source.plugin, source.package, source.reference), ()
    if all(shot.refine_optional for shot in mission.shots):
        return Seat(Unusable(name, source.diagnostics), source.package), ()
    return None, source.diagnostics


def emitter_pool(jobs: int | None = None) -> AbstractContextManager[emission.EmitterPool]:
    """Return a context with processes that emit in parallel, this one included; enter it before threads
    start.

    jobs : number of processes; None means that of the cores, up to a few
    ``prepare`` names the emitters early; later ``emit_plan`` uses the processes.
    """
    return emission.emitter_pool(emission.usual_jobs() if jobs is None else jobs, _emitter)


def _emitter(name: str) -> Emitter | None:
    return plugins.discover("emitters").plugins.get(name)


def emit_plan(
    plan: VerifiedIR,
    names: Sequence[str] | None = None,
    pool: emission.EmitterPool | None = None,
    *,
    saved: bool = False,
) -> Emitted:
    """Return the output files of a verified plan, with plan.json unless ``saved``.

    names : emitters to run; None means those of the mission; then an output without its library is omitted
        with a warning (P005) instead of an error (P004)
    pool : the processes to use; the files do not depend on them
    saved : whether the plan was read from a plan.json, which is not written again
    """
    from shotc.emit.plan_json import EMITTER as PLAN_JSON

    known = plugins.discover("emitters")
    emitter_names = dict.fromkeys(plan.trajectory.keyframes.mission.emit if names is None else names)
    artifacts: list[Artifact] = []
    diagnostics = [known.faults[n] for n in emitter_names if n in known.faults]
    notes: list[str] = []
    code = "P005" if names is None else "P004"
    diagnostics += [
        plugins.not_installed(code, f"output `{n}`", [known.lacking[n]])
        for n in emitter_names
        if n in known.lacking
    ]
    emitters = tuple(known.plugins[n] for n in emitter_names if n in known.plugins)
    emitters = emitters if saved else (PLAN_JSON, *emitters)
    for emitter, emitted in zip(emitters, (pool or emission.NO_WORKERS).emit(plan, emitters), strict=True):
        if not isinstance(emitted, Emission):
            diagnostics.append(_not_made(emitter.name, emitted, code))
            continue
        if saved and names is not None and not emitted.artifacts:
            diagnostics.append(_nothing_made(emitter.name, emitted))
            continue
        artifacts.extend(emitted.artifacts)
        diagnostics.extend(emitted.diagnostics)
        notes.extend(emitted.notes)
    if names is None:
        notes += _large(plan, emitter_names)
    return Emitted(tuple(artifacts), tuple(diagnostics), tuple(notes))


def _large(plan: VerifiedIR, emitter_names: Collection[str]) -> Iterator[str]:
    """Yield a note on the outputs that are omitted because the show is large."""
    drones = sum(len(fleet.coef) for fleet in plan.trajectory.fleets)
    left = [name for name in LARGE_OUTPUTS if name not in emitter_names]
    if drones > MANY_DRONES and left:
        yield (
            f"{' and '.join(left)} of {drones} drones would be large: made only where asked for, by "
            f"`--emit {','.join(left)}`"
        )


def _nothing_made(name: str, emitted: Emission) -> Diagnostic:
    """Return the error of an output that was requested by name and has no file for this plan.

    It takes the place of the emitter's own diagnostics, which are its reasons.
    """
    reasons = (*(text for d in emitted.diagnostics for text in (d.message, *d.notes)), *emitted.notes)
    labels = tuple(label for d in emitted.diagnostics for label in d.labels)
    help_ = next((d.help for d in emitted.diagnostics if d.help), "leave it out of `--emit`")
    return Diagnostic("E114", f"output `{name}` has no file for this plan", labels, reasons, help_)


def _not_made(name: str, fault: Exception | str, code: str) -> Diagnostic:
    """Return the diagnostic of a failed emitter; raise the fault if it is our own bug.

    code : of a missing library
    """
    if isinstance(fault, ModuleNotFoundError) and plugins.is_optional(fault):
        return plugins.not_installed(code, f"output `{name}`", [str(fault.name)])
    package = plugins.package_of("emitters", name)
    if isinstance(fault, Exception) and package == plugins.OURS:
        raise fault
    return plugin_failed(f"emitter `{name}`", package, fault)


class MissionFile(NamedTuple):
    """A mission to compare a plan with: its bytes, its name in messages, and the folder of its files."""

    data: bytes
    name: str
    folder: Path | None


def verify_plan(data: bytes, name: str, against: MissionFile | None = None) -> PlanReport:
    """Verify the plan in the bytes of a plan.json; name : path of the file, used in messages.

    Only the files that the plan links to are read besides. They must be unchanged, and are searched in the
    mission's folder as named in the plan, and in the folder of ``name``.
    against : another mission that the plan must fulfil, besides the one in it
    """
    missing = _missing_libraries("reading a plan", ("numpy",))
    if missing:
        return PlanReport(None, (), missing, {})
    from shotc.passes.verify.file import against as differs_from
    from shotc.passes.verify.file import verify_file

    def lowered(source: MissionSource, mission: str) -> Lowered:
        beside = () if against is None or against.folder is None else (against.folder,)
        return lower_kept(source, mission, (Path(mission).parent, Path(name).parent, *beside))

    verdict = verify_file(data, name, PassContext(), lowered)
    sources = {} if verdict.mission is None else {verdict.mission.name: verdict.mission}
    report = PlanReport(verdict.plan, verdict.certificate, verdict.diagnostics, sources)
    if against is None or verdict.written is None:
        return report
    # If the mission leaves the choice of drones open, the plan's choice is valid.
    reviewed = lower(*against, verdict.written.mission.source.chosen)
    differing = differs_from(verdict.written, verdict.lowered, reviewed)
    plan = None if has_errors(differing) else report.plan
    return PlanReport(
        plan, report.certificate, (*report.diagnostics, *differing), {**sources, against.name: reviewed.file}
    )


def _refusals(mission: MissionIR) -> tuple[Diagnostic, ...]:
    """Return what prevents the planning of a checked mission: boxes, features, or missing solvers."""
    meant = [keyframe for shot in mission.shots for keyframe in shot.keyframes if keyframe.unidentified]
    if meant:
        return (
            Diagnostic(
                "N016",
                "it is not known what the box of a keyframe is drawn about",
                labels=tuple(mission.origins.value((*k.path, "box")) for k in meant),
                notes=("the mission checks clean; `shotc identify` finds targets in its scene",),
                help=f"run `shotc identify {mission.origins.file}`, or name the `target` of the keyframe",
            ),
        )
    if mission.deferred:
        first, *others = mission.deferred
        note = tuple(f"neither can {other.feature}" for other in others)
        return (
            Diagnostic(
                "P006",
                f"{first.feature} cannot be planned by this version",
                labels=tuple(mission.origins.key(d.path, d.feature) for d in mission.deferred),
                notes=("the mission checks clean; only planning has to wait for a later version", *note),
                help=first.help,
            ),
        )
    return _missing_libraries("planning", SOLVERS)


def _missing_libraries(what: str, libraries: Sequence[str]) -> tuple[Diagnostic, ...]:
    missing = [library for library in libraries if find_spec(library) is None]
    return (plugins.not_installed("P004", what, missing),) if missing else ()
