"""Scenes as a mission names them: where they come to stand, what is told of bad files, and any bytes."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shotc.diag.registry import has_errors
from shotc.passes.resolve.lower import files as reading
from tests.support.meshes import glb, obj, ply, stl
from tests.support.scene_missions import corners, fault, found, house, mesh

ENDINGS = ("glb", "ply", "obj", "stl", "xyz", "las", "laz")


def doubles(points: np.ndarray) -> bytes:
    """Return three points as a binary PLY file of doubles, with one face."""
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    return head.encode() + points.astype("<f8").tobytes() + bytes([3]) + np.arange(3, dtype="<i4").tobytes()


def laz(points: np.ndarray, classes: list[int] | None = None) -> bytes:
    import laspy

    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [0.001] * 3, [0.0] * 3
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points.T
    if classes is not None:
        cloud.classification = np.array(classes, dtype=np.uint8)
    out = io.BytesIO()
    cloud.write(out, do_compress=True)
    return out.getvalue()


HOUSE = {
    "ply": ply(house()),
    "stl": stl(house()),
    "obj": obj(house()),
    "glb": glb(house(), (0.0, 0.0, 0.0)),
}


@pytest.mark.parametrize("kind", HOUSE)
def test_every_format_comes_to_stand_upright(tmp_path, kind):
    (tmp_path / f"house.{kind}").write_bytes(HOUSE[kind])
    units = "" if kind == "glb" else ", units: m"
    shape = mesh(f"scene: {{file: house.{kind}{units}}}", tmp_path)
    assert corners(shape) == pytest.approx(np.array([[-5, -4, 0], [5, 4, 6]]), abs=1e-6)
    assert (shape.kind, shape.file, shape.spacing) == ("scene", f"house.{kind}", 0.0)
    assert len(shape.part) == 12
    assert shape.name_at(0)


@pytest.mark.parametrize(
    ("keys", "low", "high"),
    [
        ("units: m, at: [100, 20, 1]", [95, 16, 1], [105, 24, 7]),
        ("units: m, heading: 90 deg", [-4, -5, 0], [4, 5, 6]),
        ("units: ft", [-1.524, -1.2192, 0], [1.524, 1.2192, 1.8288]),
        ("units: m, at: {lat: 46.68, lon: 7.68, height: 3}", [-5, -4, 3], [5, 4, 9]),
        ("units: m, at: [100, 20]", [95, 16, 0], [105, 24, 6]),
        ("units: m, up: y, at: [0, 0, 4]", [-5, -6, 0], [5, 0, 8]),
    ],
)
def test_a_scene_is_put_where_it_is_said(tmp_path, keys, low, high):
    (tmp_path / "house.ply").write_bytes(ply(house()))
    shape = mesh(f"scene: {{file: house.ply, {keys}}}", tmp_path)
    assert corners(shape) == pytest.approx(np.array([low, high]), abs=1e-5)


def test_its_north_leads_along_the_heading(tmp_path):
    north = np.array([[[0.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 5.0]]])
    (tmp_path / "mark.ply").write_bytes(ply(north))
    shape = mesh("scene: {file: mark.ply, units: m, heading: 30 deg}", tmp_path)
    farthest = max(shape.surface.triangles.reshape(-1, 3).tolist(), key=lambda p: np.hypot(p[0], p[1]))
    assert farthest == pytest.approx([5.0, 10.0 * np.sqrt(0.75), 0.0], abs=1e-6)


def test_a_scene_without_a_height_stands_on_the_terrain(tmp_path):
    (tmp_path / "house.ply").write_bytes(ply(house()))
    rows = [f"{x},{y},{x / 10 + 50:g}" for x in range(-300, 301, 100) for y in (-300, 0, 300)]
    (tmp_path / "hill.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    shape = mesh("terrain: {file: hill.csv}\n  scene: {file: house.ply, units: m, at: [100, 20]}", tmp_path)
    assert corners(shape)[0, 2] == pytest.approx(60.0)


def test_nodes_of_a_scene_keep_their_names(tmp_path):
    import trimesh

    scene = trimesh.Scene()
    for name, x in (("nave", 0.0), ("tower", 20.0)):
        box = trimesh.creation.box((4, 4, 4))
        scene.add_geometry(
            box, node_name=name, transform=trimesh.transformations.translation_matrix([x, 2, 0])
        )
    (tmp_path / "church.glb").write_bytes(scene.export(file_type="glb"))
    shape = mesh("scene: {file: church.glb}", tmp_path)
    east = shape.surface.triangles[:, :, 0].min(axis=1) > 10.0
    assert {shape.name_at(k) for k in shape.surface.source[east]} == {"tower"}
    assert {shape.name_at(k) for k in shape.surface.source[~east]} == {"nave"}


@pytest.mark.parametrize("kind", ["xyz", "ply", "laz"])
def test_points_of_a_cloud_stand_for_half_their_spacing(tmp_path, kind):
    x, y = np.meshgrid(np.arange(0, 20, 0.5), np.arange(0, 10, 0.5))
    points = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 2.0)])
    rows = "x y z\n" + "\n".join(" ".join(f"{c:g}" for c in p) for p in points)
    data = {"xyz": rows.encode(), "ply": ply(points), "laz": laz(points)}[kind]
    (tmp_path / f"cloud.{kind}").write_bytes(data)
    shape = mesh(f"scene: {{file: cloud.{kind}, units: m}}", tmp_path)
    assert shape.spacing == pytest.approx(0.25, abs=1e-6)
    assert len(shape.surface) == len(points)
    assert corners(shape) == pytest.approx(np.array([[0, 0, 2], [19.5, 9.5, 2]]), abs=1e-3)


def test_noise_of_a_survey_is_left_out(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 900.0]])
    (tmp_path / "cloud.laz").write_bytes(laz(points, [6, 6, 2, 18]))
    assert corners(mesh("scene: {file: cloud.laz, units: m}", tmp_path))[1, 2] == 0.0


def test_large_coordinates_of_doubles_and_texts_are_exact(tmp_path):
    points = np.array([[30_000.123456, 5.0, 0.0], [30_010.0, 5.0, 0.0], [30_000.0, 9.0, 5.0]])
    (tmp_path / "far.ply").write_bytes(doubles(points))
    (tmp_path / "far.obj").write_bytes(obj(points[None]))
    for name, exact in (("far.ply", 1e-8), ("far.obj", 1e-8)):
        shape = mesh(f"scene: {{file: {name}, units: m, at: [-30000, 0, 0]}}", tmp_path)
        assert corners(shape)[0, 0] == pytest.approx(0.0, abs=exact)
        assert corners(shape)[1, 0] == pytest.approx(10.0, abs=exact)


FAR = house() + np.array([400_000.0, 5_170_000.0, 500.0])
TURNED = house()[..., [0, 2, 1]] * [1.0, -1.0, 1.0]
BAD = [
    ("house.ply", ply(house()), "", "G026", "units: m"),
    ("house.txt", b"", "units: m", "N009", ".glb, .ply"),
    ("house.ply", ply(house()), "units: mm", "G031", "units: m"),
    ("house.ply", ply(1000 * house()), "units: m", "G030", "units: mm"),
    ("house.ply", ply(5000 * house()), "units: m", "G031", "units: mm"),
    ("house.ply", ply(house()), "units: m, at: [20000, 0, 0]", "G031", "at: [0.0, 0.0, 0.0]"),
    ("house.ply", ply(TURNED * [1.0, -1.0, 1.0]), "units: m", "G032", "up: y"),
    ("house.ply", ply(TURNED), "units: m", "G032", "write `at: [0.0, 0.0, 4.0]`"),
    ("house.ply", ply(FAR), "units: m", "G033", "[400000, 5.17e+06, 503]"),
    ("house.stl", stl(FAR), "units: m", "G033", "offset"),
    ("house.obj", obj(FAR), "units: m", "G031", "[400000, 503, -5.17e+06]"),
    ("house.obj", obj(FAR / 10), "units: m", "G031", "export it with"),
    (
        "house.obj",
        obj(house() + np.array([40_000.0, 5000.0, 500.0])),
        "units: m",
        "G031",
        "[-40000.0, -5000.0, -500.0]",
    ),
    ("house.ply", ply(house()).replace(b"-5 -4 0", b"nan -4 0"), "units: m", "N009", "export it anew"),
    ("house.ply", b"", "units: m", "N009", "export it anew"),
    ("house.xyz", b"1 2 3\n4 5,5 x\n", "units: m", "N009", "decimals have a point"),
    ("house.xyz", b"", "units: m", "N009", "write a row"),
    ("house.las", b"LASF" + bytes(300), "units: m", "N009", "export it anew"),
]


@pytest.mark.parametrize(("name", "data", "keys", "code", "help_"), BAD, ids=[f"{b[0]}-{b[3]}" for b in BAD])
def test_a_bad_scene_is_told_on_its_line(tmp_path, name, data, keys, code, help_):
    (tmp_path / name).write_bytes(data)
    told = fault(f"scene: {{file: {name}{', ' * bool(keys)}{keys}}}", tmp_path)
    assert told.code == code
    assert told.labels[0].span.line == 5
    assert "0x" not in told.message
    assert help_ in f"{told.message} {told.notes} {told.help}" or code == "G033"


def test_a_bare_path_is_told_how_to_write_it(tmp_path):
    from tests.support.front_passes import loaded
    from tests.support.scene_missions import text

    for path, help_ in (("church.glb", "{file: church.glb}"), ("a.ply", "{file: a.ply, units: m}")):
        (told,) = loaded(text(f"scene: {path}"), tmp_path)[1]
        assert help_ in told.help
    (told,) = loaded(text("buildings: houses.geojson"), tmp_path)[1]
    assert "buildings: {file: houses.geojson}" in told.help


def test_a_gigabyte_is_not_read(tmp_path, monkeypatch):
    with (tmp_path / "huge.ply").open("wb") as stream:
        stream.truncate(1_000_000_000)  # without a block on the disk
    told = fault("scene: {file: huge.ply, units: m}", tmp_path)
    assert told.code == "N009"
    assert "1000.0 MB" in told.message


def test_no_more_than_is_allowed_is_read_of_a_file_without_a_size(tmp_path, monkeypatch):
    monkeypatch.setattr(reading, "MAX_LINKED_BYTES", 100)
    (tmp_path / "house.ply").write_bytes(ply(house()))
    assert fault("scene: {file: house.ply, units: m}", tmp_path).code == "N009"


def test_a_cloud_without_its_reader_names_the_extra(tmp_path, monkeypatch):
    from shotc.kinds.models import cloud_file

    monkeypatch.setattr(cloud_file, "find_spec", lambda name: None if name == "laspy" else object())
    (tmp_path / "cloud.laz").write_bytes(laz(np.zeros((3, 3))))
    told = fault("scene: {file: cloud.laz, units: m}", tmp_path)
    assert told.code == "P004"
    assert "[geo]" in told.help


@pytest.mark.parametrize("at", [100, 96, 107, "table"])
def test_a_survey_that_promises_more_than_it_holds_is_refused_at_once(tmp_path, at):
    data = bytearray(laz(house().reshape(-1, 3)))
    if at == "table":  # of chunks, of which the reader believes how many there are
        points = int.from_bytes(data[96:100], "little")
        at = 4 + int.from_bytes(data[points : points + 8], "little")
    data[at : at + 4] = b"\xff\xff\xff\x7f"  # records, where points begin, and how many there are
    (tmp_path / "cloud.laz").write_bytes(data)
    assert fault("scene: {file: cloud.laz, units: m}", tmp_path).code == "N009"


@pytest.mark.slow
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    ending=st.sampled_from(ENDINGS),
    begin=st.sampled_from(
        [b"", b"ply\nformat ascii 1.0\n", b"LASF", b"glTF\x02\0\0\0", b"solid a\n", b"v 1 2"]
    ),
    data=st.binary(max_size=400),
)
def test_any_bytes_are_a_diagnostic_or_a_scene(tmp_path, ending, begin, data):
    (tmp_path / f"any.{ending}").write_bytes(begin + data)
    mission, faults = found(f"scene: {{file: any.{ending}, units: m}}", tmp_path)
    assert bool(mission.meshes) != has_errors(faults)


@pytest.mark.slow
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    kind=st.sampled_from([*HOUSE, "laz"]),
    place=st.floats(0, 1),
    byte=st.integers(0, 255),
    cut=st.floats(0, 1),
)
def test_damaged_files_are_a_diagnostic_or_a_scene(tmp_path, kind, place, byte, cut):
    data = bytearray(laz(house().reshape(-1, 3)) if kind == "laz" else HOUSE[kind])
    data[int(place * (len(data) - 1))] = byte
    (tmp_path / f"any.{kind}").write_bytes(data[: max(1, int((0.5 + cut) * len(data)))])
    mission, faults = found(f"scene: {{file: any.{kind}, units: m}}", tmp_path)
    assert bool(mission.meshes) != has_errors(faults)
