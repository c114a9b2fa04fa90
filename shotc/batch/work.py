"""One mission of a batch, planned in any process, with its outcome and its files."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.emit.base import Artifact
from shotc.source.file import SourceFile

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.source import MissionSource
    from shotc.ir.trajectory import VerifiedIR


class Job(NamedTuple):
    """A mission and its options; it can be pickled.

    name : the file's name in messages
    folder : absolute path of the folder of the files that the mission names
    emitters : names of emitters; None for those that the mission asks for
    """

    data: bytes
    name: str
    folder: Path
    options: PlanOptions
    emitters: tuple[str, ...] | None


class MissionOutcome(NamedTuple):
    """The outcome of a mission, as one row.

    name : of its file
    mission : its name; None if the file has none
    in_the_air : from the first take-off to the last landing, seconds
    proved : number of claims
    """

    name: str
    mission: str | None
    errors: int
    warnings: int
    in_the_air: float
    proved: int


class Planned(NamedTuple):
    """The result of planning a mission.

    artifacts : empty if an error rejects the mission
    read : (name, SHA-256 in hexadecimal) of all files that the mission names
    """

    outcome: MissionOutcome
    artifacts: tuple[Artifact, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    read: tuple[tuple[str, str], ...] = ()


def planned(job: Job) -> Planned:
    """Return the plan's files of a job's mission, or the errors."""
    compilation = compile_source(job.data, job.name, job.folder, job.options)
    if compilation.plan is None:
        outcome = _outcome(job, compilation.mission, None, compilation.diagnostics)
        return Planned(outcome, (), compilation.diagnostics, compilation.sources)
    emitted = emit_plan(compilation.plan, job.emitters)
    diagnostics = (*compilation.diagnostics, *emitted.diagnostics)
    outcome = _outcome(job, compilation.mission, compilation.plan, diagnostics)
    source = compilation.plan.trajectory.keyframes.mission.source
    return Planned(outcome, emitted.artifacts, diagnostics, compilation.sources, tuple(_read(source)))


def _outcome(
    job: Job, mission: str | None, plan: VerifiedIR | None, diagnostics: tuple[Diagnostic, ...]
) -> MissionOutcome:
    weights = [severity_of(each) for each in diagnostics]
    return MissionOutcome(
        job.name,
        mission,
        weights.count(Severity.ERROR),
        weights.count(Severity.WARNING),
        0.0 if plan is None else plan.trajectory.end,
        0 if plan is None else len(plan.certificate),
    )


def _read(source: MissionSource) -> list[tuple[str, str]]:
    held = [(name, sha256(data).hexdigest()) for name, data in source.tables]
    return [*held, *source.drawn, *source.linked]
