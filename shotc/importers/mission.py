"""Entry point of all importers: bytes of another tool's mission to the text of a shotc mission."""

from __future__ import annotations

from pathlib import PurePath
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.importers.cameras import blender, kml, litchi, qgc
from shotc.importers.cameras.takes import ImportedTakes, ImportOptions, Refused
from shotc.importers.cameras.write import written
from shotc.importers.multidrone.frames import frame_of, without_far
from shotc.importers.multidrone.read import below, sequences_of
from shotc.importers.multidrone.write import written_mission
from shotc.importers.notes import Notes, assumption_diagnostics, label
from shotc.importers.words import CAMERA_FORMATS, CUT_IN_TWO, cut_into
from shotc.importers.xml_tree import LARGEST_BYTES, Node, XmlFault, parse_xml, readable_text
from shotc.source.file import SourceFile, Span

MOST = {"shootingAction": 100, "shootingRole": 200, "RTTrajectoryPoint": 2000}
"""Most elements of each kind. More are not a mission, and would take minutes."""

MULTIDRONE = "give a mission of the MultiDrone project, XML with the root `mission`"
WHERE = "give a `shootingAction` an `RTTrajectory` of points, or an `originOfFormation`"

START = Node("", 1, 1, wide=1)
USUAL = ImportOptions()


class Imported(NamedTuple):
    """The result of an importer.

    text      : the mission, or None if a diagnostic is an error
    sources   : the texts that the diagnostics point into
    drones    : number of drones
    shots     : number of shots
    keyframes : number of keyframes, for a file of cameras
    cameras   : number of cameras that they were made from
    """

    text: str | None
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    drones: int = 0
    shots: int = 0
    keyframes: int = 0
    cameras: int = 0


def imported(
    format: str, data: bytes, name: str, *, strict: bool, options: ImportOptions = USUAL
) -> Imported:
    """Make a mission from a file of one of ``formats.FORMATS``.

    data   : any bytes
    name   : name of the file for messages
    strict : report an error instead of making an assumption
    """
    if format == "multidrone":
        return import_multidrone(data, name, strict=strict)
    return _import_cameras(format, data, name, options, strict=strict)


def _import_cameras(format: str, data: bytes, name: str, options: ImportOptions, *, strict: bool) -> Imported:
    notes = Notes()
    if len(data) > LARGEST_BYTES:
        footage: ImportedTakes | Refused = Refused(
            "I001", f"it is larger than {LARGEST_BYTES / 1e6:.0f} MB", START, CUT_IN_TWO
        )
        text = ""
    else:
        text, footage = _footage(format, data, name, options, notes)
    sources = {name: SourceFile(name, text)}
    if isinstance(footage, ImportedTakes):
        mission_text = written(PurePath(name).stem, CAMERA_FORMATS[format], footage, options, notes)
        if mission_text is not None:
            said = assumption_diagnostics(name, notes, strict=strict)
            result = None if has_errors(said) else mission_text.text
            return Imported(
                result, said, sources, 1, mission_text.shots, mission_text.keyframes, mission_text.cameras
            )
        message = "it holds no take of two cameras or more, and a shot needs two"
        footage = Refused("I003", message, footage.node, "add a second camera, and import it again")
    message = f"`{name}` cannot be imported: {footage.message}"
    wrong = Diagnostic(footage.code, message, (label(name, footage.node),), (), footage.help)
    return Imported(None, (*assumption_diagnostics(name, notes, strict=False), wrong), sources)


def _footage(
    format: str, data: bytes, name: str, options: ImportOptions, notes: Notes
) -> tuple[str, ImportedTakes | Refused]:
    """Return the text of a file of cameras, for messages, and its content."""
    if format == "qgc":
        return readable_text(data), qgc.footage(data, name, options, notes)
    if format in ("blender-camera", "litchi"):
        read = blender.footage if format == "blender-camera" else litchi.footage
        return readable_text(data), read(readable_text(data), options, notes)
    plain = kml.unpacked(data)
    root = plain if isinstance(plain, XmlFault) else parse_xml(plain)
    if isinstance(root, XmlFault):
        node = Node("", root.line, root.column, wide=1)
        return "" if isinstance(plain, XmlFault) else readable_text(plain), Refused(
            "I001", root.message, node, root.help
        )
    return "" if isinstance(plain, XmlFault) else readable_text(plain), kml.footage(root, options, notes)


def import_multidrone(data: bytes, name: str, *, strict: bool) -> Imported:
    """Make a mission from a MultiDrone mission file.

    data   : any bytes
    name   : name of the file for messages
    strict : report an error instead of making an assumption
    """
    source = SourceFile(name, readable_text(data))
    sources = {name: source}
    root = parse_xml(data)
    if isinstance(root, XmlFault):
        where = Label(name, Span(root.line, root.column, root.line, root.column + 1))
        return Imported(
            None,
            (Diagnostic("I001", f"`{name}` cannot be read: {root.message}", (where,), help=root.help),),
            sources,
        )
    if root.tag != "mission":
        message = f"`{name}` is no mission of the MultiDrone project: its root is `{root.tag[:30]}`"
        return Imported(None, (Diagnostic("I002", message, (label(name, root),), help=MULTIDRONE),), sources)
    for tag, most in MOST.items():
        elements = below(root, tag)
        if len(elements) > most:
            message = f"`{name}` cannot be read: it has {len(elements)} `{tag}`; at most {most} are read"
            return Imported(
                None,
                (
                    Diagnostic(
                        "I001", message, (label(name, elements[most]),), help=cut_into(most, f"`{tag}`")
                    ),
                ),
                sources,
            )
    notes = Notes()
    sequences = without_far(sequences_of(root, notes), notes)
    frame = frame_of(sequences, notes)
    text = written_mission(PurePath(name).stem, root, sequences, frame, notes)
    if text is None:
        message = f"`{name}` holds no shooting action that says where it is filmed"
        return Imported(None, (Diagnostic("I003", message, (label(name, root),), help=WHERE),), sources)
    said = assumption_diagnostics(name, notes, strict=strict)
    return Imported(None if has_errors(said) else text.text, said, sources, text.drones, text.shots)
