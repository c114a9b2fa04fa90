"""Notes about what an earlier run left in a folder: it could be flown for this mission."""

from __future__ import annotations

from pathlib import Path

from shotc.cli import console
from shotc.output import earlier, left_over


def warn_of_earlier(folder: Path) -> None:
    """Say that a folder holds what an earlier run wrote, and not this one."""
    files = earlier(folder)
    if files is None:
        return
    whose = "" if files.mission is None else f" of mission `{files.mission}`"
    console.complain(
        f"note: {folder}/ still holds the outputs of an earlier run{whose}, not of this one: "
        f"{', '.join(files.files)}"
    )


def tell_left_over(folder: Path, written: set[str]) -> None:
    """Name the outputs of an earlier run that this one has not replaced: they are not of this plan."""
    left = left_over(folder, written)
    if left:
        names = ", ".join(left)
        console.complain(f"note: {folder}/ also holds outputs of an earlier run, not of this plan: {names}")
