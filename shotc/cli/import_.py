"""``shotc import``: start a mission from one of another tool."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from shotc.cli import console

FORMATS = ("multidrone",)

FormatArgument = Annotated[str, typer.Argument(metavar="FORMAT", help=f"What it is: {', '.join(FORMATS)}.")]
FileArgument = Annotated[Path, typer.Argument(metavar="FILE", help="The file to read.")]
OutputFile = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="MISSION", help="The file to write; prints without it."),
]
Strict = Annotated[bool, typer.Option("--strict", help="Refuse what would have to be assumed.")]


def import_(
    format: FormatArgument, file: FileArgument, output: OutputFile = None, strict: Strict = False
) -> None:
    """Start a mission from one of another tool.

    `multidrone` reads the XML of the MultiDrone project's dashboard. What the file leaves open or has wrong
    is assumed: each assumption is a warning with its line, and a comment in the mission. What is written is
    a mission that `shotc check` accepts, or nothing is.

    Example: `shotc import multidrone karting.xml -o karting.yaml`
    """
    from shotc.api import check_source
    from shotc.diag.model import Diagnostic
    from shotc.diag.registry import has_errors
    from shotc.importers.mission import import_multidrone

    if format not in FORMATS:
        raise typer.BadParameter(f"`{format}` is none; there are: {', '.join(FORMATS)}", param_hint="FORMAT")
    try:
        data = file.read_bytes()
    except (OSError, ValueError) as fault:
        raise typer.BadParameter(f"`{file}` cannot be read: {fault}", param_hint="FILE") from None
    made = import_multidrone(data, str(file), strict=strict)
    console.report(made.diagnostics, made.sources)
    if made.text is None:
        raise typer.Exit(console.EXIT_REJECTED)
    checked = check_source(made.text.encode(), "the mission", None)
    if has_errors(checked.diagnostics):
        console.report(checked.diagnostics, checked.sources)
        failed = Diagnostic(
            "I006", f"what `{file}` asks for is no mission that can be flown; nothing is written"
        )
        console.report([failed], {})
        raise typer.Exit(console.EXIT_REJECTED)
    _save(made.text, output)
    counts = f"{_counted(made.drones, 'drone')}, {_counted(made.shots, 'shot')}"
    console.note(f"imported {counts}; {_counted(len(made.diagnostics), 'assumption')}")


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _save(text: str, output: Path | None) -> None:
    if output is None:
        console.out(text.rstrip("\n"))
        return
    from shotc.emit.base import Artifact
    from shotc.output import write

    _, faults = write([Artifact(output.name, text.encode())], output.parent)
    if faults:
        console.report(faults, {})
        raise typer.Exit(console.exit_code(faults))
    console.note(f"wrote {output}; next: shotc check {output}, then shotc plan {output}")
