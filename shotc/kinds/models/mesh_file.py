"""Meshes from the bytes of PLY, OBJ, STL and GLB files.

They are read here, with numpy alone: trimesh, which reads them too, takes a second to load, with scipy.
"""

from __future__ import annotations

import struct

import numpy as np

from shotc.kinds.models.glb import read_glb
from shotc.kinds.models.obj import read_obj
from shotc.kinds.models.parts import ModelFault, NodePart
from shotc.kinds.models.ply import read_ply
from shotc.kinds.models.stl import read_stl

KINDS = ("glb", "ply", "obj", "stl")
MOST_CORNERS = 5_000_000
"""Corners that a scene may have once its meshes stand everywhere they are placed."""
FOREIGN = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, struct.error)
"""What bytes that are no model come to."""


def read_mesh(kind: str, data: bytes) -> list[NodePart] | ModelFault:
    """Return what stands at the nodes of a file, in its own units and axes; kind : one of KINDS.

    Coordinates may be anything; see ``parts.wrong_corners``.
    """
    try:
        with np.errstate(all="ignore"):  # who reads the coordinates finds what overflows
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
