"""OBJ files: lines of corners and faces, in named objects or groups."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.kinds.models.parts import Colors, NodePart, fans, part, table

_AFTER_SLASH = re.compile(r"/\S*")
LONGEST_NAME_CHARACTERS = 80


class _Lines(NamedTuple):
    """Lines of corners and faces.

    seen : number of corners before each face; begins : name of each object, and index of its first face
    """

    corners: list[str]
    faces: list[str]
    seen: list[int]
    begins: list[tuple[str, int]]


def read_obj(data: bytes) -> list[NodePart]:
    """Return the objects of a file, or its groups if it has no objects; raise ValueError if it is no OBJ."""
    lines = _lines(data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").decode("latin-1"))
    if not lines.corners:
        return []
    columns = min(len(line.split()) for line in (lines.corners[0], lines.corners[-1])) - 1
    values = table(lines.corners, tuple(range(1, 7 if columns >= 6 else 4)))
    corners = values[:, :3]
    colors = _colors(values)
    if not lines.faces:
        return [part("", corners, None, colors)]
    faces, of = _faces(lines, len(corners))
    ends = [begin for _, begin in lines.begins[1:]] + [len(lines.faces)]
    parts = []
    for (name, begin), end in zip(lines.begins, ends, strict=True):
        own = faces[(of >= begin) & (of < end)] if len(lines.begins) > 1 else faces
        if len(own):
            parts.append(_part(name, corners, own, colors))
    return parts


def _lines(text: str) -> _Lines:
    objects = re.search(r"^o\s", text, re.MULTILINE) is not None
    named = "o" if objects else "g"
    parsed = _Lines([], [], [], [("", 0)])
    for line in text.splitlines():
        word = line[:2].rstrip()
        if word == "v":
            parsed.corners.append(line)
        elif word == "f":
            parsed.faces.append(line)
            parsed.seen.append(len(parsed.corners))
        elif word == named:
            parsed.begins.append((line[2:].strip()[:LONGEST_NAME_CHARACTERS], len(parsed.faces)))
    return parsed


def _faces(lines: _Lines, count: int) -> tuple[IntArray, IntArray]:
    """Return triangles (T, 3) of corner indices, and the face line of each, (T,).

    Raises ValueError for a bad index.
    """
    slashes = any("/" in line for line in lines.faces)
    words = [(_AFTER_SLASH.sub("", line) if slashes else line).split()[1:] for line in lines.faces]
    sizes = {len(row) for row in words}
    rows: Any = (
        [np.array(row, dtype=np.int64) for row in words] if len(sizes) > 1 else np.array(words, np.int64)
    )
    seen = np.array(lines.seen)
    if len(sizes) > 1:
        rows = [np.where(row < 0, row + n, row - 1) for row, n in zip(rows, seen, strict=True)]
        lengths = np.array([max(0, len(row) - 2) for row in rows])
    else:
        rows = np.where(rows < 0, rows + seen[:, None], rows - 1)
        lengths = np.full(len(rows), max(0, rows.shape[1] - 2))
    faces = fans(rows)
    if len(faces) and not (faces.min() >= 0 and faces.max() < count):
        raise ValueError("a face names a corner that is not there")
    return faces, np.repeat(np.arange(len(words)), lengths)


def _part(name: str, corners: Array, faces: IntArray, colors: Colors | None) -> NodePart:
    """Return a part with only the corners of its own faces."""
    used, own = np.unique(faces, return_inverse=True)
    return part(name, corners[used], own.reshape(-1, 3), None if colors is None else colors[used])


def _colors(values: Array) -> Colors | None:
    """Return the colours from the columns after the coordinates, which are from 0 to 1; None without them."""
    if values.shape[1] < 6 or not ((values[:, 3:] >= 0.0) & (values[:, 3:] <= 1.0)).all():
        return None
    return np.asarray(np.rint(255.0 * values[:, 3:]), dtype=np.uint8)
