"""GLB files (binary glTF 2.0 in one file): nodes that place meshes of triangles or points.

Compressed meshes (Draco, meshopt) and buffers in other files are refused.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.kinds.models.parts import Colors, NodePart, part

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
LINES, LOOP, LINE_STRIP, TRIANGLES, STRIP, FAN = 1, 2, 3, 4, 5, 6
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
COMPRESSED = frozenset({"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
DEEPEST_LEVEL = 500  # most nodes below one another
MOST_NODES = 100_000


class _Placed(NamedTuple):
    """A mesh at a node: its index, and its transform (4, 4)."""

    name: str
    mesh: int
    matrix: Array


class _GlbFile(NamedTuple):
    """The header of a file, and the bytes of its buffer."""

    header: dict[str, Any]
    buffer: bytes

    def item(self, kind: str, number: Any) -> dict[str, Any]:
        """Return an item of a list of the header; raise ValueError if there is none."""
        items = self.header.get(kind, [])
        if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(items):
            raise ValueError(f"it names one of its {kind} that is not there")
        item = items[number]
        if not isinstance(item, dict):
            raise ValueError(f"one of its {kind} is no object")
        return item


def read_glb(data: bytes, most_corners: int) -> list[NodePart]:
    """Return the parts at the nodes of a file; raise ValueError if it cannot be read.

    most_corners : of all nodes together, because many nodes can place the same mesh
    """
    file = _file(data)
    needed = COMPRESSED & set(file.header.get("extensionsRequired", []))
    if needed:
        raise ValueError(f"its meshes are compressed ({', '.join(sorted(needed))}); export it without")
    parts: list[NodePart] = []
    parts_of_meshes: dict[int, list[NodePart]] = {}
    count = 0
    for placed in _placed(file):
        if placed.mesh not in parts_of_meshes:
            mesh = file.item("meshes", placed.mesh)
            parts_of_meshes[placed.mesh] = [
                _primitive(file, primitive) for primitive in mesh.get("primitives", [])
            ]
        for own in parts_of_meshes[placed.mesh]:
            count += len(own.corners)
            if count > most_corners:
                raise ValueError(f"its scene has more than {most_corners} corners")
            corners = own.corners @ placed.matrix[:3, :3].T + placed.matrix[:3, 3]
            turned = own.triangles[:, ::-1] if np.linalg.det(placed.matrix[:3, :3]) < 0.0 else own.triangles
            parts.append(part(placed.name, corners, turned, own.colors))
    return parts


def _file(data: bytes) -> _GlbFile:
    if data[:4] != b"glTF" or int.from_bytes(data[4:8], "little") != 2:
        raise ValueError("it is no binary glTF 2.0")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= len(data):
        size, kind = (
            int.from_bytes(data[at : at + 4], "little"),
            int.from_bytes(data[at + 4 : at + 8], "little"),
        )
        if at + 8 + size > len(data):
            raise ValueError("it ends too soon")
        chunks.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    header = json.loads(chunks.get(JSON_CHUNK, b"null"))
    if not isinstance(header, dict):
        raise ValueError("it has no header")
    return _GlbFile(header, chunks.get(BINARY_CHUNK, b""))


def _placed(file: _GlbFile) -> Iterator[_Placed]:
    """Yield the meshes of the default scene with their transforms."""
    header = file.header
    if header.get("scenes"):
        roots = file.item("scenes", header.get("scene", 0)).get("nodes", [])
    else:
        below = {child for node in header.get("nodes", []) for child in node.get("children", [])}
        roots = [k for k in range(len(header.get("nodes", []))) if k not in below]
    waiting = [(number, np.eye(4), 0) for number in roots]
    seen = 0
    while waiting:
        number, above, depth = waiting.pop(0)
        seen += 1
        if depth > DEEPEST_LEVEL or seen > MOST_NODES:
            raise ValueError("its nodes lie too deep, or are too many")
        node = file.item("nodes", number)
        matrix = above @ _matrix(node)
        if "mesh" in node:
            yield _Placed(str(node.get("name", ""))[:80], node["mesh"], matrix)
        waiting += [(child, matrix, depth + 1) for child in node.get("children", [])]


def _matrix(node: dict[str, Any]) -> Array:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), dtype=np.float64)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]), dtype=np.float64).reshape(3)
    matrix[:3, 3] = np.array(node.get("translation", [0, 0, 0]), dtype=np.float64).reshape(3)
    return matrix


def _primitive(file: _GlbFile, primitive: dict[str, Any]) -> NodePart:
    """Return the triangles or points of a primitive; lines become triangles without area."""
    attributes = primitive["attributes"]
    corners = _accessor(file, attributes["POSITION"])
    if corners.shape[1] != 3:
        raise ValueError("its positions have not three coordinates")
    mode = primitive.get("mode", TRIANGLES)
    order = np.arange(len(corners))
    if "indices" in primitive:
        order = _accessor(file, primitive["indices"])[:, 0].astype(np.int64)
    colors = _colors(file, attributes.get("COLOR_0"), len(corners))
    return part("", corners, _triangles(order, mode), colors)


def _triangles(order: IntArray, mode: int) -> IntArray:
    if mode == TRIANGLES:
        return order[: 3 * (len(order) // 3)].reshape(-1, 3)
    if mode == STRIP and len(order) >= 3:
        rows = np.column_stack([order[:-2], order[1:-1], order[2:]])
        rows[1::2] = rows[1::2, ::-1]
        return rows
    if mode == FAN and len(order) >= 3:
        return np.column_stack([np.full(len(order) - 2, order[0]), order[1:-1], order[2:]])
    a, b = {
        LINES: (order[: len(order) - 1 : 2], order[1::2]),
        LOOP: (order, np.roll(order, -1)),
        LINE_STRIP: (order[:-1], order[1:]),
    }.get(mode, (order[:0], order[:0]))
    return np.column_stack([a, b, b])


def _colors(file: _GlbFile, number: Any, count: int) -> Colors | None:
    if number is None:
        return None
    values = _accessor(file, number)
    whole = 255.0 if values.size and values.max() <= 1.0 else 1.0
    if len(values) != count or values.shape[1] < 3:
        return None
    return np.asarray(np.clip(np.rint(values[:, :3] * whole), 0, 255), dtype=np.uint8)


def _accessor(file: _GlbFile, number: Any) -> Array:
    """Return the rows of an accessor as 64-bit floats, (count, columns).

    Raises ValueError if it is damaged.
    """
    accessor = file.item("accessors", number)
    if "sparse" in accessor or "bufferView" not in accessor:
        message = f"its header promises {accessor.get('count')} elements that are sparse, or nowhere"
        raise ValueError(message)
    view = file.item("bufferViews", accessor["bufferView"])
    if view.get("buffer", 0) != 0 or "uri" in file.item("buffers", 0):
        raise ValueError("its buffers lie in other files; export it as one file")
    kind, columns = np.dtype(COMPONENTS[accessor["componentType"]]), COUNTS[accessor["type"]]
    count = int(accessor["count"])
    begin = int(view.get("byteOffset", 0)) + int(accessor.get("byteOffset", 0))
    stride = int(view.get("byteStride", 0)) or kind.itemsize * columns
    if not begin >= 0 or count < 0 or stride < kind.itemsize * columns:
        raise ValueError("an accessor has no place")
    if count and begin + stride * (count - 1) + kind.itemsize * columns > len(file.buffer):
        raise ValueError(f"its header promises {count} elements in {len(file.buffer)} bytes")
    rows = np.ndarray((count, columns), kind, file.buffer, begin, (stride, kind.itemsize))
    values = rows.astype(np.float64)
    if accessor.get("normalized") and kind.kind in "iu":
        values = np.maximum(values / np.iinfo(kind).max, -1.0)
    return values
