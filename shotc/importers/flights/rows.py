"""Read tables of trajectories: a row for each drone and time, with the columns of shotc's ``trajectory.csv``.

Positions are metres East, North and Up of the mission's origin. The names of the columns give their units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from shotc.importers.cameras.places import LARGEST_COORDINATE_M, number
from shotc.importers.flights.points import BROKEN, FOREIGN, UNREADABLE, refuse
from shotc.importers.notes import plain
from shotc.importers.words import cut_into
from shotc.importers.xml_tree import Node

Array = NDArray[np.float64]

TIME, DRONE, PHASE, SHOT = "t_s", "drone", "phase", "shot"
PLACE = ("x_m", "y_m", "z_m")
VELOCITY = ("vx_m_s", "vy_m_s", "vz_m_s")
ACCELERATION = ("ax_m_s2", "ay_m_s2", "az_m_s2")
BODY = ("body_yaw_rad",)
CAMERA = ("cam_yaw_rad", "cam_pitch_rad", "hfov_rad")
WANTED = (TIME, DRONE, *PLACE, *VELOCITY)
EXAMPLE = ",".join(WANTED)
MOST_ROWS = 5_000_000
NUMBER = "write a number there, with a point for decimals"
ROWS = f"give each drone two rows or more such as `0.0,cam1,0,0,0,0,0,0` under `{EXAMPLE}`"
BEGIN = f"begin it with a line such as `{EXAMPLE}`; velocities and `{DRONE}` may be left out"
LATER = "let the times of each drone rise, or leave the row out"
LONGEST_S = 86_400.0
"""Longest flight, seconds."""
SHORTEST_S = 1e-4
"""Least time between two rows of a drone, seconds."""


@dataclass(frozen=True, slots=True, eq=False)
class DroneRows:
    """The rows of one drone, in order of time.

    drone    : its name, empty if the table has no such column
    numbers  : the line numbers of its rows, from 1
    time     : seconds, shape (N,)
    place    : metres, shape (N, 3)
    velocity : m/s, shape (N, 3), or None
    columns  : index of each column in a line
    lines    : the rows as text
    member   : the archive's file that contains them, empty for a file without an archive
    colors   : red, green and blue of its light from 0 to 255, shape (N, 3), or None
    """

    drone: str
    numbers: tuple[int, ...]
    time: Array
    place: Array
    velocity: Array | None
    columns: dict[str, int]
    lines: tuple[str, ...]
    member: str = ""
    colors: Array | None = None

    @property
    def text(self) -> str:
        """Return the rows at their line numbers in the file; lines of other drones are empty."""
        whole = [""] * self.numbers[-1]
        for place, line in zip(self.numbers, self.lines, strict=True):
            whole[place - 1] = line
        return "\n".join(whole)

    def node(self, index: int) -> Node:
        """Return the place of a row in the file."""
        return Node("", self.numbers[index], 1, wide=max(1, len(self.lines[index])))

    def texts(self, column: str) -> list[str] | None:
        """Return the cells of a column, None if there is no such column."""
        k = self.columns.get(column)
        return None if k is None else [_cell(line, k) for line in self.lines]

    def values(self, *names: str) -> Array | None:
        """Return columns as numbers, shape (N, k); None if one is absent, or empty in all rows."""
        columns = [self.texts(name) for name in names]
        if any(column is None or not any(column) for column in columns):
            return None
        out = np.empty((len(self.lines), len(names)))
        for k, cells in enumerate(columns):
            for i, text in enumerate(cells or ()):
                value = number(text)
                if value is None:
                    refuse(
                        BROKEN,
                        f"`{names[k]}` is `{plain(text, 20)}`, which is no number",
                        self.node(i),
                        NUMBER,
                    )
                out[i, k] = value
        return out


def _cell(line: str, k: int) -> str:
    parts = line.split(",", k + 1)
    return parts[k].strip() if k < len(parts) else ""


def rows(text: str) -> tuple[DroneRows, ...]:
    """Return the rows of each drone, drones in the order of their first rows."""
    lines = text.splitlines()
    start = Node("", 1, 1, wide=max(1, len(lines[0]) if lines else 1))
    if not lines or "\0" in text[:1000]:
        refuse(UNREADABLE, "it is no text" if lines else "it is empty", start, BEGIN)
    heads = [head.strip().strip('"') for head in lines[0].split(",")]
    columns = {head: k for k, head in reversed(list(enumerate(heads)))}
    lacking = [name for name in (TIME, *PLACE) if name not in columns]
    if lacking:
        names = ", ".join(f"`{name}`" for name in lacking)
        refuse(FOREIGN, f"it has no column {names} in its first line", start, BEGIN)
    if len(lines) > MOST_ROWS:
        refuse(
            UNREADABLE,
            f"it has {len(lines) - 1} rows; at most {MOST_ROWS} are read",
            start,
            cut_into(MOST_ROWS, "rows"),
        )
    numbered = [(i, line) for i, line in enumerate(lines[1:], 2) if line.strip()]
    numbers, body = [i for i, _ in numbered], [line for _, line in numbered]
    moves = all(name in columns for name in VELOCITY)
    values = numbers_of(body, numbers, [columns[c] for c in (TIME, *PLACE, *(VELOCITY if moves else ()))])
    drones = [_cell(line, columns[DRONE]) for line in body] if DRONE in columns else [""] * len(body)
    tables = tuple(
        DroneRows(
            name,
            tuple(numbers[i] for i in index),
            values[index, 0],
            values[index, 1:4],
            values[index, 4:7] if moves else None,
            columns,
            tuple(body[i] for i in index),
        )
        for name, index in _of_drones(drones).items()
    )
    for each in tables:
        check_order(each)
    if not tables:
        refuse(BROKEN, "it has no row", start, ROWS)
    return tables


def _of_drones(names: Sequence[str]) -> dict[str, list[int]]:
    indices: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        indices.setdefault(name, []).append(i)
    return indices


def numbers_of(body: Sequence[str], lines: Sequence[int], columns: Sequence[int]) -> Array:
    """Return the numbers of some columns, shape (N, k). Refuse the first cell that is no number."""
    if not body:
        return np.zeros((0, len(columns)))
    try:
        values = np.loadtxt(body, delimiter=",", usecols=columns, comments=None, ndmin=2)
    except (ValueError, IndexError):
        values = None
    if values is not None and (np.abs(values) < LARGEST_COORDINATE_M).all():
        return values
    for line, text in zip(lines, body, strict=True):
        for k in columns:
            cell = _cell(text, k)
            if number(cell) is None:
                node = Node("", line, 1, wide=max(1, len(text)))
                refuse(
                    BROKEN,
                    f"column {k + 1} is `{plain(cell, 20)}`, which is no number below 1e9",
                    node,
                    NUMBER,
                )
    refuse(UNREADABLE, "its rows cannot be told apart", Node("", lines[0], 1, wide=1), ROWS)


def check_order(table: DroneRows) -> None:
    """Refuse rows that are no flight: too few rows, or times that do not rise."""
    if len(table.time) < 2:
        refuse(BROKEN, "a drone has one row, and a flight takes two", table.node(0), ROWS)
    if table.time[0] < 0.0:
        refuse(
            BROKEN,
            f"it begins at {table.time[0]:g} s, before the mission does",
            table.node(0),
            "let its times count from 0 s",
        )
    if table.time[-1] > LONGEST_S:
        last = len(table.time) - 1
        refuse(
            BROKEN,
            f"it lasts until {table.time[-1]:g} s, which is no flight",
            table.node(last),
            f"let it end by {LONGEST_S:g} s",
        )
    for i, (a, b) in enumerate(pairwise(table.time.tolist())):
        if b - a < SHORTEST_S:
            message = f"its time, {b:g} s, does not come after that before it, {a:g} s"
            refuse(BROKEN, message, table.node(i + 1), LATER)
