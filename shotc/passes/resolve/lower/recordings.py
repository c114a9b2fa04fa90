"""Recorded tracks: rows of a CSV or GPX file as the motion of a target."""

from itertools import pairwise
from math import radians
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.geom.track import Track, unwrapped
from shotc.ir.origin import KeyPath
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault, NumberTable, read_table
from shotc.kinds.gpx import read_gpx  # brings an XML parser, which few missions need
from shotc.kinds.located import in_world
from shotc.passes.resolve.lower.files import Files

PLACES = (("t", "x", "y", "z"), ("t", "lat", "lon", "height"), ("t", "x", "y"), ("t", "lat", "lon"))
FACING = ((), ("heading",), ("heading_deg",))
LAYOUTS = tuple((*place, *facing) for place in PLACES for facing in FACING)
HEIGHTS = {"z", "height", "ele"}


class Recording(NamedTuple):
    """A recorded track.

    lines : line in the file of each row
    level : whether its rows have no heights, so that all of them are at z = 0
    """

    track: Track
    lines: tuple[int, ...]
    level: bool = False


def read_recording(file: str, files: Files, path: KeyPath) -> Recording | Diagnostic:
    """Return the motion in a file that the mission names at ``path``, or its fault.

    The times of a CSV file count from the start of the mission, those of a GPX file from its first point.
    """
    data = files.read(file, path)
    if isinstance(data, Diagnostic):
        return data
    table = _timed_gpx(data) if file.lower().endswith(".gpx") else read_table(data, LAYOUTS)
    wrong = table if isinstance(table, FileFault) else _fault(table)
    if wrong is not None:
        return bad_file(files.origins, path, file, wrong)
    assert isinstance(table, NumberTable)
    points = in_world(table, file, files.origin, files.origins, path)
    if isinstance(points, Diagnostic):
        return points
    times = _column(table, "t")
    track = Track(times, tuple(points), _headings(table), since=times[0], until=times[-1])
    return Recording(track, table.lines, level=not HEIGHTS & set(table.columns))


def _headings(table: NumberTable) -> tuple[float, ...]:
    if "heading_deg" in table.columns:
        return unwrapped([yaw_of(radians(h)) for h in _column(table, "heading_deg")])
    if "heading" in table.columns:
        return unwrapped([yaw_of(h) for h in _column(table, "heading")])
    return ()


def _column(table: NumberTable, name: str) -> tuple[float, ...]:
    i = table.columns.index(name)
    return tuple(row[i] for row in table.rows)


def _fault(table: NumberTable) -> FileFault | None:
    """Return the fault of too few rows, or of the first row not later than the one before, or None."""
    if len(table.rows) < 2:
        line = table.lines[0] if table.lines else None
        count = "one row" if table.rows else "no rows"
        message = f"the file has {count}, and a track needs two rows or more"
        return FileFault(message, line, "add rows, or give the target a place with `at`")
    for i, (before, after) in enumerate(pairwise(_column(table, "t"))):
        if after > before:
            continue
        earlier, line = table.lines[i], table.lines[i + 1]
        if after == before:
            message = f"its times do not rise: line {line} repeats the {after:.10g} s of line {earlier}"
            return FileFault(message, line, "keep one of the two rows, or correct the time of one")
        message = f"its times do not rise: line {line} says {after:.10g} s, line {earlier} {before:.10g} s"
        return FileFault(message, line, "correct the time, or sort the rows by time")
    return None


def _timed_gpx(data: bytes) -> NumberTable | FileFault:
    return read_gpx(data, timed=True)
