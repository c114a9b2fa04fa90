"""Small meshes, and the files that hold them."""

from __future__ import annotations

import json

import numpy as np

from shotc.geom.bernstein import Array

_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def box_mesh(centre: tuple[float, float, float], size: tuple[float, float, float]) -> Array:
    """Return the 12 triangles of a box, (12, 3, 3), counter-clockwise from outside."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    faces = [t for a, b, c, d in _QUADS for t in ((a, b, c), (a, c, d))]
    return (corners * size + centre)[np.array(faces)]


def sphere_mesh(radius: float, rings: int = 24) -> Array:
    """Return the triangles of a ball about the origin, counter-clockwise from outside."""
    down = np.linspace(0, np.pi, rings + 1)[:, None]
    turn = np.linspace(0, 2 * np.pi, 2 * rings + 1)[None, :]
    grid = np.stack(
        [np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), np.cos(down) + 0 * turn], axis=2
    )
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    areas = np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    return radius * triangles[areas > 1e-12]


def ply(corners: Array, colors: Array | None = None) -> bytes:
    """Return triangles (T, 3, 3), or points (M, 3), as an ASCII PLY file, with colours a corner."""
    points = corners.reshape(-1, 3)
    faces = len(corners) if corners.ndim == 3 else 0
    lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    if colors is not None:
        lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    if faces:
        lines += [f"element face {faces}", "property list uchar int vertex_indices"]
    lines.append("end_header")
    extra = [""] * len(points) if colors is None else [" " + " ".join(map(str, c)) for c in colors]
    lines += [" ".join(f"{x:.9g}" for x in p) + e for p, e in zip(points, extra, strict=True)]
    lines += [f"3 {3 * k} {3 * k + 1} {3 * k + 2}" for k in range(faces)]
    return ("\n".join(lines) + "\n").encode()


def stl(corners: Array) -> bytes:
    """Return triangles as a binary STL file."""
    record = np.zeros(
        len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")]
    )
    record["corners"] = corners
    return bytes(80) + np.uint32(len(corners)).tobytes() + record.tobytes()


def obj(corners: Array) -> bytes:
    """Return triangles as an OBJ file, y up as modellers write it, that names a material nobody may open."""
    lines = ["mtllib /etc/hostname", "usemtl none"]
    lines += [f"v {x} {z} {-y}" for x, y, z in corners.reshape(-1, 3)]
    lines += [f"f {3 * k + 1} {3 * k + 2} {3 * k + 3}" for k in range(len(corners))]
    return "\n".join(lines).encode()


def glb(corners: Array, *moves: tuple[float, float, float]) -> bytes:
    """Return triangles as a binary glTF file, y up and in metres, at places (W) that its nodes move it to."""
    data = (
        np.stack([corners[..., 0], corners[..., 2], -corners[..., 1]], axis=-1).reshape(-1, 3).astype("<f4")
    )
    header = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(moves)))}],
        "nodes": [{"mesh": 0, "translation": [x, z, -y]} for x, y, z in moves],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": len(data),
                "type": "VEC3",
                "min": data.min(axis=0).tolist(),
                "max": data.max(axis=0).tolist(),
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": data.nbytes}],
        "buffers": [{"byteLength": data.nbytes}],
    }
    return chunks(json.dumps(header).encode(), data.tobytes())


def chunks(header: bytes, body: bytes) -> bytes:
    """Return a GLB file of a header and a body."""
    header += b" " * (-len(header) % 4)
    parts = [np.uint32([len(header), 0x4E4F534A]).tobytes(), header]
    parts += [np.uint32([len(body), 0x004E4942]).tobytes(), body]
    whole = b"".join(parts)
    return b"glTF" + np.uint32([2, 12 + len(whole)]).tobytes() + whole
