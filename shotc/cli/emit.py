"""``shotc emit``: write output files of an existing plan."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from shotc import plugins
from shotc.api import emit_plan
from shotc.cli import console
from shotc.cli.plans import PlanPath, proved
from shotc.output import write

Output = Annotated[Path | None, typer.Option("-o", "--output", help="Folder for the files [the plan's].")]
Emit = Annotated[
    str | None, typer.Option(help="Emitters to run, separated by commas [the mission's].", metavar="LIST")
]


def emit(plan: PlanPath, output: Output = None, emit: Emit = None) -> None:
    """Write a plan's output files again, without planning; plan.json itself stays unchanged.

    The plan is proved first; a plan that does not hold is not written. Example:

        shotc emit out/tower/plan.json --emit csv -o tables
    """
    names = None if emit is None else [name.strip() for name in emit.split(",") if name.strip()]
    for name in names or ():
        if name not in plugins.names("emitters"):
            known = ", ".join(plugins.names("emitters"))
            raise typer.BadParameter(f"`{name}` is unknown; known: {known}", param_hint="--emit")
    emitted = emit_plan(proved(plan), names, saved=True)
    diagnostics = emitted.diagnostics
    paths: list[Path] = []
    if emitted.artifacts:
        paths, faults = write(emitted.artifacts, output or (plan if plan.is_dir() else plan.parent))
        diagnostics += faults
    console.report(diagnostics, {})
    for path in paths:
        console.out(str(path))
    if not emitted.artifacts and not names:
        console.note("nothing is written: no output is selected; name some with --emit")
    for text in emitted.notes:
        console.note(text)
    raise typer.Exit(console.exit_code(diagnostics))
