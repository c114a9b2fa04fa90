"""Options of `shotc simulate` for the conditions of the simulated flights."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from shotc.cli import console
from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR
from shotc.passes.resolve.lower.files import FileReader, Files
from shotc.passes.resolve.lower.recordings import read_recording
from shotc.simulation.outages import Outage

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shotc.source.file import SourceFile


def outages(mission: MissionIR, lost: Sequence[str]) -> tuple[Outage, ...]:
    """Return the outages of options written FROM:TO or NAME=FROM:TO, seconds.

    Raise a usage error for another text.
    """
    return tuple(_outage(mission, each) for each in lost)


def _outage(mission: MissionIR, text: str) -> Outage:
    name, equals, span = text.rpartition("=")
    if equals:
        drones, targets = [d.name for d in mission.drones], [t.name for t in mission.targets]
        console.known("--lost", name, [*drones, *targets])
    start, _, end = span.partition(":")
    try:
        outage = Outage(float(start), float(end), name)
    except ValueError:
        outage = Outage(0.0, 0.0)
    if not (isfinite(outage.end) and 0.0 <= outage.start < outage.end):
        raise typer.BadParameter(
            f"`{text}` is no stretch of time; write FROM:TO or NAME=FROM:TO in seconds", param_hint="--lost"
        )
    return outage


def true_tracks(
    mission: MissionIR, sources: dict[str, SourceFile], written: Sequence[str]
) -> tuple[tuple[str, Track], ...]:
    """Return the tracks of options written TARGET=FILE.

    Raise a usage error for another text, or if there is no such file. If a file cannot be read, report
    why and exit.
    """
    return tuple(_true_track(mission, sources, each) for each in written)


def _true_track(mission: MissionIR, sources: dict[str, SourceFile], written: str) -> tuple[str, Track]:
    name, _, place = written.partition("=")
    known = [target.name for target in mission.targets]
    console.known("--truth", name, known)
    if not place:
        raise typer.BadParameter(f"`{written}` names no file; write {name}=FILE", param_hint="--truth")
    path, target = Path(place), mission.target(name)
    if not path.is_file():
        raise typer.BadParameter(f"there is no file `{place}`", param_hint="--truth")
    files = Files(mission.origin, mission.origins, FileReader(path.parent, mission.origins))
    read = read_recording(path.name, files, target.path)
    if isinstance(read, Diagnostic):
        console.report([read], sources)
        raise typer.Exit(console.EXIT_REJECTED)
    return name, read.track
