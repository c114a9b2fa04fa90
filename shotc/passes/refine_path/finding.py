"""What is wrong with a refined path, before it is told."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR
from shotc.passes.refine_path.seat import Seat


class Finding(NamedTuple):
    """One fault of what a refiner did.

    what : completes "refiner `x` of package y ..."
    shot : the one it is about, None where all are concerned; labels : places beside that of the shot
    help : what to do, where the refiner's authors need not hear of it
    """

    code: str
    what: str
    notes: tuple[str, ...] = ()
    shot: str | None = None
    labels: tuple[Label, ...] = ()
    help: str = ""


class Fault(NamedTuple):
    """An error and the shot that it is about, None where it concerns all of them."""

    shot: str | None
    told: Diagnostic


def tell(mission: MissionIR, seat: Seat, finding: Finding) -> Fault:
    """Return a finding as the error that the user reads."""
    path = next((shot.path for shot in mission.shots if shot.id == finding.shot), None)
    labels = (() if path is None else (mission.origins.key(path, "in this shot"),)) + finding.labels
    help_ = finding.help or f"tell the authors of {seat.package}"
    return Fault(
        finding.shot, Diagnostic(finding.code, f"{seat.named} {finding.what}", labels, finding.notes, help_)
    )


def own(mission: MissionIR, seat: Seat, diagnostic: Diagnostic) -> Fault:
    """Return an error of the refiner's own, with the package's name added."""
    note = seat.named
    return Fault(
        shot_of(mission, diagnostic), diagnostic._replace(notes=(*diagnostic.notes, f"told by {note}"))
    )


def shot_of(mission: MissionIR, diagnostic: Diagnostic) -> str | None:
    """Return the one shot whose key an error labels; the only shot of a mission needs no label."""
    if len(mission.shots) == 1:
        return mission.shots[0].id
    spans = {label.span for label in diagnostic.labels}
    named = [shot.id for shot in mission.shots if mission.origins.key(shot.path).span in spans]
    return named[0] if len(named) == 1 else None
