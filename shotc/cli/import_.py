"""``shotc import``: make a mission from a file of another tool."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.cli import console
from shotc.cli.inputs import STDIN, STDIN_NAME
from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.emit.base import Artifact
from shotc.importers.cameras.takes import ImportOptions
from shotc.importers.flights.endings import LARGEST_CLOCKED_BYTES, suffix_of
from shotc.importers.words import CAMERA_FORMATS, FORMATS, SHOW_FORMAT, safe_name
from shotc.importers.xml_tree import LARGEST_BYTES
from shotc.ir.source import KeptFiles
from shotc.output import write
from shotc.source.file import WHOLE_FILE

if TYPE_CHECKING:  # it loads every importer
    from shotc.importers.mission import Imported

FormatArgument = Annotated[str, typer.Argument(metavar="FORMAT", help=f"What it is: {', '.join(FORMATS)}.")]
FileArgument = Annotated[
    str, typer.Argument(metavar="FILE", help="The file to read, or - for standard input.")
]
OutputFile = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", metavar="MISSION", help="The file to write; without it, or with -, prints."
    ),
]
Strict = Annotated[bool, typer.Option("--strict", help="Refuse what would have to be assumed.")]
Every = Annotated[bool, typer.Option("--every", help="Keep all cameras, also those that the others imply.")]
Times = Annotated[
    bool, typer.Option("--times", help="Keep when each camera is reached, not only how long a take lasts.")
]
Fps = Annotated[
    float | None,
    typer.Option("--fps", metavar="N", help="Frames a second, of blender-camera; 24 by default."),
]
Ground = Annotated[
    float | None,
    typer.Option("--ground", metavar="METRES", help="Altitude of the ground, above sea level."),
]


def import_(
    format: FormatArgument,
    file: FileArgument,
    output: OutputFile = None,
    strict: Strict = False,
    every: Every = False,
    times: Times = False,
    fps: Fps = None,
    ground: Ground = None,
) -> None:
    """Start a mission from one of another tool.

    `multidrone` reads the XML of the MultiDrone project's dashboard. Shooting actions become shots with
    their distances and times, sequences become drones, trajectories become the tracks of targets, and
    `RULE_OF_THIRDS` becomes a third with room on the side to which the target moves.

    `kml` reads tours of Google Earth (`gx:Tour`, KML or KMZ), or the cameras of placemarks in their order.
    `blender-camera` reads a table with the columns `frame,x,y,z,rx,ry,rz,lens`, in metres with Z up;
    `qw,qx,qy,qz` and `hfov` are possible, too. `qgc` reads waypoints, headings and gimbal commands of a
    QGroundControl plan. `litchi` reads the table of its Hub. Each tour, animation or recording becomes a shot
    of `keyframes`. Tours and animations keep their length if the drone is fast enough. The importer leaves
    out cameras that the others imply: a thing that is as far away as the camera is high moves on screen by at
    most 0.01 half frames.

    `show` reads a drone show from elsewhere: zipped CSV (.zip) or a `.skyc`. The mission flies the show as it
    is recorded. `-o` names the mission. Its pads are written beside it, and so is the show, unless it is
    there already.

    If the file leaves something open, has an error or contradicts itself, the importer makes an assumption.
    Each assumption is a warning with its line and column, and a comment in the mission, where you can change
    it. With `--strict` the importer refuses such a file. The command writes a mission that `shotc check`
    accepts, or nothing.

    Example: `shotc import kml tour.kml --ground 408 -o tour.yaml`
    """
    from shotc.importers.mission import imported

    if format not in FORMATS:
        raise typer.BadParameter(f"`{format}` is none; there are: {', '.join(FORMATS)}", param_hint="FORMAT")
    for option, value, low, high in (("--fps", fps, 1.0, 1000.0), ("--ground", ground, -500.0, 9000.0)):
        if value is not None and not low <= value <= high:
            raise typer.BadParameter(f"from {low:g} to {high:g}, please", param_hint=option)
    for option, given, those in (
        ("--fps", fps is not None, ("blender-camera",)),
        ("--ground", ground is not None, ("kml", "qgc", "litchi")),
        ("--times", times, ("kml", "blender-camera")),
        ("--every", every, tuple(CAMERA_FORMATS)),
    ):
        if given and format not in those:
            raise typer.BadParameter(f"it is for {', '.join(those)}", param_hint=option)
    if format == SHOW_FORMAT:
        _import_show(file, output, strict=strict)
        return
    options = ImportOptions(every=every, times=times, fps=fps, ground=ground)
    name = STDIN_NAME if file == STDIN else file
    result = imported(format, _read(file, LARGEST_BYTES), name, strict=strict, options=options)
    text = _accepted(result, file, None)
    _save(text, output)
    counts = f"{_counted(result.drones, 'drone')}, {_counted(result.shots, 'shot')}"
    if result.cameras:
        counts += f", {_counted(result.keyframes, 'keyframe')} of {_counted(result.cameras, 'camera')}"
    console.note(f"imported {counts}; {_counted(len(result.diagnostics), 'assumption')}")


def _import_show(file: str, output: Path | None, *, strict: bool) -> None:
    """Write the mission of a show, the table of its pads, and the show itself unless it is in that folder."""
    from shotc.importers.shows import imported_show

    if output is None or output == Path("-") or file == STDIN:
        raise typer.BadParameter("a show takes files beside it: name FILE, and the mission", param_hint="-o")
    data = _read(file, LARGEST_CLOCKED_BYTES)
    there = _inside(Path(file), output.parent)
    named = there or f"{safe_name(Path(file).stem, 'show')}{suffix_of(file)}"
    show = imported_show(data, file, named, strict=strict)
    pads = () if show.pads is None else (show.pads,)
    files = KeptFiles(dict(pads), ((named, ""),), {})
    text = _accepted(show.made, file, files)
    beside = [*pads, *([] if there else [(named, data)])]
    _save(text, output, beside)
    mission = show.made
    console.note(
        f"imported {_counted(mission.drones, 'drone')}; {_counted(len(mission.diagnostics), 'assumption')}"
    )


def _inside(file: Path, folder: Path) -> str | None:
    """Return the path of a file relative to the folder of a mission, None if the file is outside of it."""
    try:
        return file.resolve().relative_to(folder.resolve()).as_posix()
    except (ValueError, OSError, RuntimeError):
        return None


def _accepted(result: Imported, file: str, files: KeptFiles | None) -> str:
    """Return the text of a mission that `check` accepts.

    files : the files that the mission names
    """
    from shotc.checking import check_source

    console.report(result.diagnostics, result.sources)
    if result.text is None:
        raise typer.Exit(console.EXIT_REJECTED)
    checked = check_source(result.text.encode(), "the mission", files)
    if has_errors(checked.diagnostics):
        console.report(checked.diagnostics, checked.sources)
        failed = Diagnostic(
            "I006",
            f"what `{file}` asks for is no mission that can be flown; nothing is written",
            help=f"correct in `{file}` what the errors above name, and import it again",
        )
        console.report([failed], {})
        raise typer.Exit(console.EXIT_REJECTED)
    return result.text


def _read(file: str, most: int) -> bytes:
    """Return the bytes of a file, but at most a little more than an importer reads."""
    try:
        if file == STDIN:
            return sys.stdin.buffer.read(most + 1) if sys.stdin else b""
        with Path(file).open("rb") as stream:
            return stream.read(most + 1)
    except (OSError, ValueError) as fault:
        reason = getattr(fault, "strerror", None) or fault
        message = f"`{file}` cannot be read: {reason}"
        console.report(
            [Diagnostic("I001", message, (Label(file, WHOLE_FILE),), help="check the name of the file")], {}
        )
        raise typer.Exit(console.EXIT_REJECTED) from None


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _save(text: str, output: Path | None, beside: Sequence[tuple[str, bytes]] = ()) -> None:
    """Write a mission and the files beside it, (name, bytes), or print it."""
    if output is None or output == Path("-"):
        console.out(text.rstrip("\n"))
        return
    files = [Artifact(output.name, text.encode()), *(Artifact(*file) for file in beside)]
    _, faults = write(files, output.parent)
    if faults:
        console.report(faults, {})
        raise typer.Exit(console.exit_code(faults))
    console.note(f"wrote {output}; next: shotc check {output}, then shotc plan {output}")
