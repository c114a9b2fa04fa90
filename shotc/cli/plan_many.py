"""``shotc plan`` of a folder: plan its missions in parallel, print a row for each, and plan none twice."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import typer

from shotc import plugins
from shotc.api import PlanOptions
from shotc.batch.record import Record, folder_of, key_of, recorded_outcome
from shotc.batch.work import Job, MissionOutcome, Planned, planned
from shotc.checking import models_of
from shotc.cli import console, refiner
from shotc.cli.console import Progress, table
from shotc.cli.earlier_outputs import print_left_over, warn_of_earlier
from shotc.cli.hands import at_work, no_cluster
from shotc.cli.inputs import Gathered, MissionText
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.filenames import file_name
from shotc.output import write
from shotc.parallel import Hands, as_done, cores
from shotc.rounding import as_minutes
from shotc.source.file import SourceFile
from shotc.spec.load import load

HEAD = ("mission", "in the air", "proved", "warnings", "files")


def plan_many(
    gathered: Gathered,
    options: PlanOptions,
    emitters: Sequence[str] | None,
    output: Path | None,
    hands: Hands | None,
) -> int:
    """Plan missions in parallel, write their files, report all diagnostics, and return the exit status.

    output : parent of the folders of all missions, None for ``out``
    hands  : number of processes or address of a cluster, None for all cores
    """
    root = output or Path("out")
    clashes, sources = _clashes(gathered.missions)
    faults = (*gathered.diagnostics, *no_cluster(hands if isinstance(hands, str) else None), *clashes)
    faults += refiner.missing(options.refiner)
    console.report(faults, sources)
    if has_errors(faults):
        return console.EXIT_REJECTED
    outputs = None if emitters is None else tuple(emitters)
    jobs = [Job(text.data, text.name, text.folder.resolve(), options, outputs) for text in gathered.missions]
    batch = _Batch(jobs, root)
    with Progress() as progress, at_work():
        progress(f"0 of {len(jobs)} missions")
        for planned_mission in as_done(planned, batch.left, hands or cores()):
            batch.take(planned_mission)
            progress(f"{len(batch.outcomes)} of {len(jobs)} missions")
    batch.record.file.forget()
    console.out("\n".join(_lines(batch, gathered)))
    rejected = any(each.errors for each in batch.outcomes.values())
    return console.EXIT_REJECTED if rejected else console.EXIT_CLEAN


class _Batch:
    """Writes the files of each mission when it is done, and reports the missions in their order."""

    def __init__(self, jobs: list[Job], root: Path) -> None:
        self.jobs = {job.name: job for job in jobs}
        self.root = root
        self.record = Record.of(root)
        entries = self.record.done()
        earlier = {job.name: recorded_outcome(job, entries.get(key_of(job), {}), root) for job in jobs}
        self.outcomes = {name: outcome for name, outcome in earlier.items() if outcome is not None}
        self.before = len(self.outcomes)
        self.left = [job for job in jobs if job.name not in self.outcomes]
        self._waiting: dict[str, Planned] = {}
        self._due = deque(job.name for job in self.left)

    def take(self, planned: Planned) -> None:
        """Write the files of a mission, record that it is done, and report all missions whose turn it is."""
        name, folder = planned.outcome.name, folder_of(planned.outcome, self.root)
        if planned.artifacts:
            planned = _written(planned, folder)
        if not planned.outcome.errors:
            self.record.add(self.jobs[name], planned)
        elif planned.outcome.mission is not None:
            warn_of_earlier(folder)
        self.outcomes[name] = planned.outcome
        self._waiting[name] = planned
        while self._due and self._due[0] in self._waiting:
            outcome = self._waiting.pop(self._due.popleft())
            console.report(outcome.diagnostics, outcome.sources)


def _written(planned: Planned, folder: Path) -> Planned:
    """Write the files of a mission. Return it with the errors of files that could not be written."""
    paths, faults = write(planned.artifacts, folder)
    if paths:
        print_left_over(folder, {path.name for path in paths})
    outcome = planned.outcome._replace(errors=planned.outcome.errors + len(faults))
    return planned._replace(diagnostics=(*planned.diagnostics, *faults), outcome=outcome)


def _lines(batch: _Batch, gathered: Gathered) -> Iterator[str]:
    outcomes = [batch.outcomes[name] for name in batch.jobs]
    yield from table([HEAD, *(_row(batch, outcome) for outcome in outcomes)])
    yield ""
    good = sum(not outcome.errors for outcome in outcomes)
    text = f"planned {good} of {len(outcomes)} missions"
    if batch.before:
        text += f"; {batch.before} of them before this run was stopped, whose warnings were printed then"
    yield text + gathered.passed_over()


def _row(batch: _Batch, outcome: MissionOutcome) -> tuple[str, ...]:
    warnings = str(outcome.warnings) if outcome.warnings else "-"
    if outcome.errors:
        errors = "1 error" if outcome.errors == 1 else f"{outcome.errors} errors"
        return (outcome.name, "-", "-", warnings, f"none: {errors}")
    folder = f"{folder_of(outcome, batch.root)}/"
    return (outcome.name, as_minutes(outcome.in_the_air), str(outcome.proved), warnings, folder)


def _clashes(missions: Sequence[MissionText]) -> tuple[list[Diagnostic], dict[str, SourceFile]]:
    """Return the diagnostics of missions with the same name: they would share an output folder."""
    kinds = plugins.shot_kinds()
    first: dict[str, str] = {}
    clashes, sources = [], {}
    for text in missions:
        loaded = load(text.data, text.name, text.folder, models_of(kinds.plugins), kinds.unusable)
        sources[text.name] = loaded.file
        if loaded.title is None or loaded.mission is None:
            continue
        folder = file_name(loaded.title)
        if folder in first:
            clashes.append(
                Diagnostic(
                    "E115",
                    f"`{loaded.title}` would be written over another mission, into {folder}/",
                    (loaded.mission.origins.value(("mission",)),),
                    (f"{first[folder]} has that name, too",),
                    "give one of them another name, or plan them one by one with `-o`",
                )
            )
        first.setdefault(folder, text.name)
    return clashes, sources


def one_mission_only(given: Mapping[str, object]) -> None:
    """Raise a usage error for options that only work with one mission.

    given : options and their values
    """
    for option, value in given.items():
        if value:
            raise typer.BadParameter("it is for one mission, not for several", param_hint=option)
