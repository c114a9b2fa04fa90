"""Tables and GPX tracks that a mission names: text to rows of numbers, with the line of every fault."""

from collections.abc import Sequence
from math import isfinite
from typing import Any, NamedTuple
from xml.parsers import expat

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
        numbers = _row(number, row, columns)
        if isinstance(numbers, FileFault):
            return numbers
        rows.append(numbers)
    return Table(columns, tuple(rows))


def read_gpx(data: bytes) -> Table | FileFault:
    """Read the track points of a GPX file, or its route points if it has no track: lat, lon, ele.

    A document type declaration is refused, for entities could grow without bound.
    """
    if len(data) > LARGEST:
        return _too_large(data)
    reader = _Gpx()
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = reader.doctype
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text
    reader.parser = parser
    try:
        parser.Parse(data, True)
    except _Stop:
        assert reader.fault is not None
        return reader.fault
    except expat.ExpatError as error:
        return FileFault(f"not well-formed XML: {expat.ErrorString(error.code)}", error.lineno)
    points = reader.points["trkpt"] or reader.points["rtept"]
    if not points:
        return FileFault("the file has no track points", help="export a track (`trkpt`) or a route (`rtept`)")
    return Table(("lat", "lon", "ele"), tuple(points))


class _Stop(Exception):
    """The reader has found its first fault and leaves expat."""


class _Gpx:
    """Expat's handlers; collects points until the first fault."""

    def __init__(self) -> None:
        self.parser: Any = None
        self.points: dict[str, list[tuple[float, ...]]] = {"trkpt": [], "rtept": []}
        self.fault: FileFault | None = None
        self._open: tuple[str, str, str, int] | None = None
        self._ele: str | None = None
        self._reading = False

    def doctype(self, *_: Any) -> None:
        self._stop("the file has a document type declaration", "remove the `<!DOCTYPE ...>`")

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.rsplit(":", 1)[-1]
        if name in self.points:
            lat, lon = attributes.get("lat", ""), attributes.get("lon", "")
            self._open, self._ele = (name, lat, lon, self.parser.CurrentLineNumber), None
        self._reading = name == "ele" and self._open is not None
        if self._reading:
            self._ele = ""

    def text(self, data: str) -> None:
        if self._reading:
            self._ele = (self._ele or "") + data

    def end(self, tag: str) -> None:
        name = tag.rsplit(":", 1)[-1]
        self._reading = False
        if self._open is None or name != self._open[0]:
            return
        kind, lat, lon, line = self._open
        self._open = None
        if self._ele is None:
            self._stop("a point has no elevation", "give every point an `<ele>`", line)
        row = _row(line, (lat, lon, (self._ele or "").strip()), ("lat", "lon", "ele"))
        if isinstance(row, FileFault):
            self._stop(row.message, row.help, line)
        else:
            self.points[kind].append(row)
        if len(self.points[kind]) > MOST_ROWS:
            self._stop(f"the file has more than {MOST_ROWS} points", "thin the track")

    def _stop(self, message: str, help: str, line: int | None = None) -> None:
        self.fault = FileFault(message, line or self.parser.CurrentLineNumber, help)
        raise _Stop


def _text(data: bytes) -> str | FileFault:
    if len(data) > LARGEST:
        return _too_large(data)
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


def _too_large(data: bytes) -> FileFault:
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


def _row(line: int, cells: tuple[str, ...], columns: tuple[str, ...]) -> tuple[float, ...] | FileFault:
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
