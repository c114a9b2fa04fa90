"""The tracks of moving targets: their files can be read, and their times rise."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from shotc.diag.model import Diagnostic
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault, Table, read_table
from shotc.spec.mission import MissionSpec

LAYOUTS = (("t", "x", "y", "z"), ("t", "x", "y", "z", "heading"))


def check_tracks(
    spec: MissionSpec, origins: OriginMap, read: Callable[[str, KeyPath], bytes | Diagnostic]
) -> list[Diagnostic]:
    """Return what is wrong with the files of all tracks."""
    faults: list[Diagnostic] = []
    for name, target in spec.targets.items():
        if target.track is None or target.track.file is None:
            continue
        path, file = ("targets", name, "track", "file"), target.track.file
        data = read(file, path)
        if isinstance(data, Diagnostic):
            faults.append(data)
            continue
        table = read_table(data, LAYOUTS)
        wrong = table if isinstance(table, FileFault) else _track_fault(table)
        if wrong is not None:
            faults.append(bad_file(origins, path, file, wrong))
    return faults


def _track_fault(table: Table) -> FileFault | None:
    if len(table.rows) < 2:
        return FileFault("a track needs two rows or more", None, "or give the target a place with `at`")
    clock = table.columns.index("t")
    times = [row[clock] for row in table.rows]
    for before, after in pairwise(times):
        if after <= before:
            return FileFault(f"its times do not rise: {after:g} s comes after {before:g} s", None, "sort it")
    return None
