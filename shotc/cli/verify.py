"""``shotc verify``: prove a plan again from its file alone, or a flight that any tool may have written."""

from __future__ import annotations

import json
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from shotc.api import MissionFile, PlanReport
from shotc.cli import console
from shotc.cli.inputs import read_mission
from shotc.cli.plans import bytes_of, prove
from shotc.diag.render.json import render
from shotc.importers.flights.endings import SUFFIXES, is_flight, largest
from shotc.units import QuantityError, parse_quantity

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.collective import Return
    from shotc.flightfiles.verify import FlightsReport
    from shotc.ir.trajectory import VerifiedIR


class CertificateFormat(StrEnum):
    """How the certificate is printed."""

    TEXT = "text"
    JSON = "json"


FilesArgument = Annotated[
    list[Path],
    typer.Argument(metavar="FILE", help="A plan.json or its folder; or files of flights."),
]
FormatOption = Annotated[CertificateFormat, typer.Option("--format", help="How to print the certificate.")]
AgainstOption = Annotated[
    str | None,
    typer.Option("--against", metavar="MISSION", help="Hold the plan, or the flights, to this mission file."),
]
DroneOption = Annotated[
    list[str] | None,
    typer.Option(
        "--drone", metavar="NAME", help="Whose flight a file is; once for every file, in their order."
    ),
]
AbortOption = Annotated[
    str | None,
    typer.Option(
        "--abort-every",
        metavar="TIME",
        help="Of a show: prove a collective return from every multiple of a time, such as 1s.",
    ),
]

LEAST_ABORT_S = 0.1
"""Shortest time between two collective returns, seconds. A show of ten minutes then has 6000 of them."""


def verify(
    files: FilesArgument,
    format: FormatOption = CertificateFormat.TEXT,
    against: AgainstOption = None,
    drone: DroneOption = None,
    abort_every: AbortOption = None,
) -> None:
    """Prove a plan again, or prove a flight that any tool may have written.

    A plan: verify trusts only the trajectory and the mission's text in plan.json. The exit status is 1 if a
    claim is broken, if the plan differs from its mission or its proof, or, with --against, if it is not the
    plan of that mission file.

    A flight of another tool: verify proves it against a mission (--against): its ground, zones, buildings,
    limits, drones and promises. It reads .plan (QGroundControl), .waypoints (QGC WPL 110), .kmz
    (DJI WPML), .csv (Litchi, or trajectories in the columns of trajectory.csv), .skyc and zipped CSV
    (Skybrush). Each flight is rebuilt as its machine flies it, on every curve that the machine may take, and
    proved between its points. What a file does not contain is named and not judged; for example, waypoints
    have no clock.

    Tables and shows name their drones. A file of waypoints belongs to the drone in its name (`cam1.kmz`;
    `cam1-1.kmz`, `cam1-2.kmz` are parts of one flight), or to the one of --drone.

    --abort-every 1s proves that a show can be aborted at every second: all drones of a fleet brake along
    their common way, fly to the pads, where any drone may take any pad, and land. Each return is proved as
    the plan is: separation, limits, zones, ground and endurance. Cameras that film the show fly on as
    planned, and each return keeps clear of them. Pyro that burns at that second burns on, and its clearances
    are kept. The exit status is 1 if some second has no return.

    For every claim, the printed certificate gives the limit, the worst value, its time, and how it is known.
    A claim is ok, BROKEN (an error), or missed: a preference that is not reached, which is a warning.

    For example:

        shotc verify out/tower/plan.json --against tower.yaml

        shotc verify flight.kmz --against tower.yaml

        shotc verify a.plan b.csv --against pair.yaml --drone cam1 --drone cam2
    """
    mission = None if against is None else MissionFile(*read_mission(against))
    every = None if abort_every is None else _seconds(abort_every)
    flights = any(is_flight(file.name) for file in files)
    if every is not None and flights:
        raise typer.BadParameter("collective returns are of plans", param_hint="--abort-every")
    if flights:
        _verify_flights(files, mission, drone or (), format)
    if len(files) > 1 or drone:
        endings = ", ".join(SUFFIXES)
        raise typer.BadParameter(f"several files, or --drone, are for flights ({endings})", param_hint="FILE")
    _verify_plan(files[0], mission, every, format)


