"""PLY files: a header of elements and properties, then rows as text or binary of either byte order."""

from __future__ import annotations

import struct
from typing import Any, NamedTuple

import numpy as np

from shotc.geom.bspline import IntArray
from shotc.kinds.models.parts import Colors, NodePart, fans, part, table

TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CORNERS = ("vertex_indices", "vertex_index")
MOST_LINES = 1_000  # of a header


class Property(NamedTuple):
    """A column: its type, and for a list the type of its length."""

    name: str
    type: str
    length: str = ""


class Element(NamedTuple):
    """Rows of one sort."""

    name: str
    rows: int
    properties: tuple[Property, ...]

    @property
    def plain(self) -> bool:
        """Whether no column is a list."""
        return not any(p.length for p in self.properties)

    def column(self, *names: str) -> int:
        """Return the index of the column with one of these names; raise ValueError if there is none."""
        indices = [i for i, p in enumerate(self.properties) if p.name in names]
        if not indices:
            raise ValueError(f"its element {self.name} has no property {names[0]}")
        return indices[0]


class PlyHeader(NamedTuple):
    """The content of a header; begin : offset of the first row, bytes."""

    order: str
    elements: tuple[Element, ...]
    begin: int


def read_ply(data: bytes) -> list[NodePart]:
    """Return the single part of a file; raise ValueError if it is no PLY."""
    header = _header(data)
    rows = _texts if not header.order else _bytes
    vertex: Any = None
    faces: IntArray | None = None
    colors: Colors | None = None
    at: Any = header.begin if header.order else data[header.begin :].decode("latin-1").splitlines()
    for element in header.elements:
        if element.name not in ("vertex", "face"):
            at = rows(data, at, element, header.order, ())[1]
        elif element.name == "vertex":
            picked = tuple(element.column(axis) for axis in "xyz")
            names = [p.name for p in element.properties if p.type == "u1"]
            own = all(name in names for name in ("red", "green", "blue"))
            picked += tuple(element.column(n) for n in ("red", "green", "blue")) if own else ()
            columns, at = rows(data, at, element, header.order, picked)
            vertex = np.column_stack(columns[:3])
            colors = np.column_stack(columns[3:]).astype(np.uint8) if own else None
        else:
            columns, at = rows(data, at, element, header.order, (element.column(*CORNERS),))
            faces = fans(columns[0])
    if vertex is None:
        raise ValueError("it has no element vertex")
    return [part("", vertex, faces, colors)]


def _header(data: bytes) -> PlyHeader:
    if data[:3] != b"ply":
        raise ValueError("it does not begin with `ply`")
    lines: list[str] = []
    begin = 0
    while not lines or lines[-1] != "end_header":
        end = data.find(b"\n", begin)
        if end < 0 or len(lines) > MOST_LINES:
            raise ValueError("its header does not end")
        lines.append(data[begin:end].decode("latin-1").strip())
        begin = end + 1
    order = ""
    elements: list[Element] = []
    for words in filter(None, (line.split() for line in lines[1:-1])):
        if words[0] == "format":
            order = _order(words)
        elif words[0] == "property" and elements:
            last = elements[-1]
            elements[-1] = last._replace(properties=(*last.properties, _property(words)))
        elif words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            elements.append(Element(words[1], int(words[2]), ()))
        elif words[0] not in ("comment", "obj_info"):
            raise _not_understood(words)
    promised = sum(element.rows for element in elements)
    if promised > len(data):
        raise ValueError(f"its header promises {promised} elements in {len(data)} bytes")
    return PlyHeader(order, tuple(elements), begin)


def _order(words: list[str]) -> str:
    if len(words) < 2 or words[1] not in ORDERS:
        raise _not_understood(words)
    return ORDERS[words[1]]


def _not_understood(words: list[str]) -> ValueError:
    return ValueError(f"`{' '.join(words)[:40]}` in its header is not understood")


def _property(words: list[str]) -> Property:
    if len(words) == 3 and words[1] in TYPES:
        return Property(words[2], TYPES[words[1]])
    if len(words) == 5 and words[1] == "list" and words[2] in TYPES and words[3] in TYPES:
        return Property(words[4], TYPES[words[3]], TYPES[words[2]])
    raise _not_understood(words)


_Columns = tuple[list[Any], Any]
"""The wanted columns, and the start of the next element."""


