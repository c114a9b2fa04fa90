"""GPX tracks that a mission names: XML to rows of numbers, with the line of the first fault."""

from __future__ import annotations

from typing import Any
from xml.parsers import expat

from shotc.kinds.files import LARGEST, MOST_ROWS, FileFault, Table, row_of, too_large


def read_gpx(data: bytes) -> Table | FileFault:
    """Read the track points of a GPX file, or its route points if it has no track: lat, lon, ele.

    A document type declaration is refused, for entities could grow without bound.
    """
    if len(data) > LARGEST:
        return too_large(data)
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
        row = row_of(line, (lat, lon, (self._ele or "").strip()), ("lat", "lon", "ele"))
        if isinstance(row, FileFault):
            self._stop(row.message, row.help, line)
        else:
            self.points[kind].append(row)
        if len(self.points[kind]) > MOST_ROWS:
            self._stop(f"the file has more than {MOST_ROWS} points", "thin the track")

    def _stop(self, message: str, help: str, line: int | None = None) -> None:
        self.fault = FileFault(message, line or self.parser.CurrentLineNumber, help)
        raise _Stop
