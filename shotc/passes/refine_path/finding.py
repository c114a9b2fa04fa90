"""A fault of a refined path, before it becomes a diagnostic."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR
from shotc.passes.refine_path.seat import Seat


class RefinerFinding(NamedTuple):
    """One fault of a refiner's result.

    what : completes "refiner `x` of package y ..."
    shot : the shot that it is about; None where all are
    labels : places in addition to that of the shot
    help : remedy for the user; by default the report to the refiner's authors
    """

    code: str
    what: str
    notes: tuple[str, ...] = ()
    shot: str | None = None
    labels: tuple[Label, ...] = ()
    help: str = ""


class RefinerFault(NamedTuple):
    """An error and the shot that it is about; None where it is about all of them."""

    shot: str | None
    diagnostic: Diagnostic


def error_of(mission: MissionIR, seat: Seat, finding: RefinerFinding) -> RefinerFault:
    """Return a finding as the error that the user reads."""
    path = next((shot.path for shot in mission.shots if shot.id == finding.shot), None)
    labels = (() if path is None else (mission.origins.key(path, "in this shot"),)) + finding.labels
    help_ = finding.help or f"tell the authors of {seat.package}"
    return RefinerFault(
        finding.shot, Diagnostic(finding.code, f"{seat.named} {finding.what}", labels, finding.notes, help_)
    )


def own(mission: MissionIR, seat: Seat, diagnostic: Diagnostic) -> RefinerFault:
    """Return an error of the refiner itself, with the package's name added."""
    note = seat.named
    return RefinerFault(
        shot_of(mission, diagnostic), diagnostic._replace(notes=(*diagnostic.notes, f"reported by {note}"))
    )


def shot_of(mission: MissionIR, diagnostic: Diagnostic) -> str | None:
    """Return the one shot that an error labels; in a mission with a single shot no label is needed."""
    if len(mission.shots) == 1:
        return mission.shots[0].id
    spans = {label.span for label in diagnostic.labels}
    named = [shot.id for shot in mission.shots if mission.origins.key(shot.path).span in spans]
    return named[0] if len(named) == 1 else None
