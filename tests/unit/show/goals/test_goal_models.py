"""Mesh files: read alike from every format, and every sort of broken one told."""

from __future__ import annotations

import json

import numpy as np
import pytest

from shotc.ir.show import Model
from shotc.show.goals.body import SourceFault
from shotc.show.goals.frames import model_bodies
from shotc.show.goals.model import mesh_body, open_edges
from shotc.show.goals.model_file import ModelMesh, UnreadableModel, read_model
from tests.support.meshes import box_mesh, chunks, glb, obj, ply, sphere_mesh, stl

BALL = sphere_mesh(10.0)
PLACES = b"property float x\nproperty float y\nproperty float z\n"
HEADER = b"ply\nformat ascii 1.0\nelement vertex 2\n" + PLACES + b"end_header\n"


def read(name: str, data: bytes) -> ModelMesh:
    mesh = read_model(name, data)
    assert isinstance(mesh, ModelMesh), mesh
    return mesh


@pytest.mark.parametrize(
    ("name", "data"),
    [("a.ply", ply(BALL)), ("A.STL", stl(BALL)), ("a.obj", obj(BALL)), ("a.glb", glb(BALL, (0, 0, 0)))],
)
def test_all_formats_give_the_same_closed_mesh(name: str, data: bytes) -> None:
    mesh = read(name, data)
    assert len(mesh.triangles) == len(BALL)
    assert len(mesh.corners) == len(BALL) // 2 + 2  # Euler: V - E + F = 2, with E = 3 F / 2
    assert open_edges(mesh) == 0
    body = mesh_body(mesh)
    points = body.draw("volume", 20_000, np.random.default_rng(0))
    assert (np.linalg.norm(points, axis=1) < 5).mean() == pytest.approx(0.125, abs=0.01)
    surface = body.draw("surface", 20_000, np.random.default_rng(0))
    assert np.linalg.norm(surface, axis=1).min() > 9.9
    assert surface[:, 2].std() == pytest.approx(10 / 3**0.5, rel=0.02)  # Archimedes: even in height
    assert body.encloses(np.array([1.0, 2.0, 3.0]))
    assert not body.encloses(np.array([9.0, 9.0, 3.0]))


def test_a_hole_is_counted() -> None:
    assert open_edges(read("a.ply", ply(BALL[3:]))) > 0
    assert open_edges(read("a.ply", ply(box_mesh((0, 0, 0), (1, 2, 3))[1:]))) == 3


def test_faces_that_do_not_run_alike_are_counted_by_parity() -> None:
    muddled = BALL.copy()
    muddled[::7] = muddled[::7, ::-1]
    body = mesh_body(read("a.stl", stl(muddled)))
    points = body.draw("volume", 5000, np.random.default_rng(0))
    assert (np.linalg.norm(points, axis=1) < 5).mean() == pytest.approx(0.125, abs=0.02)


@pytest.mark.parametrize(
    ("name", "data", "told"),
    [
        ("a.fbx", b"x", "no format"),
        ("a.ply", b"", "ply"),
        ("a.obj", b"", "no points"),
        ("a.stl", b"", "no points"),
        ("a.stl", b"solid x\nfacet normal 0 0 0\nouter loop\nvertex 1 2 3", "no points"),
        ("a.stl", stl(BALL)[:1000], ""),
        ("a.ply", ply(BALL)[:5000], ""),
        ("a.ply", HEADER + b"0 0 0\nnan 1 1\n", "1 of its 2 points"),
        ("a.ply", HEADER + b"0 0 0\n1e300 1 1\n", "1 of its 2 points"),
        ("a.ply", HEADER + b"1 1 1\n1 1 1\n", "one place"),
        (
            "a.ply",
            HEADER.replace(b"2", b"300000000000", 1).replace(b"ascii", b"binary_little_endian"),
            "promises",
        ),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9", ""),
        ("a.obj", b"\x00\x01\x02" * 100, ""),
        ("a.ply", b"\x00\x01\x02" * 100, ""),
    ],
)
def test_files_that_are_no_models(name: str, data: bytes, told: str) -> None:
    fault = read_model(name, data)
    assert isinstance(fault, UnreadableModel)
    assert told in fault.note
    assert "\n" not in fault.note
    assert fault.help


def frames(files: dict[str, bytes], fill: str = "volume", height: float | None = None):
    return model_bodies(Model(tuple(files), 1.0, None, height, 0.0), files, fill)  # type: ignore[arg-type]


def fault(files: dict[str, bytes], fill: str = "volume", height: float | None = None) -> SourceFault:
    found = frames(files, fill, height)
    assert isinstance(found, SourceFault)
    return found


def test_a_mesh_that_is_open_is_filled_by_its_surface_only() -> None:
    files = {"a.ply": ply(box_mesh((0, 0, 30), (10, 10, 10))[1:])}
    told = fault(files)
    assert (told.code, told.notes[0].split()[0]) == ("D051", "3")
    assert "fill: surface" in told.help
    assert len(frames(files, "surface")) == 1


def test_a_mesh_in_millimetres_needs_a_height() -> None:
    files = {"a.ply": ply(box_mesh((0, 0, 0), (4000, 9000, 18000)))}
    told = fault(files)
    assert told.code == "D052"
    assert "were it in mm, it would be 18 m large" in told.notes[0]
    assert "`units: mm`" in told.help
    assert "height: 18" in told.help
    (body,) = frames(files, height=18.0)
    points = body.draw("volume", 2000, np.random.default_rng(0))
    assert np.ptp(points, axis=0) == pytest.approx([4, 9, 18], rel=0.02)


