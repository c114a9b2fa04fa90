"""Meshes from the bytes of PLY, OBJ, STL and GLB files.

Our readers need only numpy. trimesh reads these files too, but takes a second to load, with scipy.
"""

from __future__ import annotations

import struct

import numpy as np

from shotc.kinds.models.glb import read_glb
from shotc.kinds.models.obj import read_obj
from shotc.kinds.models.parts import ModelFault, NodePart
from shotc.kinds.models.ply import read_ply
from shotc.kinds.models.stl import read_stl

MOST_CORNERS = 5_000_000
"""Most corners of a scene, with every placement of its meshes."""
FOREIGN = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, struct.error)
"""Exceptions that bytes without a valid model cause."""


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
