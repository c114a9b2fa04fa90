"""The text of a rehearsal's results for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from shotc.cli.console import table
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.summary import summary


def text(rehearsed: Rehearsed, paths: Sequence[Path]) -> str:
    """Return the report.

    paths : the files that were written
    """
    return "\n".join(_lines(rehearsed, paths))


def _lines(rehearsed: Rehearsed, paths: Sequence[Path]) -> Iterator[str]:
    described = summary(rehearsed)
    yield f"{rehearsed.mission.name}: {described.flown}"
    for rows in described.tables:
        yield ""
        yield from (f"  {line}" for line in table(rows))
    yield ""
    yield from (f"  asked     {line}" for line in described.requirements)
    yield f"  worst     run {rehearsed.worst.number}"
    yield from (f"  note      {line}" for line in described.notes)
    if paths:
        yield from ("", f"  wrote     {paths[0].parent}/: {', '.join(path.name for path in paths)}")
