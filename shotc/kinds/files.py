"""Tables that a mission names: text to rows of numbers, with the line of every fault."""

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

LARGEST = 4_000_000  # bytes
MOST_ROWS = 50_000
FARTHEST = 1e7  # metres or seconds; beyond it no mission is meant
BOUNDS = {"lat": 90.0, "lon": 180.0}


class FileFault(NamedTuple):
    """What is wrong with a file; line from 1, or None where no single line is to blame."""

    message: str
    line: int | None = None
    help: str = ""


class Table(NamedTuple):
    """Rows of finite numbers under the names of their columns."""

    columns: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]


def read_table(data: bytes, layouts: Sequence[tuple[str, ...]]) -> Table | FileFault:
    """Read a CSV file whose header is one of ``layouts``.

    A file without a header is read in the order of the first layout that has as many columns.
    Empty lines and lines that begin with # are passed over.
    """
    text = _text(data)
    if isinstance(text, FileFault):
        return text
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and line[0] != "#"]
    if not lines:
        return FileFault("the file is empty", help=f"write a header `{','.join(layouts[0])}` and its rows")
    if len(lines) > MOST_ROWS:
        return FileFault(f"the file has {len(lines)} rows; at most {MOST_ROWS} are read")
    cells = [(n, tuple(c.strip() for c in line.split(","))) for n, line in lines]
    foreign = _no_table(*lines[0])
    if foreign is not None:
        return foreign
    columns = _columns(*cells[0], layouts)
    if isinstance(columns, FileFault):
        return columns
    body = cells if _is_number(cells[0][1][0]) else cells[1:]
    rows: list[tuple[float, ...]] = []
    for number, row in body:
        numbers = row_of(number, row, columns)
        if isinstance(numbers, FileFault):
            return numbers
        rows.append(numbers)
    return Table(columns, tuple(rows))


def _text(data: bytes) -> str | FileFault:
    if len(data) > LARGEST:
        return too_large(data)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return FileFault("the file is not UTF-8 text", data[: error.start].count(b"\n") + 1)
    if "\0" in text:
        return FileFault("the file holds a NUL byte", text[: text.index("\0")].count("\n") + 1)
    return text


def _no_table(line: int, first: str) -> FileFault | None:
    """Tell a file of another format by its first line."""
    if first.lstrip().startswith("<"):
        return FileFault("the file is XML, no table", line, "export it as GPX, with `.gpx` as its ending")
    for mark, name in ((";", "semicolons"), ("\t", "tabs")):
        if mark in first:
            message = f"its columns are separated by {name}"
            return FileFault(message, line, "separate them with commas; decimals have a point")
    return None


def too_large(data: bytes) -> FileFault:
    """Return the fault of a file of more than ``LARGEST`` bytes."""
    return FileFault(f"the file is {len(data) / 1e6:.1f} MB; at most {LARGEST / 1e6:.0f} MB are read")


def _columns(
    line: int, first: tuple[str, ...], layouts: Sequence[tuple[str, ...]]
) -> tuple[str, ...] | FileFault:
    wanted = " or ".join(f"`{','.join(layout)}`" for layout in layouts)
    if _is_number(first[0]):
        fitting = [layout for layout in layouts if len(layout) == len(first)]
        if not fitting:
            return FileFault(f"the first row has {len(first)} columns", line, f"write {wanted}")
        return fitting[0]
    header = tuple(c.lower() for c in first)
    if any(sorted(layout) == sorted(header) for layout in layouts):
        return header
    return FileFault(f"the header `{','.join(first)[:60]}` names other columns", line, f"write {wanted}")


def row_of(line: int, cells: tuple[str, ...], columns: tuple[str, ...]) -> tuple[float, ...] | FileFault:
    """Return the numbers of one row under its columns, or what is wrong with it; line from 1."""
    if len(cells) != len(columns):
        return FileFault(f"the row has {len(cells)} columns, not {len(columns)}", line)
    for cell, column in zip(cells, columns, strict=True):
        if not _is_number(cell):
            return FileFault(f"`{cell[:30]}` is not a number for `{column}`", line)
        if not isfinite(float(cell)) or abs(float(cell)) > BOUNDS.get(column, FARTHEST):
            return FileFault(f"`{cell[:30]}` is out of bounds for `{column}`", line)
    return tuple(float(cell) for cell in cells)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell
