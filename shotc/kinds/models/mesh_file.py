"""Meshes from the bytes of PLY, OBJ, STL and GLB files, by trimesh alone."""

from __future__ import annotations

import io
import json
import re
from typing import Any

import numpy as np

from shotc.kinds.models.parts import Colors, ModelFault, Part, part

KINDS = ("glb", "ply", "obj", "stl")
MOST_CORNERS = 5_000_000
"""Corners that a scene may have once its meshes stand everywhere they are placed."""
_UNNAMED = re.compile(r"geometry(_\d+)?")
"""What trimesh calls the mesh of a file that has no name for it."""


def read_mesh(kind: str, data: bytes) -> list[Part] | ModelFault:
    """Return what stands at the nodes of a file, in its own units and axes; kind : one of KINDS.

    Coordinates may be anything; see ``parts.wrong_corners``.
    """
    claim = _claimed(data) if kind == "ply" else _claimed_by_accessors(data) if kind == "glb" else 0
    if claim > len(data):
        return ModelFault(f"its header promises {claim} elements in {len(data)} bytes")
    try:
        with np.errstate(all="ignore"):  # who reads the coordinates finds what overflows
            return _parts(kind, data)
    except Exception as error:  # noqa: BLE001  the reader's faults of foreign bytes
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        return ModelFault(f"trimesh says: {reason or type(error).__name__}")


def _claimed(data: bytes) -> int:
    header = data[:100_000].partition(b"end_header")[0]
    return sum(int(count) for count in re.findall(rb"^element\s+\S+\s+(\d{1,18})", header, re.MULTILINE))


def _claimed_by_accessors(data: bytes) -> int:
    """Return how many elements the header of a GLB file promises, those without a place in it, too."""
    size = int.from_bytes(data[12:16], "little")
    try:
        header = json.loads(data[20 : 20 + size])
        return sum(int(accessor["count"]) for accessor in header.get("accessors", []))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return 0  # the reader says what is wrong


def _parts(kind: str, data: bytes) -> list[Part]:
    import trimesh

    scene = trimesh.load_scene(
        io.BytesIO(data),
        file_type=kind,
        resolver=None,
        process=False,
        maintain_order=True,
        skip_materials=True,
    )
    placed = [node for node in scene.graph.nodes_geometry if scene.graph[node][1] in scene.geometry]
    corners = sum(len(getattr(scene.geometry[scene.graph[node][1]], "vertices", ())) for node in placed)
    if corners > MOST_CORNERS:
        raise ValueError(f"its scene has {corners} corners, at most {MOST_CORNERS} are read")
    return [_part(geometry) for geometry in scene.dump() if hasattr(geometry, "vertices")]


def _part(geometry: Any) -> Part:
    made = part(str(geometry.metadata.get("node", "")), geometry.vertices, getattr(geometry, "faces", None))
    name = "" if _UNNAMED.fullmatch(made.name) else made.name
    return Part(name, made.corners, made.triangles, _colors(geometry, len(made.corners)))


def _colors(geometry: Any, number: int) -> Colors | None:
    if not hasattr(geometry, "faces"):
        colors = np.asarray(geometry.colors)
    elif geometry.visual.defined and geometry.visual.kind in ("vertex", "face"):
        colors = np.asarray(geometry.visual.vertex_colors)
    else:
        return None
    return colors[:, :3].astype(np.uint8) if colors.ndim == 2 and len(colors) == number else None
