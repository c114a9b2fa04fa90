"""``shotc check``: find what is wrong with missions, without a solver."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Annotated, Literal

import typer

from shotc.cli import console
from shotc.cli.inputs import Gathered, gather
from shotc.diag.model import Diagnostic
from shotc.source.file import SourceFile

Format = Literal["text", "concise", "json", "sarif", "github"]
Specs = Annotated[
    list[str],
    typer.Argument(metavar="SPEC", help="Mission files, folders of missions, or - for standard input."),
]
FormatOption = Annotated[
    Format | None,
    typer.Option(
        "--format",
        help="How to print findings [default: text; github in a GitHub workflow].",
        show_default=False,
    ),
]
StdinName = Annotated[
    str | None,
    typer.Option(metavar="PATH", help="The file that standard input stands for: its name, and its folder."),
]


def check(specs: Specs, format: FormatOption = None, stdin_filename: StdinName = None) -> None:
    """Find what is wrong with missions, without planning them.

    Loads no solver, so it serves editors, hooks and CI. Findings go to standard output; the exit status is
    1 if a mission is rejected.

    Example: `shotc check specs/ --format concise`
    """
    chosen = format or ("github" if os.environ.get("GITHUB_ACTIONS") else "text")
    gathered = gather(specs, stdin_filename)
    diagnostics, sources = _check_all(gathered)
    _print(diagnostics, sources, chosen)
    code = console.exit_code(diagnostics)
    if gathered.missions and (chosen == "text" or gathered.skipped):
        console.note(_conclusion(gathered, clean=code == console.EXIT_CLEAN))
    raise typer.Exit(code)


def _check_all(gathered: Gathered) -> tuple[list[Diagnostic], dict[str, SourceFile]]:
    from shotc.checking import check_source

    diagnostics = list(gathered.diagnostics)
    sources: dict[str, SourceFile] = {}
    for mission in gathered.missions:
        report = check_source(mission.data, mission.name, mission.folder)
        diagnostics += report.diagnostics
        sources |= report.sources
    return diagnostics, sources


def _print(diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile], chosen: str) -> None:
    """Print findings to standard output. JSON and SARIF print their document even without findings."""
    if chosen == "text":
        console.report(diagnostics, sources, sys.stdout)
        return
    render: Callable[[Sequence[Diagnostic], Mapping[str, SourceFile]], str]
    render = import_module(f"shotc.diag.render.{chosen}").render
    if text := render(diagnostics, sources):
        console.out(text)


def _conclusion(gathered: Gathered, *, clean: bool) -> str:
    number = len(gathered.missions)
    text = f"checked {number} mission{'s' if number > 1 else ''}" + (": no errors" if clean else "")
    return text + gathered.passed_over()
