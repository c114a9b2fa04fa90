"""Elevation models of each format: what they hold and where, and a fault for all that they may get wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.terrain import posts as caps
from shotc.geom.terrain.posts import Posts, TerrainFault
from shotc.kinds.elevation import ascii_grid as asc
from shotc.kinds.elevation import csv_posts, geotiff, reader
from shotc.kinds.elevation.reader import read_elevation
from tests.support import elevation_files as files

HEIGHTS = np.array([[30.0, 31.5, 33.0], [20.0, 21.0, 22.0]])  # the first row is the northern one
CORNER = {"xllcorner": 400_000, "yllcorner": 5_170_000, "cellsize": 10}


def read(name: str, data: bytes, system: int | None = None) -> Posts:
    found = read_elevation(name, data, system)
    assert isinstance(found, Posts), found
    return found


def fault(name: str, data: bytes, system: int | None = None) -> TerrainFault:
    found = read_elevation(name, data, system)
    assert isinstance(found, TerrainFault)
    assert found.message
    return found


def test_an_ascii_grid_has_its_posts_in_the_middles_of_its_cells():
    found = read("a.asc", files.ascii_grid(HEIGHTS, CORNER), 32632)
    assert (found.x == [400_005, 400_015, 400_025]).all()
    assert (found.y == [5_170_005, 5_170_015]).all()
    assert (found.heights == HEIGHTS[::-1]).all()
    assert found.system == 32632


def test_an_ascii_grid_may_give_the_middle_and_two_steps():
    header = {"xllcenter": 7.5, "yllcenter": 46.5, "dx": 0.001, "dy": 0.002, "NODATA_value": 31.5}
    found = read("a.asc", files.ascii_grid(HEIGHTS, header))
    assert found.x == pytest.approx([7.5, 7.501, 7.502])
    assert found.y == pytest.approx([46.5, 46.502])
    assert found.system == 4326
    assert np.isnan(found.heights[1, 1])
    assert np.isnan(found.heights).sum() == 1


def test_an_ascii_grid_may_break_its_lines_anywhere():
    data = files.ascii_grid(HEIGHTS, CORNER).replace(b"31.5 33\n20", b"31.5\n33 20")
    assert (read("a.asc", data, 32632).heights == HEIGHTS[::-1]).all()


@pytest.mark.parametrize(
    ("old", "new", "kind", "line"),
    [
        (b"ncols 3", b"ncols three", "format", 1),
        (b"ncols 3", b"columns 3", "format", 1),
        (b"ncols 3", b"ncols 4", "truncated", None),
        (b"ncols 3", b"ncols 30000000", "size", None),
        (b"ncols 3", b"ncols 2.5", "format", None),
        (b"cellsize 10", b"cellsize 0", "format", None),
        (b"cellsize 10", b"cellsize nan", "format", 5),
        (b"cellsize 10", b"cellsize 10\ncellsize 10", "format", 6),
        (b"cellsize 10\n", b"", "format", 5),
        (b"31.5", b"nan", "number", 6),
        (b"31.5", b"31,5", "number", 6),
        (b"31.5", b"1_000", "number", 6),
        (b"31.5", b"99999", "number", None),
        (b"31.5", b"\xff", "format", 6),
        (b"20 21 22\n", b"20 21\n", "truncated", None),
        (b"20 21 22\n", b"20 21 22 23\n", "truncated", None),
        (b"20 21 22\n", b"", "truncated", None),
    ],
)
def test_a_damaged_ascii_grid_is_told(old: bytes, new: bytes, kind: str, line: int | None):
    data = files.ascii_grid(HEIGHTS, CORNER)
    assert old in data
    found = fault("a.asc", data.replace(old, new), 32632)
    assert (found.kind, found.line) == (kind, line)


def test_a_projected_ascii_grid_needs_its_system():
    found = fault("a.asc", files.ascii_grid(HEIGHTS, CORNER))
    assert found.kind == "system"
    assert "`epsg: 32632`" in found.help


@pytest.fixture(scope="module")
def srtm() -> bytes:
    heights = np.add.outer(np.arange(1201)[::-1], np.zeros(1201))
    heights[0, 0] = -32768
    return files.tile(heights)


def test_an_srtm_tile_is_where_its_name_says(srtm: bytes):
    found = read("dem/N46E007.hgt", srtm)
    assert (found.x[0], found.x[-1], found.y[0], found.y[-1]) == (7, 8, 46, 47)
    assert found.heights[0, 5] == 0.0
    assert found.heights[-1, 5] == 1200.0
    assert np.isnan(found.heights[-1, 0])
    south = read("s34w071.hgt", srtm)
    assert (south.x[0], south.y[0]) == (-71, -34)


@pytest.mark.parametrize(
    ("name", "cut", "system", "kind"),
    [
        ("N46E007.hgt", 2, None, "truncated"),
        ("tile.hgt", 0, None, "format"),
        ("N99E007.hgt", 0, None, "number"),
        ("N46E007.hgt", 0, 32632, "system"),
    ],
)
def test_a_wrong_srtm_tile_is_told(srtm: bytes, name: str, cut: int, system: int | None, kind: str):
    assert fault(name, srtm[: len(srtm) - cut], system).kind == kind


def rows(columns: tuple[float, ...], lines: tuple[float, ...]) -> np.ndarray:
    return np.array([[x, y, 100 + x + 2 * y] for y in lines for x in columns])


def test_a_table_is_a_grid_whatever_the_order_of_its_rows():
    of = rows((0, 5, 10.5), (0, 10))
    found = read("a.csv", files.table("x,y,z", np.random.default_rng(1).permutation(of)))
    assert found.system is None
    assert (found.x == [0, 5, 10.5]).all()
    assert (found.y == [0, 10]).all()
    assert found.heights == pytest.approx(np.array([[100, 105, 110.5], [120, 125, 130.5]]))


def test_columns_and_rows_that_a_table_lacks_are_holes():
    x, y = (0, 10, 20, 50, 60, 80, 90), (0, 5, 10, 20, 25)
    found = read("a.csv", files.table("x,y,z", rows(x, y)))
    assert (found.x == np.arange(0, 91, 10)).all()
    assert (found.y == np.arange(0, 26, 5)).all()
    there = np.isin(found.y, y)[:, None] & np.isin(found.x, x)
    assert (np.isfinite(found.heights) == there).all()


def test_a_table_that_lacks_most_of_a_grid_is_none():
    assert fault("a.csv", files.table("x,y,z", rows((0, 10, 20, 1000), (0, 10)))).kind == "grid"
    assert fault("a.csv", files.table("x,y,z", rows((0, 1e-5, 2e-5, 4000), (0, 10)))).kind == "grid"


def test_a_table_of_degrees_may_leave_posts_out():
    of = rows((7.1, 7.2, 7.3), (46.1, 46.2))[:-1]
    found = read("a.csv", files.table("lat,lon,alt", of[:, [1, 0, 2]]))
    assert found.system == 4326
    assert np.isnan(found.heights[1, 2])
    assert np.isnan(found.heights).sum() == 1


@pytest.mark.parametrize(
    ("data", "kind", "line"),
    [
        (b"", "format", None),
        (b"x,y,z\n1,2,nan\n", "format", 2),
        (b"x,y,z\n1,2\n", "format", 2),
        (b"lon,lat,z\n1,2,3\n", "format", 1),
        (b"lat,lon,alt\n91,2,3\n", "format", 2),
        (b"\xff\xfe", "format", 1),
        (b"x,y,z\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n0,0,2\n", "grid", 6),
        (b"x,y,z\n0,0,1\n0,1,1\n0,2,1\n", "grid", None),
        (files.table("x,y,z", np.random.default_rng(2).uniform(0, 9, (40, 3))), "grid", None),
    ],
)
def test_a_table_that_is_no_grid_is_told(data: bytes, kind: str, line: int | None):
    found = fault("a.csv", data)
    assert (found.kind, found.line) == (kind, line)


def test_a_table_says_itself_where_it_is():
    assert fault("a.csv", files.table("x,y,z", rows((0, 1), (0, 1))), 32632).kind == "system"


def test_a_long_table_is_told(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(csv_posts, "MOST_ROWS", 5)
    assert "at most 5" in fault("a.csv", files.table("x,y,z", rows((0, 1, 2), (0, 1)))).message


def test_a_geotiff_has_its_posts_in_the_middles_of_its_pixels():
    found = read("a.tif", files.geotiff(HEIGHTS.astype(np.float32)))
    assert (found.x == [400_005, 400_015, 400_025]).all()
    assert (found.y == [5_169_985, 5_169_995]).all()
    assert (found.heights == HEIGHTS[::-1]).all()
    assert found.system == 32632


def test_a_geotiff_of_points_has_its_posts_where_it_is_tied():
    keys = files.geo_keys(model=2, raster=2, geographic=4326, angles=9102)
    tags = {33550: (0.5, 0.25, 0.0), 33922: (1.0, 1.0, 0.0, 7.0, 46.0, 0.0), files.KEYS: keys}
    found = read("a.tiff", files.geotiff(HEIGHTS.astype(np.float32), tags))
    assert found.x == pytest.approx([6.5, 7.0, 7.5])
    assert found.y == pytest.approx([46.0, 46.25])
    assert found.system == 4326


def test_a_geotiff_may_have_a_matrix_that_does_not_turn_it():
    matrix = (10.0, 0, 0, 400_000.0, 0, -10.0, 0, 5_170_000.0, 0, 0, 0, 0, 0, 0, 0, 1.0)
    found = read("a.tif", files.geotiff(HEIGHTS.astype(np.float32), {34264: matrix, files.KEYS: files.UTM}))
    assert (found.x[0], found.y[-1]) == (400_005, 5_169_995)
    turned = (10.0, 1.0, *matrix[2:])
    wrong = fault("a.tif", files.geotiff(HEIGHTS.astype(np.float32), {34264: turned, files.KEYS: files.UTM}))
    assert wrong.kind == "grid"


@pytest.mark.parametrize("options", [{}, {"compression": "tiff_lzw"}, {"compression": "tiff_adobe_deflate"}])
@pytest.mark.parametrize("kind", [np.float32, np.int32, np.uint16, np.uint8])
def test_geotiffs_of_many_kinds_are_read(kind: Any, options: dict[str, str]):
    whole = np.round(HEIGHTS)
    assert (read("a.tif", files.geotiff(whole.astype(kind), **options)).heights == whole[::-1]).all()


@pytest.mark.parametrize("mark", ["-9999", "-3.4028234663852886e+38", "nan"])
def test_a_mark_of_no_height_makes_a_hole(mark: str):
    heights = HEIGHTS.astype(np.float32)
    heights[0, 1] = np.float32(mark)
    found = read("a.tif", files.geotiff(heights, {**files.PLACED, 42113: mark}))
    assert np.isnan(found.heights[1, 1])
    assert np.isnan(found.heights).sum() == 1


def test_heights_in_feet_become_metres():
    keys = files.geo_keys(model=1, raster=1, projected=32632, up=9002)
    found = read("a.tif", files.geotiff(HEIGHTS.astype(np.float32), {**files.PLACED, files.KEYS: keys}))
    assert found.heights == pytest.approx(HEIGHTS[::-1] * 0.3048)


def without(*tags: int) -> dict[int, Any]:
    return {tag: value for tag, value in files.PLACED.items() if tag not in tags}


@pytest.mark.parametrize(
    ("tags", "system", "kind"),
    [
        (without(33550), None, "format"),
        (without(files.KEYS), None, "system"),
        ({**files.PLACED, files.KEYS: files.geo_keys(model=1, projected=32767)}, None, "system"),
        (files.PLACED, 2056, "system"),
        ({**files.PLACED, files.KEYS: files.geo_keys(model=2, geographic=4326, angles=9105)}, None, "system"),
        ({**files.PLACED, files.KEYS: files.geo_keys(model=1, projected=32632, up=9099)}, None, "system"),
        ({**files.PLACED, 33550: (10.0,)}, None, "format"),
        ({**files.PLACED, 33550: (0.0, 10.0, 0.0)}, None, "number"),
        ({**files.PLACED, 33550: (float("nan"), 10.0, 0.0)}, None, "number"),
        ({**files.PLACED, 42113: "none"}, None, "format"),
        ({**files.PLACED, files.KEYS: (1, 1, 0)}, None, "system"),
    ],
)
def test_a_geotiff_with_wrong_tags_is_told(tags: dict[int, Any], system: int | None, kind: str):
    assert fault("a.tif", files.geotiff(HEIGHTS.astype(np.float32), tags), system).kind == kind


def test_the_mission_may_give_the_system_that_tags_lack():
    assert read("a.tif", files.geotiff(HEIGHTS.astype(np.float32), without(files.KEYS)), 2056).system == 2056


def test_pictures_and_other_files_are_no_geotiff():
    colours = np.zeros((4, 4, 3), np.uint8)
    assert fault("a.tif", files.geotiff(colours)).kind == "format"
    assert fault("a.tif", b"\x89PNG\r\n\x1a\n").kind == "format"
    assert fault("a.tif", b"").kind == "format"


def test_a_truncated_geotiff_is_told():
    data = files.geotiff(np.zeros((200, 200), np.float32), compression="tiff_lzw")
    plain = files.geotiff(np.zeros((200, 200), np.float32))
    assert {fault("a.tif", cut[: len(cut) // 2]).kind for cut in (data, plain)} <= {"truncated", "format"}


def test_a_geotiff_without_a_mark_of_its_voids_is_told():
    heights = HEIGHTS.astype(np.float32)
    heights[1, 2] = -9999.0
    found = fault("a.tif", files.geotiff(heights))
    assert found.kind == "number"
    assert "-9999" in found.message
    assert "400025, 5169985" in found.message


def test_files_that_are_too_large_are_told(monkeypatch: pytest.MonkeyPatch):
    for module in (asc, geotiff, caps):
        monkeypatch.setattr(module, "MOST_POSTS", 5)
    assert fault("a.tif", files.geotiff(HEIGHTS.astype(np.float32))).kind == "size"
    assert fault("a.asc", files.ascii_grid(HEIGHTS, CORNER), 32632).kind == "size"


def test_other_endings_are_told_which_are_read():
    found = fault("a.png", b"")
    assert found.kind == "format"
    assert all(ending in found.help for ending in reader.ENDINGS)


GOOD = {
    "a.asc": files.ascii_grid(HEIGHTS, CORNER),
    "a.csv": files.table("x,y,z", rows((0, 5, 20), (0, 10))),
    "a.tif": files.geotiff(HEIGHTS.astype(np.float32), {**files.PLACED, 42113: "-9999"}),
    "b.tif": files.geotiff(np.round(HEIGHTS).astype(np.int32), compression="tiff_lzw"),
    "N46E007.hgt": b"\0\1" * 50,
}


@pytest.mark.long
@settings(max_examples=400)
@given(st.sampled_from(sorted(GOOD)), st.data())
def test_bytes_that_are_damaged_anyhow_are_posts_or_a_fault(name: str, data: st.DataObject):
    bytes_ = bytearray(GOOD[name])
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(bytes_)))
        if data.draw(st.booleans()):
            bytes_[at : at + data.draw(st.integers(0, 8))] = data.draw(st.binary(max_size=8))
        elif at < len(bytes_):
            bytes_[at] = data.draw(st.integers(0, 255))
    found = read_elevation(name, bytes(bytes_), data.draw(st.sampled_from([None, 4326, 32632])))
    assert isinstance(found, Posts | TerrainFault)
    if isinstance(found, Posts):
        assert np.isfinite(found.heights[~np.isnan(found.heights)]).all()
        assert (np.diff(found.x) > 0).all()
        assert (np.diff(found.y) > 0).all()


@given(st.sampled_from(["a.asc", "a.csv", "a.tif", "N46E007.hgt"]), st.binary(max_size=200))
def test_any_bytes_are_posts_or_a_fault(name: str, data: bytes):
    assert isinstance(read_elevation(name, data), Posts | TerrainFault)
