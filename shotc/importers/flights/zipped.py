"""Read zipped CSV: an archive with one table per drone, in the format of Skybrush.

A row is `Time [msec],x [m],y [m],z [m]`, optionally with `Red,Green,Blue`. A header line is optional. x, y
and z are read as East, North and Up of the mission's origin, as in the files that shotc writes.
"""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.importers.archive import ArchiveFault, members
from shotc.importers.cameras.places import number
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.endings import LARGEST_CLOCKED_BYTES
from shotc.importers.flights.points import BROKEN, FOREIGN, UNREADABLE, Unread, refuse
from shotc.importers.flights.rows import MOST_ROWS, PLACE, DroneRows, check_order, numbers_of
from shotc.importers.notes import plain
from shotc.importers.xml_tree import Node, readable_text

HEADS = ("time_msec", "time [msec]")
"""Start of the optional header line, in lower case."""
EXAMPLE = "Time [msec],x [m],y [m],z [m],Red,Green,Blue"
COLORS = ("red", "green", "blue")
BRIGHTEST_LEVEL = 255
EARLY_S, LANDED_M = 1.0, 0.5
"""A table that ends more than EARLY_S seconds before the longest one must end on the ground: at most LANDED_M
metres above its start."""
MOST_DRONES = 20_000
SPLIT = "cut the show in two, each with a fleet of its own"
WHOLE = Node("", 1, 1, wide=1)


class UnreadMember(Unread):
    """Raised by a reader that refuses one table of an archive. ``text``: the text of the table."""

    def __init__(self, refused: Refused, member: str, text: str) -> None:
        super().__init__(refused)
        self.member, self.text = member, text


class _Table(NamedTuple):
    name: str
    text: str


def tables(data: bytes) -> tuple[DroneRows, ...]:
    """Return the rows of each drone, in the order of the archive; raise Unread for a bad table."""
    by_drone: dict[str, DroneRows] = {}
    left = MOST_ROWS
    for member in members(data, _is_table, LARGEST_CLOCKED_BYTES):
        if isinstance(member, ArchiveFault):
            refuse(UNREADABLE, member.message, WHOLE, member.help)
        if len(by_drone) == MOST_DRONES:
            refuse(UNREADABLE, f"it has more than {MOST_DRONES} tables, and no more are read", WHOLE, SPLIT)
        table = _Table(plain(member[0], 80), readable_text(member[1]))
        try:
            rows = _rows(table, left, by_drone)
        except Unread as stopped:
            raise UnreadMember(stopped.refused, table.name, table.text) from None
        left -= len(rows.lines)
        by_drone[rows.drone] = rows
    if not by_drone:
        help_ = f"give a ZIP with a CSV file for each drone, whose rows are `{EXAMPLE}`"
        refuse(FOREIGN, "it is an archive without a CSV file", WHOLE, help_)
    _all_land(tuple(by_drone.values()))
    return tuple(by_drone.values())


def _is_table(name: str) -> bool:
    # Archives from macOS have a hidden copy of each file.
    return name.lower().endswith(".csv") and not name.startswith("__MACOSX/")


def _rows(table: _Table, left: int, others: dict[str, DroneRows]) -> DroneRows:
    """Return the rows of one table.

    left   : number of rows that may still be read
    others : the tables read before, by the names of drones
    """
    drone = PurePosixPath(table.name).stem
    lines = table.text.splitlines()
    if drone in others:
        twin = others[drone].member
        message = f"`{twin}` is the flight of a drone `{drone}`, too"
        refuse(BROKEN, message, WHOLE, "give each drone one file, with a name of its own")
    if not lines or "\0" in table.text[:1000]:
        refuse(UNREADABLE, "it is no text" if lines else "it is empty", WHOLE, f"give it rows of `{EXAMPLE}`")
    first = _cells(lines[0])[0].lower()
    head = first.startswith(HEADS)
    if not head and number(first) is None:
        wide = Node("", 1, 1, wide=len(lines[0]) or 1)
        refuse(FOREIGN, "its first line is no row, and names no columns", wide, f"begin with `{EXAMPLE}`")
    numbered = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not (head and i == 1)]
    if not numbered:
        refuse(BROKEN, "it has no row", WHOLE, f"give it rows of `{EXAMPLE}`")
    if len(numbered) > left:
        refuse(UNREADABLE, f"the archive has more than {MOST_ROWS} rows, and no more are read", WHOLE, SPLIT)
    return _numbered(drone, table.name, numbered)


def _numbered(drone: str, member: str, lines: list[tuple[int, str]]) -> DroneRows:
    numbers, body = [i for i, _ in lines], [line for _, line in lines]
    shines = len(_cells(body[0])) > 4
    columns = {"time": 0, **{name: k for k, name in enumerate(PLACE, 1)}}
    if shines:
        columns |= {name: k for k, name in enumerate(COLORS, 4)}
    values = numbers_of(body, numbers, list(columns.values()))
    lights = values[:, 4:] if shines else None
    times, places = values[:, 0] / 1e3, values[:, 1:4]
    rows = DroneRows(drone, tuple(numbers), times, places, None, columns, tuple(body), member, lights)
    check_order(rows)
    if shines:
        _check_colors(rows, values[:, 4:])
    return rows


def _cells(line: str) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(",")]


def _check_colors(rows: DroneRows, colors: NDArray[np.float64]) -> None:
    """Refuse colours that are not integers from 0 to 255."""
    wrong = (colors < 0) | (colors > BRIGHTEST_LEVEL) | (colors != np.round(colors))
    if wrong.any():
        i, k = (int(index[0]) for index in np.nonzero(wrong))
        message = (
            f"{COLORS[k]} is {colors[i, k]:g}, and a light is a whole number from 0 to {BRIGHTEST_LEVEL}"
        )
        refuse(BROKEN, message, rows.node(i), f"write a whole number from 0 to {BRIGHTEST_LEVEL}")


def _all_land(tables: tuple[DroneRows, ...]) -> None:
    """Refuse a show in which the table of a drone ends in the air before the others end."""
    longest = max(tables, key=lambda rows: float(rows.time[-1]))
    end = float(longest.time[-1])
    for rows in tables:
        above = float(rows.place[-1, 2] - rows.place[0, 2])
        if rows.time[-1] < end - EARLY_S and above > LANDED_M:
            last = rows.node(len(rows.lines) - 1)
            message = (
                f"it ends at {rows.time[-1]:g} s, {above:.1f} m over where it begins,"
                f" and `{longest.member}` at {end:g} s"
            )
            help_ = "let all tables end at the same time, or where their drones have landed"
            raise UnreadMember(Refused(BROKEN, message, last, help_), rows.member, rows.text)
