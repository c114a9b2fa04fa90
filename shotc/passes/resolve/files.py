"""Reading the files that a mission names, and nothing outside the mission's folder."""

from __future__ import annotations

from pathlib import Path

from shotc.diag.model import Diagnostic
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.base import bad_file
from shotc.kinds.files import LARGEST, FileFault
from shotc.spec.words import closest

NO_FOLDER = "a mission read from standard input has no folder; save it to a file"


def read_file(folder: Path | None, origins: OriginMap, name: str, path: KeyPath) -> bytes | Diagnostic:
    """Return the bytes of the file that the mission names at ``path``, or what is wrong with it.

    Links are followed as far as they stay inside the folder. At most one byte more than a file may
    have is read, so that a device or a huge file costs nothing.
    """
    label = (origins.value(path),)
    if folder is None:
        return Diagnostic("N008", f"cannot read `{name}`", label, ("the mission has no folder",), NO_FOLDER)
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
        with place.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except (OSError, ValueError, RuntimeError) as error:
        reason = getattr(error, "strerror", None) or "the path cannot be followed"
        return Diagnostic("N008", f"cannot read `{name}`", label, (str(reason).lower(),), "check the file")
    if len(data) > LARGEST:
        wrong = FileFault(f"the file has more than {LARGEST / 1e6:.0f} MB", None, "thin it")
        return bad_file(origins, path, name, wrong)
    return data


def _neighbours(place: Path) -> str:
    """Propose the files of the same sort that lie where the missing one was looked for."""
    if not place.parent.is_dir():
        return "check the path; it counts from the folder of the mission"
    found = sorted(p.name for p in place.parent.iterdir() if p.suffix.lower() == place.suffix.lower())
    close = closest(place.name, found[:1000])
    if close is not None:
        return f"did you mean `{close}`?"
    return f"there are {', '.join(f'`{n}`' for n in found[:3])}" if found else "check the name of the file"
