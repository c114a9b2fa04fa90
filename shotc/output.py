"""Atomic writing of output files: all of them or none.

Every file is first written beside its place under a temporary name and flushed to the disk. When all are
written, they are renamed into place with interrupts blocked. If a rename fails, the earlier ones are undone.
So a full disk, a folder or file without write permission, and Ctrl-C leave the files of an earlier run
unchanged.
"""

from __future__ import annotations

import errno
import json
import os
import re
import signal
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import copyfile
from typing import NamedTuple, Self

from shotc.diag.model import Diagnostic
from shotc.emit.base import Artifact

FLOWN = (
    "plan.json",
    "trajectory.csv",
    "*.plan",
    "*.waypoints",
    "*.kmz",
    "*-litchi.csv",
    "*-ned.csv",
    "*.skyc",
    "*-csv.zip",
)
"""Files that are flown, or converted into flown ones."""

SHOWN = (
    "framing.csv",
    "storyboard.png",
    "contact-sheet.png",
    "animatic.gif",
    "mission.rrd",
    "mission.glb",
    "mission.usda",
    "*.kml",
    "*.tum",
    "*.vviz",
    "*-report.html",
)
"""Other output files."""

TELL_BYTES = 10_000_000
"""Bytes between two progress messages for a large file."""

HEAD_BYTES = 65536
"""Bytes at the start of a plan.json that are searched for its mission's name."""


class Earlier(NamedTuple):
    """Flown files of an earlier run: its mission, if a plan.json names it, and the names of the files."""

    mission: str | None
    files: tuple[str, ...]


def earlier(folder: Path) -> Earlier | None:
    """Return the flown files in a folder, or None if there are none."""
    files = tuple(path.name for pattern in FLOWN for path in sorted(folder.glob(pattern)) if path.is_file())
    return Earlier(_mission_of(folder / FLOWN[0]), files) if files else None


def _mission_of(plan: Path) -> str | None:
    """Return the mission's name from the first bytes of a plan.json, which for a show has many megabytes."""
    try:
        with plan.open("rb") as stream:
            head = stream.read(HEAD_BYTES).decode(errors="replace")
    except OSError:
        return None
    name = re.search(r'^  "mission": \{\s*"name": ("(?:[^"\\\n]|\\.)*")', head, re.MULTILINE)
    return None if name is None else str(json.loads(name[1]))


def left_over(folder: Path, written: Collection[str]) -> tuple[str, ...]:
    """Return the outputs in a folder that are not among those just written, by name."""
    names = {path.name for pattern in FLOWN + SHOWN for path in folder.glob(pattern) if path.is_file()}
    return tuple(sorted(names.difference(written)))


def write(
    artifacts: Sequence[Artifact], folder: Path, progress: Callable[[str], None] | None = None
) -> tuple[list[Path], tuple[Diagnostic, ...]]:
    """Write artifacts into ``folder``, which is created if necessary; return their paths, or an error.

    progress : called with the progress of large files
    """
    clash = _clash(artifacts)
    if clash is not None:
        return [], (clash,)
    missing = [p for p in (folder, *folder.parents) if not p.exists()]
    staged: list[_Staged] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for artifact in artifacts:
            staged.append(_Staged.beside(folder / artifact.name))
            _write_through(staged[-1].temporary, artifact, progress)
        with _uninterrupted():
            _put_in_place(staged)
    except OSError as fault:
        return [], (_cannot_write(folder, fault),)
    finally:
        _forget(staged)
        for new_folder in missing:
            with suppress(OSError):  # not empty: it has our files, or others
                new_folder.rmdir()
    return [file.place for file in staged], ()


class _Staged(NamedTuple):
    """A file to write: its path, its temporary path, and the backup path of the file that it replaces."""

    place: Path
    temporary: Path
    backup: Path

    @classmethod
    def beside(cls, place: Path) -> Self:
        """Return the paths of a file; raise IsADirectoryError if a folder is in its place."""
        if place.is_dir():
            raise IsADirectoryError(f"{place.name} is a folder there")
        temporary, backup = (place.with_name(f".{place.name}.{os.getpid()}.{end}") for end in ("tmp", "old"))
        return cls(place, temporary, backup)


def _put_in_place(staged: Sequence[_Staged]) -> None:
    """Rename all files into place; if one fails, restore the replaced files and raise OSError."""
    for file in staged:
        if file.place.exists():
            _keep(file.place, file.backup)
    placed: list[_Staged] = []
    try:
        for file in staged:
            file.temporary.replace(file.place)
            placed.append(file)
    except OSError:
        for file in placed:
            if file.backup.exists():
                file.backup.replace(file.place)
            else:
                file.place.unlink()
        raise


def _keep(place: Path, backup: Path) -> None:
    try:
        backup.hardlink_to(place)
    except OSError:  # a file system without links
        copyfile(place, backup)


def _forget(staged: Sequence[_Staged]) -> None:
    for file in staged:
        for path in (file.temporary, file.backup):
            with suppress(OSError):
                path.unlink(missing_ok=True)


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


def _write_through(path: Path, artifact: Artifact, progress: Callable[[str], None] | None) -> None:
    written = reported = 0
    with path.open("wb") as stream:
        for part in artifact.chunks():
            stream.write(part)
            written += len(part)
            if progress is not None and written - reported >= TELL_BYTES:
                progress(f"writing {artifact.name}: {written // 1_000_000} MB")
                reported = written
        stream.flush()
        os.fsync(stream.fileno())


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Delay Ctrl-C until the end of the block; outside the main thread do nothing."""
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
        f"the outputs cannot be written: {(fault.strerror or str(fault)).lower()}",
        notes=(f"folder: {folder}", "files of an earlier run are as they were"),
        help=_HELP.get(fault.errno or 0, "choose another folder with -o"),
    )


_ROOM = "free some space, or choose another folder with -o"
_RIGHT = "choose a folder with -o that you may write to"
_NO_FOLDER = "choose another folder with -o: something there is no folder, or is one in a file's place"
_HELP = {
    **dict.fromkeys((errno.ENOSPC, errno.EDQUOT, errno.EFBIG), _ROOM),
    **dict.fromkeys((errno.EACCES, errno.EPERM, errno.EROFS), _RIGHT),
    **dict.fromkeys((errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ELOOP), _NO_FOLDER),
}
