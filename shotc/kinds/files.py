"""Tables in files: text to rows of numbers, with the line of every fault."""

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:  # few missions name XML
    from shotc.source.xml import NotXml

MOST_ROWS = 50_000
LARGEST_VALUE = 1e7  # metres or seconds; larger values are mistakes
BOUNDS = {"lat": 90.0, "lon": 180.0, "heading": 6.3, "heading_deg": 360.0}  # 6.3: a turn, rounded up
UNITS = {
    "t": "`t` is in seconds from the start of the mission",
    "lat": "`lat` is in degrees, negative in the south",
    "lon": "`lon` is in degrees, negative in the west",
    "heading": "`heading` is in rad; name the column `heading_deg` if it is in degrees",
    "heading_deg": "`heading_deg` is in degrees, clockwise from north",
}
METRES, DEGREES = {"x", "y", "z"}, {"lat", "lon", "height"}


class FileFault(NamedTuple):
    """A fault of a file; line : from 1, or None if it is not in a single line."""

    message: str
    line: int | None = None
    help: str = ""


class NumberTable(NamedTuple):
    """Rows of finite numbers with the names of columns; lines : of the file, one for each row."""

    columns: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    lines: tuple[int, ...]


def read_table(
    data: bytes, layouts: Sequence[tuple[str, ...]], most: int = MOST_ROWS
) -> NumberTable | FileFault:
    """Read a CSV file whose header is one of ``layouts``.

    A file without a header has the columns of the first layout with the same number of columns. Empty lines
    and lines that start with # are ignored. most : largest number of rows
    """
    text = _text(data)
    if isinstance(text, FileFault):
        return text
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and line[0] != "#"]
    if not lines:
        return FileFault("the file is empty", help=f"write a header `{','.join(layouts[0])}` and its rows")
    foreign = _no_table(*lines[0])
    if foreign is not None:
        return foreign
    number, first = lines[0]
    cells = tuple(c.strip() for c in first.split(","))
    columns = _columns(number, cells, layouts)
    if isinstance(columns, FileFault):
        return columns
    body = lines if _is_number(cells[0]) else lines[1:]
    if len(body) > most:
        return FileFault(f"the file has {len(body)} rows; at most {most} are read", help="thin it")
    rows = _rows(body, columns)
    return rows if isinstance(rows, FileFault) else NumberTable(columns, rows, tuple(n for n, _ in body))


def _rows(
    body: Sequence[tuple[int, str]], columns: tuple[str, ...]
) -> tuple[tuple[float, ...], ...] | FileFault:
    """Return the numbers of every row; ``row_of`` checks a row only if the fast conversion fails."""
    bounds = [BOUNDS.get(column, LARGEST_VALUE) for column in columns]
    rows: list[tuple[float, ...]] = []
    for number, line in body:
        cells = line.split(",")
        try:
            row = tuple(map(float, cells))
        except ValueError:
            row = ()
        plain = len(row) == len(bounds) and "_" not in line
        if not plain or not all(-most <= value <= most for value, most in zip(row, bounds, strict=True)):
            checked = row_of(number, tuple(c.strip() for c in cells), columns)
            if isinstance(checked, FileFault):
                return checked
            row = checked
        rows.append(row)
    return tuple(rows)


def utf8_text(data: bytes, help_: str = "") -> str | FileFault:
    """Return the text of a file without a byte order mark, or a fault at the line that is no UTF-8."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return FileFault("the file is not UTF-8 text", data[: error.start].count(b"\n") + 1, help_)


def finite(word: str) -> float | None:
    """Return a finite number, or None for other text, also for numbers in Python's notation with `_`."""
    try:
        value = float(word)
    except ValueError:
        return None
    return value if isfinite(value) and "_" not in word else None


def _text(data: bytes) -> str | FileFault:
    text = utf8_text(data)
    if isinstance(text, str) and "\0" in text:
        return FileFault("the file holds a NUL byte", text[: text.index("\0")].count("\n") + 1)
    return text


def _no_table(line: int, first: str) -> FileFault | None:
    """Return a fault if the first line shows another format."""
    if first.lstrip().startswith("<"):
        return FileFault("the file is XML, no table", line, "export it as GPX, with `.gpx` as its ending")
    for mark, name in ((";", "semicolons"), ("\t", "tabs")):
        if mark in first:
            message = f"its columns are separated by {name}"
            return FileFault(message, line, "separate them with commas; decimals have a point")
    return None


def not_xml(wrong: "NotXml") -> FileFault:
    """Return the fault of a file that is no XML."""
    if wrong.encoding:
        return FileFault("the XML is in an encoding that cannot be read", 1, "save it as UTF-8")
    return FileFault(f"not well-formed XML: {wrong.reason}", wrong.line)


def _columns(
    line: int, first: tuple[str, ...], layouts: Sequence[tuple[str, ...]]
) -> tuple[str, ...] | FileFault:
    expected = " or ".join(f"`{','.join(layout)}`" for layout in layouts)
    if _is_number(first[0]):
        fitting = [layout for layout in layouts if len(layout) == len(first)]
        if not fitting:
            return FileFault(f"the first row has {len(first)} columns", line, f"write {expected}")
        return fitting[0]
    header = tuple(c.lower() for c in first)
    if any(sorted(layout) == sorted(header) for layout in layouts):
        return header
    named = f"the header `{','.join(first)[:60]}` names"
    twice = next((c for c in header if header.count(c) > 1), None)
    if twice:
        return FileFault(f"{named} `{twice[:30]}` twice", line, f"write {expected}")
    if METRES & set(header) and DEGREES & set(header):
        return FileFault(f"{named} both metres and degrees", line, f"write {expected}")
    return FileFault(f"{named} other columns", line, f"write {expected}")


def row_of(line: int, cells: tuple[str, ...], columns: tuple[str, ...]) -> tuple[float, ...] | FileFault:
    """Return the numbers of one row, or its fault; line : from 1."""
    if len(cells) != len(columns):
        help_ = f"every row has the columns {','.join(columns)}; decimals have a point"
        return FileFault(
            f"the row has {len(cells)} column{'s' * (len(cells) != 1)}, not {len(columns)}", line, help_
        )
    for cell, column in zip(cells, columns, strict=True):
        unit = UNITS.get(column, f"`{column}` is in metres")
        if not _is_number(cell):
            return FileFault(f"`{cell[:30]}` is not a number for `{column}`", line, f"{unit}, without a unit")
        if not isfinite(float(cell)) or abs(float(cell)) > BOUNDS.get(column, LARGEST_VALUE):
            return FileFault(f"`{cell[:30]}` is out of bounds for `{column}`", line, unit)
    return tuple(float(cell) for cell in cells)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell
