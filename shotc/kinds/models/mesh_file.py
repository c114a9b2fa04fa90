"""Meshes from the bytes of PLY, OBJ, STL and GLB files.

Our readers need only numpy. trimesh reads these files too, but takes a second to load, with scipy.
"""

from __future__ import annotations

import re
import struct

import numpy as np

from shotc.kinds.models.glb import read_glb
from shotc.kinds.models.obj import read_obj
from shotc.kinds.models.parts import ModelFault, NodePart, part
from shotc.kinds.models.ply import read_ply

MOST_CORNERS = 5_000_000
"""Most corners of a scene, with every placement of its meshes."""
FOREIGN = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, struct.error)
"""Exceptions that bytes without a valid model cause."""
STL_HEAD_BYTES, STL_RECORD_BYTES = 84, 50
"""Bytes of an STL file before the first triangle, and of each triangle."""
_STL_CORNER = re.compile(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)\s*$", re.MULTILINE)


def read_mesh(kind: str, data: bytes) -> list[NodePart] | ModelFault:
    """Return the parts at the nodes of a file, in its own units and axes, or the fault.

    kind : "glb", "ply", "obj" or "stl"

    Coordinates are not checked; see ``parts.wrong_corners``.
    """
    try:
        with np.errstate(all="ignore"):  # callers check coordinates for overflow
            parts = _parts(kind, data)
    except FOREIGN as error:
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        return ModelFault(reason or type(error).__name__)
    corners = sum(len(p.corners) for p in parts)
    if corners > MOST_CORNERS:
        return ModelFault(f"it has {corners} corners; {MOST_CORNERS} are the most", "thin it, or cut it")
    return parts


def _parts(kind: str, data: bytes) -> list[NodePart]:
    if kind == "ply":
        return read_ply(data)
    if kind == "stl":
        return read_stl(data)
    return read_obj(data) if kind == "obj" else read_glb(data, MOST_CORNERS)


def read_stl(data: bytes) -> list[NodePart]:
    """Return the single part of a file, none for an empty file; raise ValueError if it is no STL."""
    if not data:
        return []
    count = int.from_bytes(data[80:STL_HEAD_BYTES], "little")
    whole = STL_HEAD_BYTES + STL_RECORD_BYTES * count == len(data)
    if not whole and data[:300].lstrip()[:5].lower() == b"solid":
        corners = np.array(_STL_CORNER.findall(data), dtype=np.float64).reshape(-1, 3)
        corners = corners[: 3 * (len(corners) // 3)]
    elif len(data) >= STL_HEAD_BYTES and STL_HEAD_BYTES + STL_RECORD_BYTES * count <= len(data):
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
        flat = np.frombuffer(data, kind, count, STL_HEAD_BYTES)["corners"].reshape(-1, 3)
        corners = flat.astype(np.float64)
    else:
        raise ValueError(f"its header promises {count} triangles in {len(data)} bytes")
    return [part("", corners, np.arange(len(corners)).reshape(-1, 3))]
