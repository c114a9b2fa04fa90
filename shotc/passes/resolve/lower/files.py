"""Reading the files that a mission names, all of them within the mission's folder."""

import re
from fnmatch import translate
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.mission import GeoOrigin
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.source import KeptFiles
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault
from shotc.source.limits import MAX_LINKED_BYTES, MAX_TABLE_BYTES
from shotc.spec.words import closest

MOST_FILES = 5_000  # frames of an animation
_WILD = "*?"
NOT_KEPT = "plan the mission again: a plan keeps every file that its mission reads"
NO_FOLDER = "a mission read from standard input has no folder; save it to a file"


class FileReader:
    """Reads the files that a mission names, and keeps what a plan needs of them.

    tables : name and bytes of small files
    linked : name and SHA-256, hexadecimal, of files to which a plan links
    """

    def __init__(self, folder: Path | KeptFiles | None, origins: OriginMap) -> None:
        self._folder = folder
        self._origins = origins
        self.tables: dict[str, bytes] = {}
        self.linked: dict[str, str] = {}

    def __call__(self, name: str, path: KeyPath) -> bytes | Diagnostic:
        """Return the bytes of the file that the mission names at ``path``, or its fault."""
        data = read_file(self._folder, self._origins, name, path)
        if isinstance(data, bytes):
            self.tables[name] = data
        return data

    def large(self, name: str, path: KeyPath, *, linked: bool) -> bytes | Diagnostic:
        """Return the bytes of a file that may be larger than a table, or its fault.

        linked : whether a plan always links to it; otherwise a plan contains it if it is small enough
        """
        folder = self._folder
        if isinstance(folder, KeptFiles) and name in folder.linked:
            data = _read_linked(folder, self._origins, name, path)
        else:
            data = read_file(folder, self._origins, name, path, MAX_LINKED_BYTES)
        if isinstance(data, Diagnostic):
            return data
        if linked or len(data) > MAX_TABLE_BYTES:
            self.linked[name] = sha256(data).hexdigest()
        else:
            self.tables[name] = data
        return data


class Files(NamedTuple):
    """The data with which a mission's files are read.

    origin : of W on the earth, if the mission has one
    read : reader of the files
    """

    origin: GeoOrigin | None
    origins: OriginMap
    read: FileReader


def read_file(
    folder: Path | KeptFiles | None,
    origins: OriginMap,
    name: str,
    path: KeyPath,
    most: int = MAX_TABLE_BYTES,
) -> bytes | Diagnostic:
    """Return the bytes of the file that the mission names at ``path``, or its fault.

    Links are followed inside the folder only. A file of more than ``most`` bytes is not read, and of a file
    without a size at most one byte more is read, so that neither costs much.
    """
    label = (origins.value(path),)
    if folder is None:
        return Diagnostic("N008", f"cannot read `{name}`", label, ("the mission has no folder",), NO_FOLDER)
    if isinstance(folder, KeptFiles):
        table = folder.tables.get(name)
        return Diagnostic("N008", f"`{name}` is not kept", label, help=NOT_KEPT) if table is None else table
    try:
        root = folder.resolve()
        place = (root / name).resolve()
        if not place.is_relative_to(root):
            note = "the path, or a link on it, leads out of the folder of the mission"
            help_ = "put the file into the mission's folder"
            return Diagnostic("N010", f"`{name}` is outside the mission's folder", label, (note,), help_)
        if not place.is_file():
            note = f"looked for it in the folder of the mission, as `{name}`"
            return Diagnostic("N008", f"cannot find the file `{name}`", label, (note,), _neighbours(place))
        size = place.stat().st_size
        if size <= most:
            with place.open("rb") as stream:
                data = stream.read(most + 1)
            size = len(data)
    except (OSError, ValueError, RuntimeError) as error:
        reason = getattr(error, "strerror", None) or "the path cannot be followed"
        return Diagnostic("N008", f"cannot read `{name}`", label, (str(reason).lower(),), "check the file")
    if size > most:
        message = f"the file has {size / 1e6:.1f} MB, and no more than {most / 1e6:g} MB are read"
        return bad_file(origins, path, name, FileFault(message, None, "thin it"))
    return data


