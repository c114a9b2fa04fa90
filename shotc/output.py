"""Writing output files: all of them, whole, or none of them.

Every file is first written beside its place, under a temporary name, and flushed to the disk; only
when all are there are they renamed into place, with interrupts held back for that moment. A full
disk, a folder that cannot be written or Ctrl-C leave the files of an earlier run as they were.
"""

from __future__ import annotations

import json
import os
import re
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.emit.base import Artifact

FLOWN = ("plan.json", "trajectory.csv", "*.plan", "*.waypoints", "*.skyc")
"""What is flown from, or made into something that is."""

HEAD = 65536
"""Bytes of a plan.json in which its mission's name is looked for."""


class Earlier(NamedTuple):
    """What an earlier run left to be flown: its mission, where a plan.json tells it, and names of files."""

    mission: str | None
    files: tuple[str, ...]


def earlier(folder: Path) -> Earlier | None:
    """Return the outputs in a folder that somebody may fly, or None where there are none."""
    files = tuple(path.name for pattern in FLOWN for path in sorted(folder.glob(pattern)) if path.is_file())
    return Earlier(_mission_of(folder / FLOWN[0]), files) if files else None


def _mission_of(plan: Path) -> str | None:
    """Return the mission's name from the first bytes of a plan.json: that of a show is many megabytes."""
    try:
        with plan.open("rb") as stream:
            head = stream.read(HEAD).decode(errors="replace")
    except OSError:
        return None
    found = re.search(r'^  "mission": \{\s*"name": ("(?:[^"\\]|\\.)*")', head, re.MULTILINE)
    return None if found is None else str(json.loads(found[1]))


def write(artifacts: Sequence[Artifact], folder: Path) -> tuple[list[Path], tuple[Diagnostic, ...]]:
    """Write artifacts into ``folder``, which is made if need be; return their paths, or an error."""
    clash = _clash(artifacts)
    if clash is not None:
        return [], (clash,)
    staged: list[tuple[Path, Path]] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for artifact in artifacts:
            place = folder / artifact.name
            if place.is_dir():
                raise IsADirectoryError(f"{artifact.name} is a folder there")
            temporary = folder / f".{artifact.name}.{os.getpid()}.tmp"
            staged.append((temporary, place))
            _write_through(temporary, artifact.data)
        with _uninterrupted():
            for temporary, place in staged:
                temporary.replace(place)
    except OSError as fault:
        return [], (_cannot_write(folder, fault),)
    finally:
        for temporary, _ in staged:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
    return [place for _, place in staged], ()


def _clash(artifacts: Sequence[Artifact]) -> Diagnostic | None:
    names = [artifact.name for artifact in artifacts]
    twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
    if not twice:
        return None
    return Diagnostic(
        "E902",
        f"two emitters make {', '.join(twice)}",
        notes=("nothing is written",),
        help="leave one of them out with --emit",
    )


def _write_through(path: Path, data: bytes) -> None:
    with path.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold back Ctrl-C; it is delivered afterwards. Off the main thread there is nothing to hold."""
    pending: list[int] = []
    try:
        before = signal.signal(signal.SIGINT, lambda number, _frame: pending.append(number))
    except ValueError:
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if pending:
            signal.raise_signal(signal.SIGINT)


def _cannot_write(folder: Path, fault: OSError) -> Diagnostic:
    return Diagnostic(
        "E901",
        f"the outputs cannot be written: {fault.strerror or fault}",
        notes=(f"folder: {folder}", "files of an earlier run are as they were"),
        help="free some space, or choose another folder with -o",
    )
