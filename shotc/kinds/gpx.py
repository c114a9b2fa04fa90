"""GPX files: XML to rows of numbers, with the line of the first fault."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, NamedTuple

from shotc.kinds.files import MOST_ROWS, FileFault, NumberTable, not_xml, row_of
from shotc.source.xml import StopParsing, feed

PLACE = ("lat", "lon", "ele")


def read_gpx(data: bytes, *, timed: bool = False) -> NumberTable | FileFault:
    """Read the track points of a GPX file, or its route points if it has no track: lat, lon, ele.

    A document type declaration is refused, because entities could grow without bound.
    timed : also read the times, as a first column t: seconds since the first point. Such a track may have no
        elevations at all; then it has no column ele.
    """
    reader = _Gpx(timed)
    wrong = feed(data, reader)
    if wrong is not None:
        return not_xml(wrong)
    if reader.fault is not None:
        return reader.fault
    points = reader.points["trkpt"] or reader.points["rtept"]
    if not points:
        return FileFault("the file has no track points", help="export a track (`trkpt`) or a route (`rtept`)")
    lines = tuple(point.line for point in points)
    level = [point.line for point in points if len(point.place) < len(PLACE)]
    if level and not (timed and len(level) == len(points)):
        return FileFault("a point has no elevation", level[0], "give every point an `<ele>`")
    if not timed:
        return NumberTable(PLACE, tuple(point.place for point in points), lines)
    rows = _timed(points)
    columns = ("t", *(PLACE[:2] if level else PLACE))
    return rows if isinstance(rows, FileFault) else NumberTable(columns, rows, lines)


class _Point:
    """A point of the file.

    place : lat, lon and, if present, ele; line : where it starts; time : as written, or None
    """

    __slots__ = ("line", "place", "time")

    def __init__(self, place: tuple[float, ...], line: int, time: str | None) -> None:
        self.place = place
        self.line = line
        self.time = time


def _timed(points: list[_Point]) -> tuple[tuple[float, ...], ...] | FileFault:
    """Return rows of t, lat, lon, ele; a time without a zone is UTC, by the format."""
    if all(point.time is None for point in points):
        help_ = "export it with times, or write `points` with `speed` or `times`"
        return FileFault("its points have no times", points[0].line, help_)
    rows: list[tuple[float, ...]] = []
    first: datetime | None = None
    for point in points:
        if point.time is None:
            return FileFault("a point has no time", point.line, "give every point a `<time>`")
        try:
            passed = datetime.fromisoformat(point.time)
            if passed.tzinfo is None:
                passed = passed.replace(tzinfo=UTC)
            first = first or passed
            rows.append(((passed - first).total_seconds(), *point.place))
        except (ValueError, OverflowError):
            help_ = "write it as 2024-05-01T12:00:00Z"
            return FileFault(f"`{point.time[:30]}` is not a time", point.line, help_)
    return tuple(rows)


class _OpenPoint(NamedTuple):
    """A point whose end is not read yet: its element, latitude, longitude, and line."""

    kind: str
    lat: str
    lon: str
    line: int


class _Gpx:
    """Expat's handlers; they collect points until the first fault."""

    def __init__(self, timed: bool) -> None:
        self.parser: Any = None
        self.points: dict[str, list[_Point]] = {"trkpt": [], "rtept": []}
        self.fault: FileFault | None = None
        self._wanted = {"ele", "time"} if timed else {"ele"}
        self._open: _OpenPoint | None = None
        self._texts: dict[str, str] = {}
        self._depth = 0  # of elements inside the point; an extension may have its own time
        self._reading = ""

    def doctype(self, *_: Any) -> None:
        self._stop("the file has a document type declaration", "remove the `<!DOCTYPE ...>`")

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.rsplit(":", 1)[-1]
        if name in self.points:
            lat, lon = attributes.get("lat", ""), attributes.get("lon", "")
            self._open = _OpenPoint(name, lat, lon, self.parser.CurrentLineNumber)
            self._texts, self._depth, self._reading = {}, 0, ""
            return
        self._depth += 1
        self._reading = name if name in self._wanted and self._open and self._depth == 1 else ""
        if self._reading:
            self._texts[name] = ""

    def text(self, data: str) -> None:
        if self._reading:
            self._texts[self._reading] += data

    def end(self, tag: str) -> None:
        name = tag.rsplit(":", 1)[-1]
        self._reading = ""
        self._depth -= 1
        if self._open is None or name != self._open.kind:
            return
        kind, lat, lon, line = self._open
        self._open = None
        ele = (self._texts["ele"].strip(),) if "ele" in self._texts else ()
        row = row_of(line, (lat, lon, *ele), PLACE[: 2 + len(ele)])
        if isinstance(row, FileFault):
            self._stop(row.message, row.help, line)
        else:
            time = self._texts["time"].strip() if "time" in self._texts else None
            self.points[kind].append(_Point(row, line, time))
        if len(self.points[kind]) > MOST_ROWS:
            self._stop(f"the file has more than {MOST_ROWS} points", "thin the track")

    def _stop(self, message: str, help: str, line: int | None = None) -> None:
        self.fault = FileFault(message, line or self.parser.CurrentLineNumber, help)
        raise StopParsing
