"""Mission texts that a command is given: files, folders of missions, and standard input."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

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
_MISSION = re.compile(rb"""^(?:\xef\xbb\xbf)?(?:\s*\{\s*)?["']?shotc["']?[ \t]*:""", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class MissionText:
    """The bytes of one mission, the name to show it under, and the folder of the files it names."""

    data: bytes
    name: str
    folder: Path


@dataclass(slots=True)
class Gathered:
    """Missions to check, what could not be read, and the YAML files passed over as no missions."""

    missions: list[MissionText] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    skipped: int = 0


def read_mission(spec: str, stdin_name: str | None = None) -> MissionText:
    """Return the one mission a command is given; where it cannot be read, say so and exit."""
    found = _read(spec, stdin_name)
    if isinstance(found, MissionText):
        return found
    console.report([found], {})
    raise typer.Exit(console.EXIT_REJECTED)


def gather(specs: Sequence[str], stdin_name: str | None = None) -> Gathered:
    """Read every mission that ``specs`` names, each once: files, folders with all below them, and ``-``."""
    gathered = Gathered()
    seen: set[str] = set()
    for spec in specs:
        if spec != STDIN and Path(spec).is_dir():
            _gather_folder(Path(spec), gathered, seen)
        elif _is_new(spec, seen):
            _keep(_read(spec, stdin_name), gathered)
    return gathered


def _gather_folder(folder: Path, gathered: Gathered, seen: set[str]) -> None:
    holds_any = False
    for path in _yaml_files(folder):
        found = _read(str(path), None)
        if isinstance(found, MissionText) and not _MISSION.search(found.data):
            gathered.skipped += 1
            continue
        holds_any = True
        if _is_new(str(path), seen):
            _keep(found, gathered)
    if not holds_any:
        gathered.diagnostics.append(_no_mission(folder))


def _yaml_files(folder: Path) -> Iterator[Path]:
    """Yield the YAML files in and below a folder in order of name; hidden folders are left out."""
    for parent, folders, files in os.walk(folder):
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


def _keep(found: MissionText | Diagnostic, gathered: Gathered) -> None:
    if isinstance(found, MissionText):
        gathered.missions.append(found)
    else:
        gathered.diagnostics.append(found)


def _read(spec: str, stdin_name: str | None) -> MissionText | Diagnostic:
    if spec == STDIN:
        folder = Path(stdin_name).parent if stdin_name else Path()
        return MissionText(_bounded(sys.stdin.buffer), stdin_name or STDIN_NAME, folder)
    path = Path(spec)
    name = path.as_posix()
    try:
        with path.open("rb") as stream:
            return MissionText(_bounded(stream), name, path.parent)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        return Diagnostic(
            UNREADABLE_FILE,
            f"the file cannot be read: {reason}",
            (Label(name, WHOLE_FILE),),
            help="check the path; it is relative to the current folder",
        )


def _bounded(stream: BinaryIO) -> bytes:
    """Read one byte more than a mission may have, so that the reader of texts can tell."""
    return stream.read(MAX_BYTES + 1)


def _no_mission(folder: Path) -> Diagnostic:
    return Diagnostic(
        NO_MISSION,
        "the folder holds no mission",
        (Label(folder.as_posix(), WHOLE_FILE),),
        ("in a folder, *.yaml and *.yml files with a top-level key `shotc` are taken for missions",),
        "name the file itself, or start a mission from a template: shotc new",
    )