def test_a_level_mesh_has_no_height_to_scale() -> None:
    sheet = np.array([[[0.0, 0, 5], [4, 0, 5], [4, 4, 5]]])
    assert fault({"a.ply": ply(sheet)}, "surface", 10.0).code == "D050"


@pytest.mark.slow
def test_frames_of_different_units() -> None:
    files = {"a.ply": ply(BALL), "b.ply": ply(BALL * 1.5), "c.ply": ply(BALL * 1500)}
    told = fault(files)
    assert told.code == "D053"
    assert "`b.ply` and `c.ply`" in told.message
    assert "1e+03" in told.message or "1000" in told.message


def test_the_bad_frame_is_named() -> None:
    told = fault({"a.ply": ply(BALL), "b.ply": b"no"})
    assert (told.code, "`b.ply`" in told.message) == ("D050", True)


def test_a_mesh_of_faces_over_each_other_gets_fewer_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    # Each face lies over all columns: a file of thousands of them would take all the memory there is.
    monkeypatch.setattr("shotc.show.goals.model.MOST_PAIRS", 20_000)
    sheets = np.concatenate([box_mesh((0, 0, 3.0 * k), (50, 50, 1)) for k in range(20)])
    (body,) = frames({"a.stl": stl(sheets)}, height=100.0)
    points = body.draw("volume", 4000, np.random.default_rng(0))
    assert np.ptp(points[:, 2]) == pytest.approx(100.0, rel=0.01)
    assert len(np.unique(points[:, :2], axis=0)) < 300


def extent(found) -> np.ndarray:
    (body,) = found
    return np.ptp(body.mesh.corners, axis=0)


SLAB = box_mesh((0, 0, 0), (2, 3, 8))


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.ply", ply(SLAB)),
        ("a.stl", stl(SLAB)),
        ("a.obj", obj(SLAB)),
        ("a.glb", glb(SLAB, (0, 0, 0))),
    ],
)
def test_every_format_stands_upright_as_modellers_write_it(name: str, data: bytes) -> None:
    source = Model((name,), None, None, None, 0.0)
    assert extent(model_bodies(source, {name: data}, "volume")) == pytest.approx([2, 3, 8])


@pytest.mark.parametrize(("up", "size"), [("x", [3, 8, 2]), ("y", [2, 8, 3]), ("z", [2, 3, 8])])
def test_the_axis_that_points_up_can_be_said_and_nothing_is_mirrored(up: str, size: list[float]) -> None:
    source = Model(("a.ply",), None, None, None, 0.0, up=up)  # type: ignore[arg-type]
    found = model_bodies(source, {"a.ply": ply(SLAB)}, "volume")
    assert extent(found) == pytest.approx(size)
    corners = found[0].mesh.corners[found[0].mesh.triangles]  # type: ignore[index, union-attr]
    volume = np.linalg.det(corners).sum() / 6
    assert volume == pytest.approx(48.0)  # negative where the triangles were turned inside out


def test_units_scale_a_model_about_its_origin_or_to_its_place() -> None:
    files = {"a.stl": stl(box_mesh((0, 0, 30_000), (2000, 3000, 8000)))}
    free = model_bodies(Model(("a.stl",), None, None, None, 0.0, 1e-3), files, "volume")
    assert extent(free) == pytest.approx([2, 3, 8])
    assert free[0].mesh.corners[:, 2].mean() == pytest.approx(30.0)  # type: ignore[index, union-attr]
    put = model_bodies(Model(("a.stl",), None, (0, 0, 50.0), None, 0.0, 1e-3), files, "volume")
    assert put[0].mesh.corners[:, 2].mean() == pytest.approx(50.0)  # type: ignore[index, union-attr]


def test_meshes_of_a_scene_stand_where_its_nodes_place_them() -> None:
    files = {"a.glb": glb(SLAB, (0, 0, 10), (20, 0, 10))}
    source = Model(("a.glb",), None, None, None, 0.0)
    (body,) = model_bodies(source, files, "volume")  # type: ignore[misc]
    assert body.mesh.corners.min(axis=0) == pytest.approx([-1, -1.5, 6])
    assert body.mesh.corners.max(axis=0) == pytest.approx([21, 1.5, 14])


@pytest.mark.slow
def test_a_scene_that_multiplies_its_meshes_without_end_is_refused() -> None:
    files = {"a.glb": glb(BALL, *[(float(k), 0.0, 0.0) for k in range(2000)])}
    found = fault(files)
    assert found.code == "D050"
    assert "corners" in found.notes[0]


def test_numbers_that_a_glb_promises_and_does_not_hold_are_refused() -> None:
    header = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 10**12, "type": "VEC3"}],
    }
    found = read_model("a.glb", chunks(json.dumps(header).encode(), b""))
    assert isinstance(found, UnreadableModel)
    assert "promises" in found.note


@pytest.mark.parametrize("data", [b"", b"glTF", b"glTF" + bytes(60), chunks(b"[]", b""), chunks(b"{", b"")])
def test_a_broken_glb_is_told(data: bytes) -> None:
    assert isinstance(read_model("a.glb", data), UnreadableModel)
