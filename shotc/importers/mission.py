"""The way in for every importer: bytes of another tool's mission to the text of one of ours, or faults."""

from __future__ import annotations

from pathlib import PurePath
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.importers.multidrone.read import sequences_of
from shotc.importers.multidrone.targets import frame_of
from shotc.importers.multidrone.write import mission_text
from shotc.importers.notes import Notes, label, told
from shotc.importers.xml_tree import XmlFault, parse_xml
from shotc.source.file import SourceFile, Span


class Imported(NamedTuple):
    """What an importer makes.

    text : the mission, or None where a diagnostic is an error
    shots : how many; sources : the text that the diagnostics point into
    """

    text: str | None
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
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
    kinds = [kind.value("name") for types in root.all("targetTypes") for kind in types.all("targetType")]
    if not any(action.points or action.origin for s in sequences for action in s.actions):
        message = f"`{name}` holds no shooting action that says where it is filmed"
        return Imported(None, (Diagnostic("I003", message, (label(name, root),)),), sources)
    text = mission_text(PurePath(name).stem, kinds, sequences, frame, notes)
    said = told(name, notes, strict=strict)
    shots = sum(len(action.roles) for s in sequences for action in s.actions)
    return Imported(None if has_errors(said) else text, said, sources, shots)
