"""Meshes and point clouds from the bytes of PLY, OBJ, STL and GLB files, by trimesh alone."""

from __future__ import annotations

import io
import json
import re
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors
from shotc.show.geom.columns import Numbers

Axis = Literal["x", "y", "z"]
UP: dict[str, Axis] = {"ply": "z", "obj": "y", "stl": "z", "glb": "y"}
"""The axis that points up in each format that is read, as modellers write it."""
TURNED: dict[Axis, list[int]] = {"x": [1, 2, 0], "y": [0, 2, 1], "z": [0, 1, 2]}
"""Which axis of a file becomes East, North and Up; where y is up, North is turned round."""
MOST_CORNERS = 5_000_000
"""Corners that a scene may have once its meshes stand everywhere they are placed."""
FARTHEST = 1e9
"""Coordinates beyond which a file is broken whatever its unit."""


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Corners (V, 3), triangles (T, 3) as their numbers, of a point cloud none; colours (V, 3) or None."""

    corners: Array
    triangles: Numbers
    colors: Colors | None


@dataclass(frozen=True, slots=True)
class Unreadable:
    """Why a file is no model, and what helps."""

    note: str
    help: str = "export it anew as binary PLY"


def read_model(name: str, data: bytes, up: Axis | None = None) -> Mesh | Unreadable:
    """Return what a file holds, in its own units, z up, with coinciding corners made one.

    up : the axis of the file that points up, None for that of its format
    """
    kind = name.rsplit(".", 1)[-1].lower()
    if kind not in UP:
        return Unreadable(
            f"`.{kind[:20]}` is no format that is read", "export it as .glb, .ply, .obj or .stl"
        )
    claim = _claimed(data) if kind == "ply" else _claimed_by_accessors(data) if kind == "glb" else 0
    if claim > len(data):
        return Unreadable(f"its header promises {claim} elements in {len(data)} bytes")
    try:
        with np.errstate(all="ignore"):  # what overflows is found below
            parts = _parts(kind, data)
    except Exception as error:  # noqa: BLE001  the reader's faults of foreign bytes
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        return Unreadable(f"trimesh says: {reason or type(error).__name__}")
    return _checked(_upright(_together(parts), up or UP[kind]))


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


def _parts(kind: str, data: bytes) -> list[Mesh]:
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


def _part(geometry: Any) -> Mesh:
    corners = np.asarray(geometry.vertices, dtype=float).reshape(-1, 3)
    faces = getattr(geometry, "faces", None)
    triangles = np.zeros((0, 3), np.intp) if faces is None else np.asarray(faces, np.intp).reshape(-1, 3)
    return Mesh(corners, triangles, _colors(geometry, len(corners)))


def _colors(geometry: Any, number: int) -> Colors | None:
    if not hasattr(geometry, "faces"):
        colors = np.asarray(geometry.colors)
    elif geometry.visual.defined and geometry.visual.kind in ("vertex", "face"):
        colors = np.asarray(geometry.visual.vertex_colors)
    else:
        return None
    return colors[:, :3].astype(np.uint8) if colors.ndim == 2 and len(colors) == number else None


def _together(parts: list[Mesh]) -> Mesh:
    """Join the parts of a file, and what lies at one place; white where only some parts have colours."""
    corners = np.concatenate([np.zeros((0, 3)), *(p.corners for p in parts)])
    offsets = np.cumsum([0, *(len(p.corners) for p in parts)])
    triangles = [p.triangles + offset for p, offset in zip(parts, offsets[:-1], strict=True)]
    colors = None
    if any(p.colors is not None for p in parts):
        white = [np.full((len(p.corners), 3), 255, np.uint8) if p.colors is None else p.colors for p in parts]
        colors = np.concatenate(white)
    return Mesh(corners, np.concatenate([np.zeros((0, 3), np.intp), *triangles]), colors)


def _upright(mesh: Mesh, up: Axis) -> Mesh:
    """Turn a file's coordinates so that z is up, its triangles still counter-clockwise from outside."""
    corners = mesh.corners[:, TURNED[up]]
    if up == "y":
        corners = corners * np.array([1.0, -1.0, 1.0])
    return Mesh(corners, mesh.triangles, mesh.colors)


def _checked(mesh: Mesh) -> Mesh | Unreadable:
    if not len(mesh.corners):
        return Unreadable("it holds no points", "export a mesh or a point cloud that holds something")
    finite = np.all(np.isfinite(mesh.corners) & (np.abs(mesh.corners) < FARTHEST), axis=1)
    if not finite.all():
        return Unreadable(f"{int((~finite).sum())} of its {len(mesh.corners)} points have no finite place")
    if len(mesh.triangles) and not (mesh.triangles.min() >= 0 and mesh.triangles.max() < len(mesh.corners)):
        return Unreadable("a face names a corner that is not there")
    if not np.ptp(mesh.corners, axis=0).max() > 0:
        return Unreadable("all of its points are at one place", "export a mesh that has a size")
    return _welded(mesh)


def _welded(mesh: Mesh) -> Mesh:
    """Make corners at one place one, as in an STL each face has its own, and drop faces without area."""
    if not len(mesh.triangles):
        return mesh
    grain = 1e-8 * float(np.ptp(mesh.corners, axis=0).max())
    cells = np.round(mesh.corners / grain).astype(np.int64)
    _, first, number = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    triangles = number.reshape(-1)[mesh.triangles]
    a, b, c = triangles.T
    whole = triangles[(a != b) & (b != c) & (a != c)]
    colors = None if mesh.colors is None else mesh.colors[first]
    return Mesh(mesh.corners[first], whole, colors)
