"""Progress file of a batch: it records finished missions, so that a batch that was killed can resume.

An entry is ignored if it belongs to another text, another version or other options, or if any of its files
has changed since. The file is deleted when the batch is finished.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from shotc import __version__
from shotc.batch.work import Job, MissionOutcome, Planned
from shotc.emit.base import Artifact
from shotc.filenames import file_name
from shotc.progress_file import ProgressFile

NAME = "plan.unfinished.jsonl"


@dataclass(frozen=True, slots=True)
class Record:
    """The record of a batch's finished missions."""

    file: ProgressFile

    @staticmethod
    def of(root: Path) -> Record:
        """Return the record in a folder.

        root : the folder that holds the folders of all missions
        """
        return Record(ProgressFile(root / NAME))

    def done(self) -> dict[str, dict[str, Any]]:
        """Return the recorded entries by the key of their job."""
        return {entry["key"]: entry for entry in self.file.entries()}

    def add(self, job: Job, planned: Planned) -> None:
        """Record a mission whose files are written."""
        entry = {
            "outcome": planned.outcome._asdict(),
            "read": planned.read,
            "written": [(each.name, _sha256(each)) for each in planned.artifacts],
        }
        self.file.add(key_of(job), entry)


def _sha256(artifact: Artifact) -> str:
    digest = sha256()
    for part in artifact.chunks():
        digest.update(part)
    return digest.hexdigest()


def key_of(job: Job) -> str:
    """Return the key of a job: a hash of its text, the version and all options."""
    options = job.options
    chosen = (options.refiner, options.deadline, options.autopilot, options.seed, options.headings)
    identity = repr((__version__, job.name, str(job.folder), chosen, job.emitters))
    return sha256(identity.encode() + job.data).hexdigest()


def recorded_outcome(job: Job, entry: dict[str, Any], root: Path) -> MissionOutcome | None:
    """Return the recorded outcome of a job; None if the job has to be planned again.

    entry : one of ``Record.done``
    root : the folder that holds the folders of all missions
    """
    with suppress(OSError, KeyError, TypeError, ValueError):
        outcome = MissionOutcome(**entry["outcome"])
        files = [(folder_of(outcome, root), each) for each in entry["written"]]
        files += [(job.folder, each) for each in entry["read"]]
        if all(_digest(folder / name) == digest for folder, (name, digest) in files):
            return outcome
    return None


def folder_of(outcome: MissionOutcome, root: Path) -> Path:
    """Return the folder for the files of a mission.

    root : the folder that holds the folders of all missions
    """
    return root / file_name(outcome.mission or "")


def _digest(path: Path) -> str:
    with path.open("rb") as stream:
        return sha256(stream.read()).hexdigest()
