"""STL files: lists of triangles, binary or text."""

from __future__ import annotations

import re

import numpy as np

from shotc.kinds.models.parts import NodePart, part

HEAD_BYTES, RECORD_BYTES = 84, 50
"""Bytes before the first triangle, and of each."""
_CORNER = re.compile(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)\s*$", re.MULTILINE)


def read_stl(data: bytes) -> list[NodePart]:
    """Return the single part of a file, none for an empty file; raise ValueError if it is no STL."""
    if not data:
        return []
    count = int.from_bytes(data[80:HEAD_BYTES], "little")
    whole = HEAD_BYTES + RECORD_BYTES * count == len(data)
    if not whole and data[:300].lstrip()[:5].lower() == b"solid":
        corners = np.array(_CORNER.findall(data), dtype=np.float64).reshape(-1, 3)
        corners = corners[: 3 * (len(corners) // 3)]
    elif len(data) >= HEAD_BYTES and HEAD_BYTES + RECORD_BYTES * count <= len(data):
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
        corners = np.frombuffer(data, kind, count, HEAD_BYTES)["corners"].reshape(-1, 3).astype(np.float64)
    else:
        raise ValueError(f"its header promises {count} triangles in {len(data)} bytes")
    return [part("", corners, np.arange(len(corners)).reshape(-1, 3))]
