"""The text of a rehearsal's results for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from shotc.cli.console import table
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.summary import summary


def text(done: Rehearsed, paths: Sequence[Path]) -> str:
    """Return the report.

    paths : the files that were written
    """
    return "\n".join(_lines(done, paths))


def _lines(done: Rehearsed, paths: Sequence[Path]) -> Iterator[str]:
    described = summary(done)
    yield f"{done.mission.name}: {described.flown}"
    for rows in described.tables:
        yield ""
        yield from (f"  {line}" for line in table(rows))
    yield ""
    yield from (f"  asked     {line}" for line in described.requirements)
    yield f"  worst     run {done.worst.number}"
    yield from (f"  note      {line}" for line in described.notes)
    if paths:
        yield from ("", f"  wrote     {paths[0].parent}/: {', '.join(path.name for path in paths)}")
