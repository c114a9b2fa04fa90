"""``shotc simulate``: fly a mission or a plan in simulation, in many runs, and judge them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, NoReturn

import typer

from shotc import plugins
from shotc.api import PlanOptions, compile_source
from shotc.cli import console
from shotc.cli.console import Progress, known
from shotc.cli.flight_options import outages, true_tracks
from shotc.cli.hands import Workers, at_work, no_cluster
from shotc.cli.inputs import STDIN, read_mission
from shotc.cli.plans import prove
from shotc.cli.refiner import with_missing
from shotc.cli.verify import CertificateFormat
from shotc.diag.model import Diagnostic
from shotc.filenames import file_name
from shotc.output import write
from shotc.parallel import Hands, cores
from shotc.spec.presets import RUN_COUNT

if TYPE_CHECKING:
    from shotc.ir.trajectory import VerifiedIR
    from shotc.simulation.conditions import Conditions
    from shotc.simulation.rehearsal import RehearsalOptions, Rehearsed
    from shotc.simulation.unfinished import Unfinished
    from shotc.source.file import SourceFile

FASTEST_WIND_M_S, FARTHEST_ERROR_M = 100.0, 1000.0
"""Largest wind, m/s, and largest position error, m, that are simulated. No drone meets larger ones."""

Input = Annotated[
    str,
    typer.Argument(metavar="MISSION|PLAN", help="A mission, a plan.json or its folder, or - for a mission."),
]
Loop = Annotated[
    Literal["replay", "track", "replan"] | None,
    typer.Option(
        help="replay: drone and camera do what was planned; track: the camera follows what is seen; "
        "replan: the drone follows, too, and plans its next seconds anew [replay]."
    ),
]
ReplannerName = Annotated[str, typer.Option("--replanner", metavar="NAME", help="What plans anew.")]
Seeds = Annotated[
    int | None,
    typer.Option(
        "--runs",
        "--seeds",
        min=1,
        metavar="N",
        help=f"How many runs, each with a seed of its own [{RUN_COUNT}].",
    ),
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the first run; all others follow from it.")]
WindSpeed = Annotated[
    float | None,
    typer.Option("--wind", min=0.0, max=FASTEST_WIND_M_S, help="Steady wind, m/s [the world's]."),
]
WindFrom = Annotated[
    float | None,
    typer.Option(
        "--from",
        min=-360.0,
        max=360.0,
        help="Bearing from which the wind comes, deg [the world's; drawn if it has none].",
    ),
]
Gusty = Annotated[
    float | None,
    typer.Option(
        "--gusts", min=0.0, max=FASTEST_WIND_M_S, help="Standard deviation of gusts on each axis, m/s [0]."
    ),
]
GpsGrade = Annotated[
    Literal["rtk", "plain"] | None,
    typer.Option("--gps", help="Receivers of drones and targets: rtk (0.02 m) or plain (1.5 m) [rtk]."),
]
VehicleOption = Annotated[
    Literal["lag", "rotorpy"],
    typer.Option("--vehicle", help="What flies: ours, with a lag and drag, or RotorPy's rigid body (slow)."),
]
Bias = Annotated[
    float,
    typer.Option(
        min=-FARTHEST_ERROR_M, max=FARTHEST_ERROR_M, help="Error of all satellite positions to the East, m."
    ),
]
Lost = Annotated[
    list[str] | None,
    typer.Option(
        metavar="[NAME=]FROM:TO",
        help="Seconds without satellite positions, of one drone or target or of all; repeatable.",
    ),
]
Wander = Annotated[
    float | None,
    typer.Option(
        min=0.0,
        max=FARTHEST_ERROR_M,
        help="Standard deviation of the distance of moving targets from their tracks, m [0].",
    ),
]
TruthFiles = Annotated[
    list[str] | None,
    typer.Option("--truth", metavar="TARGET=FILE", help="Where a target really goes: a track as CSV or GPX."),
]
Jobs = Annotated[
    int | None, typer.Option(min=1, metavar="N", help="Processes that fly side by side [the cores].")
]
Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Folder for the files [that of the plan, or out/MISSION]."),
]
FormatOption = Annotated[CertificateFormat, typer.Option("--format", help="How to print the result.")]


def simulate(
    source: Input,
    loop: Loop = None,
    replanner: ReplannerName = plugins.OUR_REFINER,
    seeds: Seeds = None,
    seed: Seed = 1,
    wind: WindSpeed = None,
    from_: WindFrom = None,
    gusts: Gusty = None,
    gps: GpsGrade = None,
    vehicle: VehicleOption = "lag",
    bias: Bias = 0.0,
    lost: Lost = None,
    wander: Wander = None,
    truth: TruthFiles = None,
    jobs: Jobs = None,
    workers: Workers = None,
    output: Output = None,
    format: FormatOption = CertificateFormat.TEXT,
) -> None:
    """Fly a mission in simulation, many times, and judge the runs.

    Drones lag behind their plan, the wind pushes them, receivers and cameras have errors, and subjects may
    leave their track. The report gives what the cameras show (share of frames with the whole target, distance
    from its place on screen), how far drones are from their plan, and how near they come to anything. A
    mission can set pass marks (`rehearse: {gusts: 1 m/s, require: {in_frame: 95 %, of: 99 %}}`): the exit
    status is 1 if too few runs reach them, or if a drone touches something. A simulation proves nothing;
    `plan` and `verify` do.

    The command writes simulate.json (every run), flight.csv (the worst run, instant by instant), simulate.png
    (distributions), simulate.rrd (the worst run beside the plan, for the rerun viewer) and
    MISSION-report.html (the proof and the results of the runs, for authorities). Examples:

        shotc simulate tower.yaml --wind 5 --from 270 --gusts 1
        shotc simulate out/tower --loop track --gps plain --runs 100
    """
    with Progress() as progress:
        proved = _plan(source, output, progress)
        from shotc.simulation.outputs import artifacts
        from shotc.simulation.rehearsal import RehearsalOptions
        from shotc.simulation.truth import Truth

        mission = proved.plan.trajectory.keyframes.mission
        real = Truth(tracks=true_tracks(mission, proved.sources, truth or ()))
        lost_spans = outages(mission, lost or ())
        options = RehearsalOptions(
            loop, seeds, wind, from_, gusts, gps, bias, lost_spans, wander, real, seed, replanner, vehicle
        )
        conditions = _conditions(proved, options, workers)
        rehearsed, unfinished = _flown(proved, options, conditions, workers or jobs or cores(), progress)
        emission = artifacts(rehearsed, proved.plan, progress)
    paths, faults = write(emission.artifacts, proved.folder)
    unfinished.file.forget()
    _report(rehearsed, (*emission.diagnostics, *faults), proved.sources, paths, format)


class _Proved(NamedTuple):
    """A proved plan, the files that its diagnostics point into, and the output folder."""

    plan: VerifiedIR
    sources: dict[str, SourceFile]
    folder: Path


def _plan(source: str, output: Path | None, progress: Callable[[str], None]) -> _Proved:
    """Return the plan to simulate. A mission is planned first, as `shotc plan` does without options.

    If there is no plan, report why and exit.
    """
    place = Path(source)
    if source != STDIN and (place.is_dir() or place.suffix.lower() == ".json"):
        report = prove(place)
        plan, beside = report.plan, place if place.is_dir() else place.parent
        diagnostics, sources = report.diagnostics, report.sources
    else:
        text = read_mission(source)
        compilation = with_missing(
            compile_source(text.data, text.name, text.folder, PlanOptions(progress=progress)), None
        )
        plan, beside = (
            compilation.plan,
            Path("out") / (file_name(compilation.mission) if compilation.mission else ""),
        )
        diagnostics, sources = compilation.diagnostics, compilation.sources
    if plan is None:
        console.report(diagnostics, sources)
        raise typer.Exit(console.EXIT_REJECTED)
    return _Proved(plan, sources, output or beside)


def _conditions(proved: _Proved, options: RehearsalOptions, workers: str | None) -> Conditions:
    """Return the conditions of the runs. If they cannot be flown, report why and exit."""
    from shotc.simulation.rehearsal import conditions_of
    from shotc.simulation.rehearsal_faults import unflyable

    trajectory = proved.plan.trajectory
    conditions = conditions_of(trajectory.keyframes.mission, options)
    faults = (*_unable(conditions, workers), *unflyable(trajectory, conditions))
    if faults:
        console.report(faults, proved.sources)
        raise typer.Exit(console.EXIT_REJECTED)
    return conditions


def _unable(conditions: Conditions, workers: str | None) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a vehicle, replanner or cluster that cannot be used."""
    if faults := no_cluster(workers):
        return faults
    if conditions.vehicle == "rotorpy" and find_spec("rotorpy") is None:
        return (plugins.not_installed("P004", "`--vehicle rotorpy`", ["rotorpy"]),)
    if conditions.loop != "replan":
        return ()
    known("--replanner", conditions.replanner, plugins.names("replanners"))
    return plugins.one("replanners", conditions.replanner).diagnostics


