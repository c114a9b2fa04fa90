"""``shotc compare``: one mission under several refiners, side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated

import typer

from shotc import plugins
from shotc.cli import console
from shotc.cli.console import Progress, known, listed, table
from shotc.cli.inputs import read_mission
from shotc.cli.plan import Deadline
from shotc.diag.registry import has_errors
from shotc.filenames import file_name
from shotc.ir.smoothing import LONGEST_S, SHORTEST_S, SMOOTHINGS
from shotc.output import write

if TYPE_CHECKING:
    from shotc.comparison import Report
    from shotc.ir.comparison import Comparison


WIDTH_CHARACTERS = 100


class TableFormat(StrEnum):
    """How the table is printed."""

    TEXT = "text"
    JSON = "json"
    MARKDOWN = "markdown"


Spec = Annotated[str, typer.Argument(metavar="SPEC", help="The mission file, or - for standard input.")]
Refiners = Annotated[
    str | None,
    typer.Option(
        metavar="LIST",
        help="Refiners to compare, separated by commas [all: none, ang, look-at, framing-only, ours-4pt, "
        "ours, others].",
    ),
]
Smoothings = Annotated[
    str | None,
    typer.Option(
        "--smoothing",
        metavar="LIST",
        help="Smoothings of all shots to compare, separated by commas: low, normal, high, or seconds.",
    ),
]
Output = Annotated[
    Path | None, typer.Option("-o", "--output", help="Folder for the files [out/MISSION/compare].")
]
FormatOption = Annotated[TableFormat, typer.Option("--format", help="How to print the table.")]


def compare(
    spec: Spec,
    refiners: Refiners = None,
    smoothing: Smoothings = None,
    output: Output = None,
    format: FormatOption = TableFormat.TEXT,
    deadline: Deadline = None,
) -> None:
    """Plan one mission under several refiners and show what each does to its framing.

    All refiners start from the same convex path, keep the same limits and are measured alike: the distance of
    the target from its wanted place on screen, the share of frames that show it whole, the smoothness of the
    flight. A broken promise (`require`) is reported, but it does not refuse the plan here. A refiner that
    fails has a row that says so. For every refiner and shot the output gives the frame that differs most from
    the last refiner, by metres between the cameras plus degrees between their directions.

    The files are compare.json and compare.md (the table), compare.png (the worst frame of each),
    differences.png (the frames that differ most), and compare.rrd (the camera views, for the rerun viewer).
    These files are not flown; `shotc plan --refiner NAME` plans with one refiner. Examples:

        shotc compare tower.yaml --refiners none,ours
        shotc compare runner.yaml --refiners ours --smoothing low,normal,high
    """
    names = listed(refiners)
    for name in names or ():
        known("--refiners", name, plugins.names("refiners"))
    if names == []:
        raise typer.BadParameter("it names no refiner", param_hint="--refiners")
    smoothings = _smoothings(smoothing)
    source = read_mission(spec)
    from shotc.comparison import Options, compare_source, ordered

    refiner_names = ordered(plugins.names("refiners")) if names is None else names
    with Progress() as progress:
        report = compare_source(
            source.data, source.name, source.folder, Options(refiner_names, smoothings, deadline, progress)
        )
        comparison = _comparison_with_plans(report)
        from shotc.comparison.outputs import artifacts

        emission = artifacts(comparison, progress)
    paths, faults = write(
        emission.artifacts, output or Path("out") / file_name(comparison.mission.name) / "compare"
    )
    console.report((*report.diagnostics, *emission.diagnostics, *faults), report.sources)
    console.out(_printed(comparison, format, paths))
    raise typer.Exit(console.exit_code(faults))


def _smoothings(text: str | None) -> tuple[float | None, ...]:
    """Return the smoothings in ``text``, seconds; ``(None,)``, the mission's own, if there is no text."""
    names = listed(text)
    if names is None:
        return (None,)
    if not names:
        raise typer.BadParameter("it names no smoothing", param_hint="--smoothing")
    return tuple(dict.fromkeys(map(_smoothing, names)))


def _smoothing(name: str) -> float:
    known = SMOOTHINGS.get(name)
    if known is not None:
        return known
    try:
        seconds = float(name.removesuffix("s"))
    except ValueError:
        seconds = 0.0
    if not SHORTEST_S <= seconds <= LONGEST_S:
        text = (
            f"`{name}` is none of {', '.join(SMOOTHINGS)}, and no time from {SHORTEST_S:g} to {LONGEST_S:g} s"
        )
        raise typer.BadParameter(text, param_hint="--smoothing")
    return seconds


def _comparison_with_plans(report: Report) -> Comparison:
    """Return the comparison if it has a plan to show; otherwise report why not, and exit."""
    comparison = report.comparison
    if comparison is not None and any(each.plan is not None for each in comparison.conditions):
        return comparison
    if comparison is None and not has_errors(report.diagnostics):
        raise typer.BadParameter(
            "no camera films in it, and refiners change nothing else", param_hint="MISSION"
        )
    faults = () if comparison is None else (fault for each in comparison.conditions for fault in each.faults)
    console.report((*report.diagnostics, *faults), report.sources)
    raise typer.Exit(console.EXIT_REJECTED)


def _printed(comparison: Comparison, format: TableFormat, paths: Sequence[Path]) -> str:
    from shotc.comparison.document import json_text
    from shotc.comparison.table import markdown

    if format is TableFormat.JSON:
        return json_text(comparison, seconds=True)
    if format is TableFormat.MARKDOWN:
        return markdown(comparison, seconds=True)
    return "\n".join(_text(comparison, paths))


def _text(comparison: Comparison, paths: Sequence[Path]) -> Iterator[str]:
    from shotc.comparison.table import LEGEND, conditions_of, counted, remarks, rows

    shots = counted(len(comparison.mission.shots), "shot")
    yield f"{comparison.mission.name}: {shots} under {conditions_of(comparison)}"
    yield ""
    yield from (f"  {line}" for line in table(rows(comparison, seconds=True)))
    yield ""
    for line in (*remarks(comparison), *LEGEND):
        first, *more = wrap(line, WIDTH_CHARACTERS - 4, break_long_words=False, break_on_hyphens=False)
        yield f"  {first}"
        yield from (f"    {rest}" for rest in more)
    if paths:
        names = ", ".join(path.name for path in paths)
        yield from ("", f"  wrote     {paths[0].parent}/: {names}")
