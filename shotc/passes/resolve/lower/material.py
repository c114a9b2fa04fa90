"""What shows need: fleets, and the files that displays draw (meshes, drawings, fonts)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial
from hashlib import sha256
from pathlib import Path

from shotc.diag.model import Diagnostic
from shotc.ir.effects import Image
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.show import Display, Drawing, Lettering, Model, Picture, RecordedFlight
from shotc.ir.source import KeptFiles
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault
from shotc.kinds.image_file import image_fault
from shotc.kinds.models.endings import FLIGHT_ENDINGS
from shotc.kinds.svg import svg_fault
from shotc.passes.resolve.lower.files import NOT_KEPT, Files, read_file
from shotc.passes.resolve.lower.fleets import fleets_of
from shotc.passes.resolve.lower.shots import ShowMaterial
from shotc.passes.resolve.lower.world import PadSite
from shotc.show.labels import key_of
from shotc.source.limits import MAX_TABLE_BYTES
from shotc.spec.load import LoadedMission

LARGEST_MESH_BYTES = 64_000_000  # bytes of one mesh or font
LARGEST_FLIGHT_BYTES = 200_000_000  # bytes of one recorded flight, as in `importers.flights`
LARGEST_SUM_BYTES = 256_000_000  # bytes of all files that one mission draws

Material = tuple[tuple[str, bytes], ...]


def read_material(
    displays: Iterable[Display], folder: Path | None, origins: OriginMap
) -> tuple[Material, list[Diagnostic]]:
    """Return (name, bytes) of every file that displays draw, each once, and the faults of others.

    Of the files of one pattern, only the first fault is reported.
    """
    files: dict[str, bytes] = {}
    faults: dict[KeyPath, Diagnostic] = {}
    read = partial(_usable, folder, origins)
    for name, path in (named for display in displays for named in _named(display)):
        if name in files or path in faults:
            continue
        data = read(name, path)
        total = sum(map(len, files.values()))
        if not isinstance(data, Diagnostic) and total + len(data) > LARGEST_SUM_BYTES:
            message = f"with this file the mission's displays have more than {LARGEST_SUM_BYTES / 1e6:.0f} MB"
            data = bad_file(origins, path, name, FileFault(message, None, "thin the meshes, or take fewer"))
        if isinstance(data, Diagnostic):
            faults[path] = data
        else:
            files[name] = data
    return tuple(files.items()), list(faults.values())


def digests(files: Material) -> tuple[tuple[str, str], ...]:
    """Return (name, SHA-256, hexadecimal) of files."""
    return tuple((name, sha256(data).hexdigest()) for name, data in files)


def not_kept(displays: Iterable[Display], kept: KeptFiles, origins: OriginMap) -> list[Diagnostic]:
    """Return a fault for every file that displays draw and a plan does not contain."""
    known = dict(kept.drawn)
    named = (key for display in displays for key in _named(display))
    return [
        Diagnostic("N008", f"`{name}` is not kept", (origins.value(path),), help=NOT_KEPT)
        for name, path in dict(named).items()
        if name not in known
    ]


def _named(display: Display) -> Iterator[tuple[str, KeyPath]]:
    """Yield the files of a display, in its order, with their key paths."""
    for picture in display.pictures:
        yield from ((name, _where(picture)) for name in files_of(picture))
    for effect in display.every_effect:
        if isinstance(effect.paint, Image):
            yield effect.paint.file, (*effect.path, "image", "file")


def files_of(picture: Picture) -> tuple[str, ...]:
    """Return the names of the files of a picture; a font of the system is none."""
    source = picture.source
    if isinstance(source, Model):
        return source.files
    if isinstance(source, Drawing | RecordedFlight):
        return (source.file,)
    if isinstance(source, Lettering) and source.font is not None and "." in source.font:
        return (source.font,)
    return ()


def _where(picture: Picture) -> KeyPath:
    key = {Model: "files", Drawing: "file", RecordedFlight: "flight"}.get(type(picture.source), "font")
    return (*key_of(picture), key)


def _usable(folder: Path | None, origins: OriginMap, name: str, path: KeyPath) -> bytes | Diagnostic:
    drawing = name.lower().endswith(".svg")
    flight = name.lower().endswith(FLIGHT_ENDINGS)
    most = MAX_TABLE_BYTES if drawing else LARGEST_FLIGHT_BYTES if flight else LARGEST_MESH_BYTES
    data = read_file(folder, origins, name, path, most)
    if isinstance(data, Diagnostic):
        return data
    if not data:
        return bad_file(origins, path, name, FileFault("the file is empty", None, "export it again"))
    if name.lower().endswith((".png", ".gif")):
        return _image(data, origins, name, path)
    if flight and (broken := _no_archive(data)) is not None:
        return bad_file(origins, path, name, broken)
    wrong = svg_fault(data) if drawing else None
    if wrong is None:
        return data
    if not wrong.unsafe:
        return bad_file(origins, path, name, wrong.fault)
    note = f"{name}, line {wrong.fault.line}"
    message = f"`{name}` is more than a drawing: {wrong.fault.message}"
    return Diagnostic("D022", message, (origins.value(path),), (note,), wrong.fault.help)


def _no_archive(data: bytes) -> FileFault | None:
    """Return why bytes are not a complete ZIP archive, by their first and last ones (APPNOTE 4.3), or
    None.
    """
    if not data.startswith(b"PK"):
        return FileFault("it is no ZIP archive", None, "export the show again, as `.skyc` or zipped CSV")
    if b"PK\5\6" not in data[-65_557:]:
        message = f"the archive breaks off: after {len(data)} bytes it has no table of its files"
        return FileFault(message, None, "copy it again, or export the show again")
    return None


def _image(data: bytes, origins: OriginMap, name: str, path: KeyPath) -> bytes | Diagnostic:
    wrong = image_fault(data)
    if wrong is None:
        return data
    code, message = ("D101", "is too large") if wrong.size else ("D100", "cannot be read")
    label, fault = origins.value(path), wrong.fault
    return Diagnostic(code, f"image `{name}` {message}", (label,), (fault.message,), fault.help)


def show_material(
    ir: LoadedMission,
    site: PadSite,
    files: Files,
    displays: tuple[Display, ...],
    song: tuple[str, bytes] | None = None,
) -> ShowMaterial:
    """Resolve the fleets, and read the files of their displays; song : (name, bytes)."""
    fleets, wrong = fleets_of(ir.spec, site, files)
    if isinstance(ir.folder, KeptFiles):
        return ShowMaterial(fleets, (), ir.folder.drawn, (*wrong, *not_kept(displays, ir.folder, ir.origins)))
    drawn, missing = read_material(displays, ir.folder, ir.origins)
    material = drawn if song is None else (*drawn, song)
    return ShowMaterial(fleets, material, digests(drawn), (*wrong, *missing))
