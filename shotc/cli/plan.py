"""``shotc plan``: compile a mission into a verified plan and write its files."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from shotc import plugins
from shotc.api import Compilation, PlanOptions, compile_source, emit_plan, emitter_pool
from shotc.cli import console
from shotc.cli.console import Progress, known, listed
from shotc.cli.earlier_outputs import print_left_over, warn_of_earlier
from shotc.cli.hands import Workers
from shotc.cli.inputs import gather, is_folder, read_mission
from shotc.cli.plan_many import one_mission_only, plan_many
from shotc.cli.refiner import with_missing
from shotc.filenames import file_name
from shotc.ir.text import dump
from shotc.output import write
from shotc.pipeline import PASS_NAMES
from shotc.solvers.headings import DEFAULT, METHODS

if TYPE_CHECKING:
    from shotc.emission import EmitterPool
    from shotc.ir.mission import MissionIR


def _positive(seconds: float | None) -> float | None:
    """Return a time that is positive and finite; raise a usage error for any other."""
    if seconds is not None and not 0 < seconds < inf:
        raise typer.BadParameter(f"{seconds:g} is no time that a refiner can be given")
    return seconds


_PASSES = f"Passes: {', '.join(PASS_NAMES)}."
Specs = Annotated[
    list[str],
    typer.Argument(
        metavar="SPEC",
        help="The mission file, or - for standard input; several files, or folders.",
    ),
]
Output = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        help="Folder for the files [out/MISSION]; of several, for their folders [out].",
    ),
]
Emit = Annotated[str | None, typer.Option(help="Emitters to run, separated by commas.", metavar="LIST")]
RefinerName = Annotated[
    str | None,
    typer.Option(
        "--refiner",
        metavar="NAME",
        help="Which refiner improves the path [ours where it is installed, else none].",
    ),
]
Deadline = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        help="Stop the refiner after this time, loading included.",
        callback=_positive,
    ),
]
HeadingMethod = Annotated[
    str,
    typer.Option(
        "--headings",
        metavar="METHOD",
        help="How the turns of a camera that follows nothing are chosen; see `shotc list headings`.",
    ),
]
Autopilot = Annotated[
    Literal["px4", "ardupilot", "dji-fly", "pilot-2", "litchi"] | None,
    typer.Option(help="Write for this autopilot or app, whatever the drone's model says."),
]
StopAfter = Annotated[
    str | None,
    typer.Option(help=f"Stop after this pass; nothing is written. {_PASSES}", metavar="PASS"),
]
DumpIr = Annotated[
    str | None, typer.Option(help=f"Print what this pass gives, as text. {_PASSES}", metavar="PASS")
]
TimePasses = Annotated[bool, typer.Option("--time-passes", help="Print how long each pass took.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        min=1,
        metavar="N",
        help="Processes that make the files side by side [the cores, up to 4], or plan several missions [the "
        "cores]; the files stay the same.",
    ),
]
Seed = Annotated[int, typer.Option(help="Seed for refiners that use chance.")]


def plan(
    specs: Specs,
    output: Output = None,
    emit: Emit = None,
    refiner: RefinerName = None,
    deadline: Deadline = None,
    headings: HeadingMethod = DEFAULT,
    autopilot: Autopilot = None,
    stop_after: StopAfter = None,
    dump_ir: DumpIr = None,
    time_passes: TimePasses = False,
    jobs: Jobs = None,
    workers: Workers = None,
    seed: Seed = 0,
) -> None:
    """Compile a mission: validate it, plan it, prove the plan, write its files.

    Nothing is written unless every hard constraint is proved. Example:

        shotc plan tower.yaml -o out/tower --emit csv,mavlink

    Missions of a folder are planned side by side, each into a folder of its own, with a table at the end.
    The same command continues after an interruption. Example:

        shotc plan missions/ --jobs 8
    """
    emitters = listed(emit)
    _check_names(emitters, {"--stop-after": stop_after, "--dump-ir": dump_ir}, refiner, headings)
    if len(specs) > 1 or is_folder(specs[0]):
        single = {"--stop-after": stop_after, "--dump-ir": dump_ir, "--time-passes": time_passes}
        one_mission_only(single)
        options = PlanOptions(refiner, deadline, autopilot, seed=seed, headings=headings)
        raise typer.Exit(plan_many(gather(specs), options, emitters, output, workers or jobs))
    if workers is not None:
        raise typer.BadParameter("it is for several missions, not for one", param_hint="--workers")
    source = read_mission(specs[0])
    stop = stop_after or dump_ir
    with emitter_pool(1 if stop else jobs) as hands, Progress() as progress:

        def start(mission: MissionIR) -> None:
            hands.prepare(mission.emit if emitters is None else emitters)

        options = PlanOptions(refiner, deadline, autopilot, stop, seed, progress, start, headings)
        compilation = with_missing(compile_source(source.data, source.name, source.folder, options), refiner)
        if dump_ir is not None:
            _dump(compilation, dump_ir)
        if options.stop_after is None:
            progress("emit")
            code = _finish(compilation, emitters, output, hands, progress)
        else:
            console.report(compilation.diagnostics, compilation.sources)
            code = console.exit_code(compilation.diagnostics)
    if time_passes:
        _print_times(compilation)
    raise typer.Exit(code)


def _check_names(
    emitters: list[str] | None, passes: dict[str, str | None], refiner: str | None, headings: str
) -> None:
    """Raise a usage error for an unknown emitter, refiner, method of headings or pass; passes : by option."""
    for name in emitters or ():
        known("--emit", name, plugins.names("emitters"))
    known("--refiner", refiner, plugins.names("refiners"))
    known("--headings", headings, list(METHODS))
    for option, stage in passes.items():
        known(option, stage, list(PASS_NAMES))


def _finish(
    compilation: Compilation,
    emitters: list[str] | None,
    output: Path | None,
    hands: EmitterPool,
    progress: Callable[[str], None],
) -> int:
    """Emit and write a plan, report all diagnostics, and return the exit status."""
    folder = output or Path("out") / (file_name(compilation.mission) if compilation.mission else "")
    if compilation.plan is None:
        console.report(compilation.diagnostics, compilation.sources)
        warn_of_earlier(folder)
        return console.exit_code(compilation.diagnostics)
    from shotc.cli.summary import summary

    emitted = emit_plan(compilation.plan, emitters, hands)
    diagnostics = (*compilation.diagnostics, *emitted.diagnostics)
    paths, faults = write(emitted.artifacts, folder, progress)
    diagnostics += faults
    console.report(diagnostics, compilation.sources)
    if paths:
        console.out(summary(compilation.plan, paths, emitted.notes))
        print_left_over(folder, {path.name for path in paths})
    else:
        warn_of_earlier(folder)
    return console.exit_code(diagnostics)


def _dump(compilation: Compilation, name: str) -> None:
    for report in compilation.reports:
        if report.name == name and report.output is not None:
            console.out(dump(report.output))


def _print_times(compilation: Compilation) -> None:
    for report in compilation.reports:
        console.note(f"{report.seconds:8.3f} s  {report.name}")
