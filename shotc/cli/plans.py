"""Read the plan files that a command line names, prove them again, and report the result."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.api import MissionFile, PlanReport, verify_plan
from shotc.cli import console
from shotc.diag.codes.yaml import UNREADABLE_FILE
from shotc.diag.model import Diagnostic, Label
from shotc.source.file import WHOLE_FILE

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import VerifiedIR

PlanPath = Annotated[Path, typer.Argument(metavar="PLAN", help="A plan.json, or the folder that holds it.")]


def prove(place: Path, against: MissionFile | None = None) -> PlanReport:
    """Read a plan file and prove it again. If it cannot be read, report why and exit.

    against : see ``api.verify_plan``
    """
    path = place / "plan.json" if place.is_dir() else place
    return verify_plan(bytes_of(path), path.as_posix(), against)


def bytes_of(path: Path, most: int = -1) -> bytes:
    """Return at most ``most`` bytes of a file. If it cannot be read, report why and exit."""
    try:
        with path.open("rb") as stream:
            return stream.read(most)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        fault = Diagnostic(
            UNREADABLE_FILE,
            f"the file cannot be read: {reason}",
            (Label(path.as_posix(), WHOLE_FILE),),
            help="give the plan.json that `shotc plan` wrote"
            if path.suffix in ("", ".json")
            else "see whether its name is right, and whether it may be read",
        )
        console.report([fault], {})
        raise typer.Exit(console.EXIT_REJECTED) from None


def proved(place: Path) -> VerifiedIR:
    """Return a plan whose proof holds. If it does not hold, report why and exit."""
    report = prove(place)
    if report.plan is None:
        console.report(report.diagnostics, report.sources)
        raise typer.Exit(console.EXIT_REJECTED)
    return report.plan