def _read_linked(files: KeptFiles, origins: OriginMap, name: str, path: KeyPath) -> bytes | Diagnostic:
    """Return a file to which a plan links, from the first folder that has it unchanged, or its fault."""
    label, other = (origins.value(path),), None
    for folder in files.folders:
        data = read_file(folder, origins, name, path, MAX_LINKED_BYTES)
        if isinstance(data, bytes):
            if sha256(data).hexdigest() == files.linked[name]:
                return data
            other = other or folder
        elif data.code != "N008":
            return data
    if other is not None:
        message = f"`{name}` is not the file that the plan was made with"
        note = f"{(other / name).as_posix()} has another SHA-256 than the plan says: {files.linked[name]}"
        return Diagnostic("N012", message, label, (note,), "bring back that file, or plan the mission again")
    looked = " and in ".join(dict.fromkeys(folder.as_posix() for folder in files.folders)) or "no folder"
    notes = (f"a plan holds its SHA-256, not the file itself; looked for it in {looked}",)
    help_ = "put it beside the plan, or where the mission was when it was planned"
    return Diagnostic("N011", f"the plan needs the file `{name}`, which is not there", label, notes, help_)


def match_files(
    folder: Path | KeptFiles | None, origins: OriginMap, pattern: str, path: KeyPath
) -> tuple[str, ...] | Diagnostic:
    """Return the names of the files that a pattern at ``path`` matches, or its fault.

    `*` and `?` match characters of the file's name, not of its folders. Numbers in names are sorted by value,
    so that frame-2 comes before frame-10. A name without either is returned as it is, whether it exists or
    not.
    """
    where, slash, last = pattern.rpartition("/")
    if not set(_WILD) & set(pattern):
        return (pattern,)
    label = (origins.value(path),)
    if set(_WILD) & set(where):
        help_ = "put `*` into the file's name, after the last `/`"
        return Diagnostic("N008", f"`{pattern}` is a pattern of folders", label, help=help_)
    if folder is None:
        note = "the mission has no folder"
        return Diagnostic("N008", f"cannot look for `{pattern}`", label, (note,), NO_FOLDER)
    names = (
        _matching_names(folder, where, last)
        if isinstance(folder, KeptFiles)
        else _listed(folder, where, last)
    )
    if isinstance(names, str):
        return Diagnostic("N008", f"cannot look for `{pattern}`", label, (names,), "check the folder's name")
    if not names:
        note = f"looked for it in the folder of the mission, as `{pattern}`"
        return Diagnostic("N008", f"no file is called `{pattern}`", label, (note,), "check the pattern")
    if len(names) > MOST_FILES:
        message = f"`{pattern}` stands for {len(names)} files, and no more than {MOST_FILES} are read"
        return Diagnostic("N008", message, label, help="take a narrower pattern, or fewer frames")
    return tuple(f"{where}{slash}{name}" for name in sorted(names, key=_in_order))


def _fitting(pattern: str) -> re.Pattern[str]:
    return re.compile(translate(pattern.replace("[", "[[]")))


def _matching_names(files: KeptFiles, where: str, pattern: str) -> list[str]:
    """Return the names in a folder that match a pattern, among the files that existed when they were
    listed.
    """
    fits = _fitting(pattern)
    apart = (name.rpartition("/") for name in dict(files.drawn))
    return [last for folder, _, last in apart if folder == where and fits.match(last)]


def _listed(folder: Path, where: str, pattern: str) -> list[str] | str:
    """Return the names in a folder that match a pattern, or why they cannot be listed."""
    fits = _fitting(pattern)
    try:
        root = folder.resolve()
        place = (root / where).resolve()
        if not place.is_relative_to(root):
            return "its folder, or a link on the way, is outside the folder of the mission"
        names = [entry.name for entry in place.iterdir() if fits.match(entry.name) and entry.is_file()]
    except (OSError, ValueError, RuntimeError) as error:
        return str(getattr(error, "strerror", None) or "the path cannot be followed").lower()
    return [name for name in names if pattern[0] == "." or name[0] != "."]


def _in_order(name: str) -> tuple[list[str | int], str]:
    """Return a sort key with numbers by value: text and numbers in turn."""
    parts = re.split(r"([0-9]+)", name)
    return [int(part) if i % 2 else part for i, part in enumerate(parts)], name


def _neighbours(place: Path) -> str:
    """Return files of the same type in the folder of the missing one, as a remedy."""
    if not place.parent.is_dir():
        return "check the path; it counts from the folder of the mission"
    names = sorted(p.name for p in place.parent.iterdir() if p.suffix.lower() == place.suffix.lower())
    close = closest(place.name, names[:1000])
    if close is not None:
        return f"did you mean `{close}`?"
    return f"there are {', '.join(f'`{n}`' for n in names[:3])}" if names else "check the name of the file"
