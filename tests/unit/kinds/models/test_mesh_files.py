"""Meshes from files: what trimesh reads from them, or writes into them, is what is read here."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
import trimesh

from shotc.kinds.models.mesh_file import read_mesh
from shotc.kinds.models.parts import ModelFault, NodePart, wrong_corners
from tests.support.meshes import chunks


def triangles(parts: list[NodePart]) -> np.ndarray:
    """Return all triangles, each begun with its least corner, in order: whatever order they stand in."""
    assert isinstance(parts, list), parts
    found = np.concatenate([p.corners[p.triangles] for p in parts]).round(5) + 0.0
    turned = [t[np.roll(np.arange(3), -min(range(3), key=lambda k: tuple(t[k])))] for t in found]
    return np.array(sorted(np.array(turned).tolist()))


def read(kind: str, data: bytes | str) -> list[NodePart]:
    parts = read_mesh(kind, data.encode() if isinstance(data, str) else data)
    assert isinstance(parts, list), parts
    return parts


SHAPES = {
    "box": trimesh.creation.box((4, 3, 2)),
    "ball": trimesh.creation.icosphere(subdivisions=2, radius=3.0),
    "ring": trimesh.creation.annulus(2, 3, 1),
}
for shape in SHAPES.values():
    shape.apply_translation([10.25, -3.5, 1.125])


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("kind", ["ply", "ply ascii", "stl", "stl ascii", "obj", "glb"])
def test_what_trimesh_writes_is_read(name, kind):
    mesh = SHAPES[name]
    ending = kind.partition(" ")[0]
    options = {"encoding": "ascii"} if kind == "ply ascii" else {}
    data = mesh.export(file_type="stl_ascii" if kind == "stl ascii" else ending, **options)
    own = NodePart("", np.asarray(mesh.vertices), np.asarray(mesh.faces))
    assert triangles(read(ending, data)) == pytest.approx(triangles([own]), abs=2e-5)


def test_nodes_of_a_scene_stand_where_trimesh_puts_them():
    random = np.random.default_rng(1)
    scene = trimesh.Scene()
    scene.add_geometry(SHAPES["box"], node_name="root", geom_name="box")
    for k in range(6):
        matrix = trimesh.transformations.random_rotation_matrix(random.uniform(size=3))
        matrix[:3, :3] *= random.uniform(0.3, 2.0, 3) * (-1 if k == 3 else 1)
        matrix[:3, 3] = random.uniform(-9, 9, 3)
        scene.graph.update(
            frame_to=f"n{k}", frame_from="root" if k < 2 else f"n{k - 2}", matrix=matrix, geometry="box"
        )
    data = scene.export(file_type="glb")
    seen = trimesh.load_scene(io.BytesIO(data), file_type="glb", process=False)
    theirs = [NodePart("", np.asarray(g.vertices), np.asarray(g.faces)) for g in seen.dump()]
    parts = read("glb", data)
    assert triangles(parts) == pytest.approx(triangles(theirs), abs=1e-4)
    assert {p.name for p in parts} == {"root", *(f"n{k}" for k in range(6))}


PLY = """\
ply
format ascii 1.0
comment made by hand
element vertex 5
property uchar red
property float x
property double y
property float z
property uchar green
property uchar blue
element face 2
property list uchar int vertex_indices
property float quality
element edge 1
property int a
property int b
end_header
255 0 0 0 1 2
255 1 0 0 1 2
255 1 1 0 1 2
0 0 1 0 3 4
0 2 2 5 3 4
4 0 1 2 3 0.5
3 0 1 4 0.25
0 1
"""


def test_a_ply_of_polygons_and_properties_in_any_order():
    (part,) = read("ply", PLY)
    assert part.corners.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 2, 5]]
    assert part.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4]]
    assert part.colors.tolist()[3] == [0, 3, 4]


TWO_FACES = """\
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
1 1 0
0 1 0
"""


@pytest.mark.parametrize(
    ("rows", "corners"),
    [
        ("3 0 1 2\n3 0 2 3\n", [[0, 1, 2], [0, 2, 3]]),
        ("3  0 1  2 \n3 0  2  3\n", [[0, 1, 2], [0, 2, 3]]),
        ("3 0 1 2 9\n3 0 2 3 9\n", [[0, 1, 2], [0, 2, 3]]),
        ("4 0 1 2 3\n3 0 2 3\n", [[0, 1, 2], [0, 2, 3], [0, 2, 3]]),
    ],
)
def test_faces_of_a_ply_in_text_are_read_row_by_row(rows, corners):
    (found,) = read_mesh("ply", (TWO_FACES + rows).encode())
    assert found.triangles.tolist() == corners


@pytest.mark.parametrize(
    "rows", ["3 0 1\n2 3 0 1 2\n", "3 0 1 2\n3 0 1 99999999999999999999\n", "3 0 1 2\n3 0 1 a\n"]
)
def test_faces_of_a_ply_in_text_that_are_none_are_told(rows):
    found = read_mesh("ply", (TWO_FACES + rows).encode())
    assert isinstance(found, ModelFault) or wrong_corners(found, 1e9)


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_binary_ply_of_either_order_with_faces_of_several_sizes(order):
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\r\nformat {name} 1.0\r\nelement vertex 4\r\n"
    head += "".join(f"property double {axis}\r\n" for axis in "xyz")
    head += "element face 3\r\nproperty list uchar uint vertex_index\r\nproperty uchar flag\r\nend_header\r\n"
    corners = np.array([[0, 0, 0], [4e6, 0, 0], [4e6, 1.25, 0], [0, 1, 7.5]])
    rows = [[0, 1, 2], [0, 1, 2, 3], [3, 2, 1]]
    faces = b"".join(bytes([len(r)]) + np.array(r, order + "u4").tobytes() + b"\1" for r in rows)
    (part,) = read("ply", head.encode() + corners.astype(order + "f8").tobytes() + faces)
    assert part.corners.tolist() == corners.tolist()
    assert part.triangles.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3], [3, 2, 1]]


OBJ = """\
# a house and a tree
mtllib nobody.mtl
o house
v 0 0 0 1 0 0
v 1 0 0 1 0 0
v 1 1 0 1 0 0
v 0 1 0 1 0 0
vt 0 0
vn 0 0 1
f 1/1/1 2/1/1 3/1/1 \\
4/1/1
o tree
v 5 5 0 0 1 0
v 6 5 0 0 1 0
v 5 6 4 0 0.5 0
f -3//1 -2//1 -1//1
l 1 2
"""


def test_an_obj_of_two_objects_with_numbers_from_the_end():
    house, tree = read("obj", OBJ)
    assert (house.name, tree.name) == ("house", "tree")
    assert house.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert tree.corners.tolist() == [[5, 5, 0], [6, 5, 0], [5, 6, 4]]
    assert tree.colors.tolist() == [[0, 255, 0], [0, 255, 0], [0, 128, 0]]


def gltf(primitive: dict, data: bytes, views: list[dict], accessors: list[dict], **more) -> bytes:
    header = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
        **more,
    }
    return chunks(json.dumps(header).encode(), data)


SQUARE = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0]], dtype="<f4")
FLOATS = {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}
WHOLE = [{"buffer": 0, "byteLength": 48}]


@pytest.mark.parametrize(
    ("mode", "faces"),
    [
        (0, []),
        (1, [[0, 1, 1], [2, 3, 3]]),
        (2, [[0, 1, 1], [1, 2, 2], [2, 3, 3], [3, 0, 0]]),
        (3, [[0, 1, 1], [1, 2, 2], [2, 3, 3]]),
        (4, [[0, 1, 2]]),
        (5, [[0, 1, 2], [3, 2, 1]]),
        (6, [[0, 1, 2], [0, 2, 3]]),
    ],
)
def test_every_mode_of_a_glb(mode, faces):
    data = gltf({"attributes": {"POSITION": 0}, "mode": mode}, SQUARE.tobytes(), WHOLE, [FLOATS])
    (part,) = read("glb", data)
    assert part.triangles.tolist() == faces


def test_quantized_and_interleaved_numbers_of_a_glb():
    rows = np.zeros(4, dtype=[("at", "<i2", 3), ("spare", "<u2")])
    rows["at"] = [[0, 0, 0], [32767, 0, 0], [0, -32767, 0], [32767, 32767, 16384]]
    own = {"bufferView": 0, "componentType": 5122, "count": 4, "type": "VEC3", "normalized": True}
    views = [{"buffer": 0, "byteLength": 32, "byteStride": 8}]
    (part,) = read("glb", gltf({"attributes": {"POSITION": 0}}, rows.tobytes(), views, [own]))
    assert part.corners == pytest.approx(np.array([[0, 0, 0], [1, 0, 0], [0, -1, 0], [1, 1, 0.5]]), abs=1e-4)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (gltf({"attributes": {"POSITION": 3}}, b"", [], []), "not there"),
        (gltf({"attributes": {}}, b"", [], []), "POSITION"),
        (gltf({"attributes": {"POSITION": 0}}, SQUARE.tobytes()[:40], WHOLE, [FLOATS]), "promises 4"),
        (gltf({}, b"", [], [], extensionsRequired=["KHR_draco_mesh_compression"]), "compressed"),
        (gltf({}, b"", [], [], nodes=[{"children": [0]}], scenes=[{"nodes": [0]}]), "too deep"),
        (chunks(b"[" * 100_000, b""), "recursion"),
        (b"glTF\1\0\0\0", "2.0"),
    ],
)  # fmt: skip
def test_a_glb_that_cannot_be_read_is_told(data, told):
    fault = read_mesh("glb", data)
    assert isinstance(fault, ModelFault)
    assert told in fault.message


def test_a_mesh_at_many_nodes_is_read_up_to_a_limit(monkeypatch):
    from shotc.kinds.models import mesh_file

    monkeypatch.setattr(mesh_file, "MOST_CORNERS", 10)
    nodes = [{"mesh": 0}] * 3
    data = gltf({"attributes": {"POSITION": 0}}, SQUARE.tobytes(), WHOLE, [FLOATS], nodes=nodes)
    fault = read_mesh("glb", data)
    assert isinstance(fault, ModelFault)
    assert "corners" in fault.message
