"""Notes about outputs of an earlier run in a folder: somebody could fly them by mistake."""

from __future__ import annotations

from pathlib import Path

from shotc.cli import console
from shotc.output import earlier, left_over


def warn_of_earlier(folder: Path) -> None:
    """Print a note if a folder holds outputs of an earlier run. Call it after a run that wrote none."""
    files = earlier(folder)
    if files is None:
        return
    whose = "" if files.mission is None else f" of mission `{files.mission}`"
    console.complain(
        f"note: {folder}/ still holds the outputs of an earlier run{whose}, not of this one: "
        f"{', '.join(files.files)}"
    )


def print_left_over(folder: Path, written: set[str]) -> None:
    """Print the names of earlier outputs that this run has not replaced: they do not belong to this plan."""
    left = left_over(folder, written)
    if left:
        names = ", ".join(left)
        console.complain(f"note: {folder}/ also holds outputs of an earlier run, not of this plan: {names}")