def _texts(_: bytes, lines: list[str], element: Element, order: str, picked: tuple[int, ...]) -> _Columns:
    del order
    rows, rest = lines[: element.rows], lines[element.rows :]
    if len(rows) < element.rows:
        raise ValueError("it ends too soon")
    if element.plain:
        return (list(table(rows, picked).T) if picked and rows else [np.zeros(0)] * len(picked)), rest
    if picked == (0,) and len(element.properties) == 1:
        same = _lists_as_long(rows)
        if same is not None:
            return [same], rest
    return [_lists([row.split() for row in rows], element, column) for column in picked], rest


def _lists_as_long(rows: list[str]) -> IntArray | None:
    """Return rows that are lists of the same length, (N, C); None for other rows."""
    width = len(rows[0].split()) if rows else 0
    if width < 2 or len({row.rstrip().count(" ") for row in rows}) > 1:
        return None
    try:
        numbers = np.array(" ".join(rows).split(), dtype=np.intp)
    except (ValueError, OverflowError):
        return None  # the reading row by row then finds the fault
    if len(numbers) != width * len(rows):
        return None
    rows_of_lists = numbers.reshape(-1, width)
    return rows_of_lists[:, 1:] if (rows_of_lists[:, 0] == width - 1).all() else None


def _lists(rows: list[list[str]], element: Element, column: int) -> Any:
    """Return one column of rows of words; a list has its length in front."""
    entries: list[Any] = []
    for words in rows:
        at = 0
        for p in element.properties[:column]:
            at += 1 + int(words[at]) if p.length else 1
        if not element.properties[column].length:
            entries.append(float(words[at]))
            continue
        count = int(words[at])
        own = [int(word) for word in words[at + 1 : at + 1 + count]]
        if len(own) < count or count < 0:
            raise ValueError("a row of its faces is too short")
        entries.append(own)
    return entries


def _bytes(data: bytes, at: int, element: Element, order: str, picked: tuple[int, ...]) -> _Columns:
    counts = [] if element.plain else _first_counts(data, at, element, order)
    fields: list[Any] = []
    for i, p in enumerate(element.properties):
        if p.length:
            fields += [(f"n{i}", order + p.length), (f"p{i}", order + p.type, (counts.pop(0),))]
        else:
            fields.append((f"p{i}", order + p.type))
    kind = np.dtype(fields)
    end = at + kind.itemsize * element.rows
    if not element.rows or not kind.itemsize:
        return [np.zeros(0)] * len(picked), at
    if end <= len(data):
        rows = np.frombuffer(data, kind, element.rows, at)
        lengths = [(f"n{i}", i) for i, p in enumerate(element.properties) if p.length]
        if all((rows[n] == rows[f"p{i}"].shape[1]).all() for n, i in lengths):
            return [rows[f"p{i}"] for i in picked], end
    elif element.plain:
        raise ValueError("it ends too soon")
    return _row_by_row(data, at, element, order, picked)


def _first_counts(data: bytes, at: int, element: Element, order: str) -> list[int]:
    """Return the lengths of the first row's lists; usually all rows have the same."""
    counts = []
    if element.rows:
        for p in element.properties:
            if p.length:
                counts.append(max(0, int(np.frombuffer(data, order + p.length, 1, at)[0])))
                at += np.dtype(p.length).itemsize
            at += np.dtype(p.type).itemsize * (counts[-1] if p.length else 1)
    return counts or [0] * len(element.properties)


def _row_by_row(data: bytes, at: int, element: Element, order: str, picked: tuple[int, ...]) -> _Columns:
    codes = {name: np.dtype(name).char for name in set(TYPES.values())}
    columns: list[list[Any]] = [[] for _ in picked]
    for _ in range(element.rows):
        for i, p in enumerate(element.properties):
            count = 1
            if p.length:
                (count,) = struct.unpack_from((order or "<") + codes[p.length], data, at)
                at += np.dtype(p.length).itemsize
            size = np.dtype(p.type).itemsize * int(count)
            if count < 0 or at + size > len(data):
                raise ValueError("it ends too soon")
            if i in picked:
                row = struct.unpack_from(f"{order or '<'}{int(count)}{codes[p.type]}", data, at)
                columns[picked.index(i)].append(list(row) if p.length else row[0])
            at += size
    return columns, at