def _verify_plan(
    file: Path, mission: MissionFile | None, every: float | None, format: CertificateFormat
) -> NoReturn:
    """Prove a plan, and returns ``every`` so many seconds where that is given; print the report, and exit."""
    report = prove(file, mission)
    returns: Sequence[Return] | None = None
    if every is not None and report.plan is not None:
        returns, report = _returns(report.plan, report, every)
    if format is CertificateFormat.JSON:
        console.out(_document(report, returns))
    else:
        _print(report)
        if returns is not None and every is not None:
            from shotc.cli.returns import returns_text

            console.out(returns_text(returns, every))
    raise typer.Exit(console.exit_code(report.diagnostics))


def _seconds(text: str) -> float:
    """Read a time, seconds."""
    try:
        seconds = parse_quantity(float(text) if text.replace(".", "", 1).isdecimal() else text, "duration")
    except QuantityError as fault:
        raise typer.BadParameter(f"{fault.message}; {fault.help}", param_hint="--abort-every") from None
    if seconds < LEAST_ABORT_S:
        raise typer.BadParameter(f"give {LEAST_ABORT_S} s or more", param_hint="--abort-every")
    return seconds


def _returns(plan: VerifiedIR, report: PlanReport, every: float) -> tuple[Sequence[Return], PlanReport]:
    """Return the collective returns of a plan, and the report with the faults of the returns added."""
    if not plan.trajectory.fleets:
        raise typer.BadParameter("collective returns are of shows", param_hint="--abort-every")
    from shotc.collective import collective_returns
    from shotc.collective.missing_returns import no_return

    with console.Progress() as progress:
        returns = collective_returns(plan, every, progress)
    faults = tuple(no_return(plan.trajectory.keyframes.mission, returns))
    return returns, report._replace(diagnostics=(*report.diagnostics, *faults))


def _verify_flights(
    files: Sequence[Path], mission: MissionFile | None, drones: Sequence[str], format: CertificateFormat
) -> NoReturn:
    """Prove flights, print the report, and exit."""
    other = next((file for file in files if not is_flight(file.name)), None)
    if other is not None:
        raise typer.BadParameter(
            f"`{other}` is no file of a flight; give plans by themselves", param_hint="FILE"
        )
    if mission is None:
        raise typer.BadParameter("flights are held against a mission: give its file", param_hint="--against")
    from shotc.flightfiles.verify import FlightFile, verify_flights

    read = [FlightFile(bytes_of(file, largest(file.name) + 1), file.as_posix()) for file in files]
    report = verify_flights(read, mission, drones)
    if format is CertificateFormat.JSON:
        console.out(_flights_document(report))
    else:
        _print_flights(report)
    raise typer.Exit(console.EXIT_CLEAN if report.holds else console.EXIT_REJECTED)


def _print_flights(report: FlightsReport) -> None:
    from shotc.cli.summary import certificate_text

    if report.certificate:
        console.out(certificate_text(report.certificate))
    console.report(report.diagnostics, report.sources)
    for note in report.notes:
        console.out(note)
    if report.holds:
        hard = sum(claim.hard for claim in report.certificate)
        console.out(f"what is judged holds: {hard} requirements proved")


def _flights_document(report: FlightsReport) -> str:
    from shotc.planfile.codec import encode

    document = json.loads(render(report.diagnostics, report.sources))
    result = {"holds": report.holds, "certificate": encode(report.certificate), "notes": list(report.notes)}
    return json.dumps(result | document, indent=2)


def _print(report: PlanReport) -> None:
    from shotc.cli.summary import certificate_text

    if report.certificate:
        console.out(certificate_text(report.certificate))
    console.report(report.diagnostics, report.sources)
    if report.plan is not None:
        hard = sum(claim.hard for claim in report.certificate)
        console.out(f"the plan holds: {hard} requirements proved again")


def _document(report: PlanReport, returns: Sequence[Return] | None) -> str:
    from shotc.planfile.codec import encode

    document = json.loads(render(report.diagnostics, report.sources))
    result: dict[str, Any] = {"holds": report.plan is not None, "certificate": encode(report.certificate)}
    if returns is not None:
        from shotc.cli.returns import returns_document

        result["returns"] = returns_document(returns)
    return json.dumps(result | document, indent=2)