def _flown(
    proved: _Proved,
    options: RehearsalOptions,
    conditions: Conditions,
    processes: Hands,
    progress: Callable[[str], None],
) -> tuple[Rehearsed, Unfinished]:
    """Fly all runs, without those that an interrupted command has flown, and return them with its record."""
    from shotc.simulation.rehearsal import rehearse, runs_of
    from shotc.simulation.runs import simulated
    from shotc.simulation.unfinished import Unfinished

    trajectory = proved.plan.trajectory
    count = runs_of(trajectory, conditions, options)
    progress(f"flying {count} run{'s' if count > 1 else ''}")
    unfinished = Unfinished.of(proved.folder, trajectory, conditions)
    earlier = unfinished.done()
    blocks = unfinished.keeping(simulated(trajectory, conditions, count, processes, earlier), earlier)
    with at_work():
        rehearsed = rehearse(trajectory, conditions, blocks, lambda n: progress(f"{n} of {count} runs"))
    return rehearsed, unfinished


def _report(
    rehearsed: Rehearsed,
    of_files: Sequence[Diagnostic],
    sources: dict[str, SourceFile],
    paths: Sequence[Path],
    format: CertificateFormat,
) -> NoReturn:
    """Print the results of all runs and their diagnostics, and exit."""
    from shotc.cli.rehearsed import text
    from shotc.simulation.deviation_faults import deviations
    from shotc.simulation.document import json_text
    from shotc.simulation.rehearsal_faults import not_kept

    diagnostics = (*not_kept(rehearsed), *deviations(rehearsed), *of_files)
    console.report(diagnostics, sources)
    console.out(json_text(rehearsed) if format is CertificateFormat.JSON else text(rehearsed, paths))
    raise typer.Exit(console.exit_code(diagnostics))
