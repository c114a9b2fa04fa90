"""Point clouds from the bytes of XYZ, LAS and LAZ files; the latter two by laspy."""

from __future__ import annotations

import io
from importlib.util import find_spec
from typing import Any

import numpy as np

from shotc.kinds.models.parts import ModelFault, NodePart, part

KINDS = ("xyz", "las", "laz")
MOST_POINTS = 20_000_000
NOISE = (7, 18)
"""LAS classes of low and high noise: points without a real object."""
NONE = "?"
"""Replaces the separator of a line that is no row."""
RECORD_BYTES, EXTENDED_BYTES = 54, 60
"""Bytes of the header of a variable length record, and of an extended one (LAS 1.4)."""
EXTENDED_END_BYTES = 247
"""End of the number of extended records in the header of LAS 1.4, byte offset."""
COMPRESSED = b"\x80"
"""First point format of LAZ; its points start with the position of a chunk table."""
NO_TABLE = 2**64 - 1
"""Replaces that position in files that store it in their last eight bytes."""
LEAST_CHUNK = 20
"""Least bytes of a chunk, whose first point is not compressed."""
MOST_BYTES = 4_000_000_000
"""Most bytes of all points, uncompressed."""
_THIN = "thin it, or cut it to the mission"


def read_cloud(kind: str, data: bytes) -> list[NodePart] | ModelFault:
    """Return the points of a file as one part, in its own units and axes; kind : one of KINDS."""
    return _read_xyz(data) if kind == "xyz" else _read_las(data)


def _read_xyz(data: bytes) -> list[NodePart] | ModelFault:
    """Read rows whose first three columns are x, y and z; the first line may be a header."""
    if b"\0" in data[:1000]:
        return ModelFault("it is no text", "export it as PLY, or as rows of x y z")
    lines = data.decode("latin-1").splitlines()
    body = [line for line in lines if line.strip() and not line.lstrip().startswith(("#", "//"))]
    if body and _separator(body[0]) is NONE:
        body = body[1:]
    if len(body) > MOST_POINTS:
        return ModelFault(f"it has {len(body)} points; {MOST_POINTS} are the most", _THIN)
    if not body:
        return ModelFault("it holds no points", "write a row of x y z a point")
    separator = _separator(body[0])
    try:
        rows = np.loadtxt(body, delimiter=separator or None, usecols=(0, 1, 2), comments=None, ndmin=2)
        return [part("", rows)]
    except ValueError:
        number = next((i for i, line in enumerate(body) if not _is_row(line, separator)), 0)
        row = body[number]
        line = next(i for i, text in enumerate(lines, 1) if text is row)
        return ModelFault(f"`{row.strip()[:40]}` is no row of x y z", "decimals have a point", line)


def _separator(line: str) -> str:
    """Return the column separator of a row: a comma, a semicolon, or "" for white space; else NONE."""
    return next((mark for mark in ("", ",", ";") if _is_row(line, mark)), NONE)


def _is_row(line: str, separator: str) -> bool:
    words = line.split(separator or None)[:3]
    try:
        return len([float(word) for word in words]) == 3 and "_" not in "".join(words)
    except ValueError:
        return False


def _read_las(data: bytes) -> list[NodePart] | ModelFault:
    missing = next((name for name in ("laspy", "lazrs") if find_spec(name) is None), "")
    if missing:
        return ModelFault(
            f"a point cloud of this format needs {missing}, not installed here", library=missing
        )
    if data[:4] != b"LASF":
        return ModelFault("it is no LAS or LAZ file", "export it as LAZ")
    if _promised(data) > len(data):
        return ModelFault(f"its header promises more than its {len(data)} bytes", "copy it anew")
    try:
        with np.errstate(all="ignore"):
            return _points(data)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # noqa: BLE001  faults of foreign bytes; lazrs panics beside Exception
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        return ModelFault(f"laspy says: {reason or type(error).__name__}", "export it anew as LAZ")


def _promised(data: bytes) -> int:
    """Return the least size in bytes of the records that a header announces.

    The readers trust these numbers, and a wrong one would cost much time or memory.
    """

    def number(at: int, size: int) -> int:
        return int.from_bytes(data[at : at + size], "little")

    header, points = number(94, 2), number(96, 4)
    least = [points, header + RECORD_BYTES * number(100, 4)]
    if data[25:26] >= b"\x04" and header >= EXTENDED_END_BYTES:
        least.append(header + EXTENDED_BYTES * number(EXTENDED_END_BYTES - 4, 4))
    if data[104:105] >= COMPRESSED:
        table = number(points, 8)
        table = number(len(data) - 8, 8) if table == NO_TABLE else table
        least.append(max(table + 8, LEAST_CHUNK * number(table + 4, 4)))
    return max(least)


def _points(data: bytes) -> list[NodePart] | ModelFault:
    import laspy

    with laspy.open(io.BytesIO(data), laz_backend=laspy.LazBackend.Lazrs) as reader:
        count = int(reader.header.point_count)
        if count > MOST_POINTS or count * reader.header.point_format.size > MOST_BYTES:
            return ModelFault(f"it has {count} points; {MOST_POINTS} are the most", _THIN)
        if not reader.header.are_points_compressed and count * reader.header.point_format.size > len(data):
            return ModelFault(f"its header promises {count} points in {len(data)} bytes", "copy it anew")
        cloud: Any = reader.read()
    valid = ~np.isin(np.asarray(cloud.classification), NOISE)
    points = np.column_stack([np.asarray(axis)[valid] for axis in (cloud.x, cloud.y, cloud.z)])
    if not len(points) and count:
        return ModelFault(f"all of its {count} points are noise (classes 7 and 18)", "classify it anew")
    return [part("", points)]
