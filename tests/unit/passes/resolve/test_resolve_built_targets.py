"""Targets that are buildings: the bodies about them, by name and by id, and what cannot be one."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.geom.shapes import BoxShape, GroupShape
from shotc.ir.passes import PassContext
from shotc.passes.resolve.lower import lowered, obstacles
from shotc.planfile.sanity import mission_faults
from tests.support.front_passes import EMITTERS, KINDS, loaded
from tests.support.meshes import box_mesh
from tests.support.scene_missions import feature, geojson, square, text

WORLD = "buildings: {file: houses.geojson}"
STATUE = "statue: {at: [60, 0], radius: 1, height: 4}"
L = [(0.0, 0.0), (12.0, 0.0), (12.0, 5.0), (6.0, 5.0), (6.0, 9.0), (0.0, 9.0)]
TOWER, NAVE = square(-3, 0, 6), [(0.0, -3.0), (20.0, -3.0), (20.0, 3.0), (0.0, 3.0)]
CHURCH = [(-6.0, -3.0), (20.0, -3.0), (20.0, 3.0), (-6.0, 3.0)]
VILLAGE = geojson(
    feature(CHURCH, id="way/1", name="St. Mary", building="church", height=9),
    feature(TOWER, id="way/2", name="tower", building__part="yes", height=30),
    feature(NAVE, id="way/3", building__part="yes", height=12),
    feature(square(80, 0, 8), id="way/4", name="Barn", building="yes", height=6),
    feature(square(-80, 0, 8), id="way/5", name="Barn", building="yes", height=7),
    feature([(x, y + 60) for x, y in L], id=6, building="yes", height=5),
)


def mission(target: str, world: str = WORLD) -> str:
    written = text(world)
    assert STATUE in written
    return written.replace(STATUE, f"statue: {target}")


def resolved(folder, target, data=VILLAGE, world=WORLD):
    """Return a mission whose statue is written so, with what is wrong with its words and files."""
    if world == WORLD:
        (folder / "houses.geojson").write_bytes(data)
    read, faults = loaded(mission(target, world), folder)
    assert read is not None, faults
    result = lowered(read, KINDS, EMITTERS, PassContext().progress)
    return result.mission, list(result.faults)


def told(folder, target, data=VILLAGE, world=WORLD) -> Diagnostic:
    """Return the one thing that `check` says of a mission."""
    if world == WORLD:
        (folder / "houses.geojson").write_bytes(data)
    (only,) = check_source(mission(target, world).encode(), "m.yaml", folder).diagnostics
    return only


@pytest.mark.parametrize("wanted", ["tower", "way/2"])
def test_a_building_is_the_box_about_it(tmp_path, wanted):
    made, faults = resolved(tmp_path, f"{{building: {wanted}}}")
    assert faults == []
    target = made.target("statue")
    assert isinstance(target.shape, BoxShape)
    assert target.centre == pytest.approx((-3, 0, 15), abs=1e-3)
    assert (target.shape.length, target.shape.width, target.shape.height) == pytest.approx(
        (6, 6, 30), abs=2e-3
    )
    assert made.targets == (target,)


def test_a_building_of_parts_is_a_group_of_them(tmp_path):
    made, faults = resolved(tmp_path, "{building: St. Mary}")
    assert faults == []
    church = made.target("statue")
    assert isinstance(church.shape, GroupShape)
    assert church.parts == ("statue.tower", "statue.1")  # the nave has its building's name alone
    assert [t.height for t in made.targets] == [30, 12]
    assert church.foot[2] == pytest.approx(0)
    assert list(mission_faults(made)) == []


def test_an_l_is_two_boxes_and_a_number_is_an_id(tmp_path):
    made, faults = resolved(tmp_path, "{building: 6}")
    assert faults == []
    assert made.target("statue").parts == ("statue.1", "statue.2")
    (mesh,) = made.meshes
    corners = mesh.surface.triangles[mesh.part[mesh.surface.source] == mesh.names.index("6")].reshape(-1, 3)
    gaps = [min(t.shape.gap(tuple(np.subtract(p, t.centre))) for t in made.targets) for p in corners]
    assert max(gaps) < 1e-9


def test_a_building_is_a_part_of_a_group_with_all_its_bodies(tmp_path):
    targets = "{building: St. Mary}\n  barn: {building: way/4}\n  both: {parts: [statue, barn]}"
    made, faults = resolved(tmp_path, targets)
    assert faults == []
    assert made.target("both").parts == ("statue.tower", "statue.1", "barn")
    assert list(mission_faults(made)) == []


def test_a_whole_is_meant_where_a_part_has_its_name(tmp_path):
    data = VILLAGE.replace(b'"name": "tower"', b'"name": "St. Mary"')
    made, faults = resolved(tmp_path, "{building: St. Mary}", data)
    assert faults == []
    assert len(made.target("statue").parts) == 2


def test_a_node_of_a_scene_is_the_box_about_its_corners(tmp_path):
    parts = {"barn": box_mesh((30, 0, 3), (10, 4, 6)), "mill": box_mesh((60, 5, 8), (4, 4, 16))}
    (tmp_path / "farm.obj").write_text(objects(parts))
    world = "scene: {file: farm.obj, units: m, up: z}"
    made, faults = resolved(tmp_path, "{building: mill}", world=world)
    assert faults == []
    assert made.target("statue").centre == pytest.approx((60, 5, 8))
    assert made.target("statue").height == pytest.approx(16)
    unknown = told(tmp_path, "{building: mil}", world=world)
    assert (unknown.code, unknown.help) == ("G048", "did you mean `mill`?")


def objects(parts: dict[str, np.ndarray]) -> str:
    """Return triangles (n, 3, 3) by name as an OBJ file."""
    lines, corners = [], 0
    for name, triangles in parts.items():
        lines += [f"o {name}", *("v {} {} {}".format(*corner) for corner in triangles.reshape(-1, 3))]
        lines += [f"f {k} {k + 1} {k + 2}" for k in range(corners + 1, corners + triangles.size // 3, 3)]
        corners += triangles.size // 3
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("wanted", "code", "help_"),
    [
        ("St Mary", "G048", "did you mean `St. Mary`?"),
        ("town hall", "G048", "write the `name` or the id that the file gives it"),
        ("Barn", "G049", "write `building: way/4` if that one is meant"),
    ],
)
def test_what_is_not_one_building_is_told_on_its_line(tmp_path, wanted, code, help_):
    only = told(tmp_path, f"{{building: {wanted}}}")
    assert (only.code, only.help) == (code, help_)
    span = only.labels[0].span
    assert mission("x").splitlines()[span.line - 1].startswith("  statue")
    said = " ".join(only.notes)
    assert ("`Barn`" in said and "`St. Mary`" in said) if code == "G048" else ("`way/5`" in said)


def test_the_fix_of_two_of_one_name_works(tmp_path):
    assert resolved(tmp_path, "{building: way/4}")[1] == []


def test_a_building_without_a_file_of_buildings(tmp_path):
    assert told(tmp_path, "{building: barn}", world="wind: 1").code == "G050"


def test_a_building_beyond_the_terrain_is_told(tmp_path):
    rows = "".join(f"{x},{y},0\n" for y in (-60, 0, 60) for x in (-70, 0, 70))
    (tmp_path / "dem.csv").write_text("x,y,z\n" + rows)
    (tmp_path / "houses.geojson").write_bytes(VILLAGE)
    written = mission("{building: way/4}", WORLD + "\n  terrain: {file: dem.csv}")
    codes = [d.code for d in check_source(written.encode(), "m.yaml", tmp_path).diagnostics]
    assert sorted(codes) == ["G037", "G048"]


def test_on_terrain_it_stands_where_the_building_does(tmp_path):
    rows = "".join(f"{x},{y},{0.1 * x + 20}\n" for y in (-200, 0, 200) for x in (-200, 0, 200))
    (tmp_path / "dem.csv").write_text("x,y,z\n" + rows)
    (tmp_path / "houses.geojson").write_bytes(VILLAGE)
    read, _ = loaded(mission("{building: tower}", WORLD + "\n  terrain: {file: dem.csv}"), tmp_path)
    made = lowered(read, KINDS, EMITTERS, PassContext().progress).mission
    assert made.target("statue").foot == pytest.approx((-3, 0, 20 - 0.6), abs=1e-3)
    (mesh,) = made.meshes
    assert mesh.block(mesh.names.index("tower")).bottom == pytest.approx(20 - 0.6, abs=1e-3)


def test_a_file_that_cannot_be_used_is_told_once(tmp_path):
    data = geojson(feature(L, name="barn", building="yes"))
    assert told(tmp_path, "{building: barn}", data).code == "G035"


def test_without_numpy_a_building_is_a_target_all_the_same(tmp_path, monkeypatch):
    real = obstacles.find_spec
    monkeypatch.setattr(obstacles, "find_spec", lambda name: None if name == "numpy" else real(name))
    made, faults = resolved(tmp_path, "{building: tower}")
    assert [f.code for f in faults] == ["N013"]
    assert made.target("statue").centre == pytest.approx((-3, 0, 15), abs=1e-3)


@pytest.mark.parametrize("written", ["[1]", "''", "{a: 1}", "1.5", "true"])
def test_what_is_no_name_is_told(tmp_path, written):
    assert told(tmp_path, f"{{building: {written}}}").code.startswith("S")


@pytest.mark.parametrize("beside", ["at: [0, 0]", "parts: [a, b]", "size: [1, 1, 1]", "radius: 2"])
def test_a_building_has_no_place_nor_size_of_its_own(tmp_path, beside):
    (tmp_path / "houses.geojson").write_bytes(VILLAGE)
    written = mission(f"{{building: tower, {beside}}}")
    codes = {d.code for d in check_source(written.encode(), "m.yaml", tmp_path).diagnostics}
    assert codes
    assert all(code.startswith("S") for code in codes)
