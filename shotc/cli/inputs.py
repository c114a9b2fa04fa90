"""Read the mission texts that a command line names: files, folders of missions, and standard input."""

import os
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import typer

from shotc.cli import console
from shotc.diag.codes.yaml import NO_MISSION, UNREADABLE_FILE
from shotc.diag.model import Diagnostic, Label
from shotc.source.file import WHOLE_FILE
from shotc.source.limits import MAX_BYTES

STDIN = "-"
STDIN_NAME = "<stdin>"
_SUFFIXES = (".yaml", ".yml")
# In a folder a YAML file is a mission if its top level has the key `shotc`, in block or in flow style.
_MISSION = rb"""(?m)^(?:\xef\xbb\xbf)?(?:\s*\{\s*)?["']?shotc["']?[ \t]*:"""


class MissionText(NamedTuple):
    """The bytes of one mission, its name for messages, and the folder of the files that it names."""

    data: bytes
    name: str
    folder: Path


class Gathered:
    """Missions to check, diagnostics of unreadable files, and YAML files that are no missions."""

    def __init__(self) -> None:
        self.missions: list[MissionText] = []
        self.diagnostics: list[Diagnostic] = []
        self.skipped = 0

    def passed_over(self) -> str:
        """Return the end of a sentence with the number of skipped YAML files; empty if there are none."""
        if not self.skipped:
            return ""
        files = "file" if self.skipped == 1 else "files"
        return f"; passed over {self.skipped} YAML {files} without a top-level key `shotc`"


def read_mission(spec: str, stdin_name: str | None = None) -> MissionText:
    """Return the mission that ``spec`` names. If it cannot be read, report why and exit."""
    text = _read(spec, stdin_name)
    if isinstance(text, MissionText):
        return text
    console.report([text], {})
    raise typer.Exit(console.EXIT_REJECTED)


def gather(specs: Sequence[str], stdin_name: str | None = None) -> Gathered:
    """Read every mission that ``specs`` names, each once: files, folders with their subfolders, and ``-``."""
    gathered = Gathered()
    seen: set[str] = set()
    for spec in specs:
        if spec != STDIN and is_folder(spec):
            _gather_folder(Path(spec), gathered, seen)
        elif _is_new(spec, seen):
            _keep(_read(spec, stdin_name), gathered)
    return gathered


def is_folder(spec: str) -> bool:
    """Return whether an argument names a folder."""
    try:
        return Path(spec).is_dir()
    except OSError:  # the name is too long; reading the file reports it
        return False


def _gather_folder(folder: Path, gathered: Gathered, seen: set[str]) -> None:
    holds_any = False
    errors: list[OSError] = []
    for path in _yaml_files(folder, errors):
        text = _read(str(path), None)
        if isinstance(text, MissionText) and not re.search(_MISSION, text.data):
            gathered.skipped += 1
            continue
        holds_any = True
        if _is_new(str(path), seen):
            _keep(text, gathered)
    gathered.diagnostics += [_unreadable("folder", str(error.filename), error) for error in errors]
    if not (holds_any or errors):
        gathered.diagnostics.append(_no_mission(folder))


def _yaml_files(folder: Path, errors: list[OSError]) -> Iterator[Path]:
    """Yield the YAML files in a folder and its subfolders, sorted by name, without hidden folders.

    errors : receives the errors of folders that cannot be read
    """
    for parent, folders, files in os.walk(folder, onerror=errors.append):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            path = Path(parent) / name
            if name.lower().endswith(_SUFFIXES) and path.is_file():
                yield path


def _is_new(spec: str, seen: set[str]) -> bool:
    key = spec if spec == STDIN else os.path.realpath(spec)
    if key in seen:
        return False
    seen.add(key)
    return True


def _keep(text: MissionText | Diagnostic, gathered: Gathered) -> None:
    if isinstance(text, MissionText):
        gathered.missions.append(text)
    else:
        gathered.diagnostics.append(text)


def _read(spec: str, stdin_name: str | None) -> MissionText | Diagnostic:
    if spec == STDIN:
        name = stdin_name or STDIN_NAME
        path = Path(stdin_name or "")
    else:
        path = Path(spec)
        name = path.as_posix()
    try:
        if spec == STDIN:
            return MissionText(_bounded(sys.stdin.buffer) if sys.stdin else b"", name, path.parent)
        with path.open("rb") as stream:
            return MissionText(_bounded(stream), name, path.parent)
    except OSError as error:
        return _unreadable("file", name, error)


def _unreadable(what: str, name: str, error: OSError) -> Diagnostic:
    reason = (error.strerror or str(error)).lower()
    return Diagnostic(
        UNREADABLE_FILE,
        f"the {what} cannot be read: {reason}",
        (Label(name, WHOLE_FILE),),
        help="check the path, which is relative to the current folder, and the right to read it",
    )


def _bounded(stream: BinaryIO) -> bytes:
    """Read one byte more than a mission may have, so that the YAML reader reports a text too long."""
    return stream.read(MAX_BYTES + 1)


def _no_mission(folder: Path) -> Diagnostic:
    return Diagnostic(
        NO_MISSION,
        "the folder holds no mission",
        (Label(folder.as_posix(), WHOLE_FILE),),
        ("in a folder, *.yaml and *.yml files with a top-level key `shotc` are taken for missions",),
        "name the file itself, or start a mission from a template: shotc new",
    )
