"""The way in for every importer: bytes of another tool's mission to the text of one of ours, or faults."""

from __future__ import annotations

from pathlib import PurePath
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.importers.multidrone.frames import frame_of
from shotc.importers.multidrone.read import sequences_of
from shotc.importers.multidrone.write import written_mission
from shotc.importers.notes import Notes, label, told
from shotc.importers.xml_tree import XmlFault, parse_xml
from shotc.source.file import SourceFile, Span


class Imported(NamedTuple):
    """What an importer makes.

    text : the mission, or None where a diagnostic is an error
    sources : the text that the diagnostics point into
    drones, shots : how many
    """

    text: str | None
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    drones: int = 0
    shots: int = 0


def import_multidrone(data: bytes, name: str, *, strict: bool) -> Imported:
    """Make a mission of a MultiDrone mission file.

    data : any bytes; name : how to show the file; strict : refuse instead of assuming anything
    """
    source = SourceFile(name, data.decode("utf-8-sig", "replace"))
    sources = {name: source}
    root = parse_xml(data)
    if isinstance(root, XmlFault):
        where = Label(name, Span(root.line, root.column, root.line, root.column + 1))
        return Imported(
            None, (Diagnostic("I001", f"`{name}` cannot be read: {root.message}", (where,)),), sources
        )
    if root.tag != "mission":
        message = f"`{name}` is no mission of the MultiDrone project: its root is `{root.tag[:30]}`"
        return Imported(None, (Diagnostic("I002", message, (label(name, root),)),), sources)
    notes = Notes()
    sequences = sequences_of(root, notes)
    frame = frame_of(sequences, notes)
    made = written_mission(PurePath(name).stem, root, sequences, frame, notes)
    if made is None:
        message = f"`{name}` holds no shooting action that says where it is filmed"
        return Imported(None, (Diagnostic("I003", message, (label(name, root),)),), sources)
    said = told(name, notes, strict=strict)
    return Imported(None if has_errors(said) else made.text, said, sources, made.drones, made.shots)
