"""Buildings as a mission names them: prisms on the ground, parts, and what is told of bad files."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shotc.diag.registry import has_errors
from tests.support.few import examples
from tests.support.scene_missions import corners, degrees, fault, feature, found, geojson, mesh, square

WORLD = "buildings: {file: houses.geojson}"
L = [(0.0, 0.0), (12.0, 0.0), (12.0, 5.0), (6.0, 5.0), (6.0, 9.0), (0.0, 9.0)]


def write(folder, *features, **members) -> None:
    (folder / "houses.geojson").write_bytes(geojson(*features, **members))


def volume(triangles: np.ndarray) -> float:
    """Return what closed triangles enclose, positive where they face outward."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    return float(np.einsum("kd,kd->k", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("ring", [L, L[::-1], [*L[:2], L[1], *L[2:]]], ids=["ccw", "clockwise", "repeated"])
def test_a_footprint_becomes_a_closed_prism(tmp_path, ring):
    write(tmp_path, feature(ring, name="barn", building="yes", height="8 m"))
    shape = mesh(WORLD, tmp_path)
    assert shape.kind == "buildings"
    assert shape.names == ("barn",)
    assert corners(shape) == pytest.approx(np.array([[0, 0, 0], [12, 9, 8]]), abs=1e-3)
    assert volume(shape.surface.triangles) == pytest.approx(8 * (12 * 5 + 6 * 4), rel=1e-4)


def test_every_triangle_knows_its_building(tmp_path):
    write(
        tmp_path,
        feature(square(0, 0, 10), name="hut", building="yes", height=4),
        feature(square(50, 0, 10), id="way/7", building="yes", building__levels=2),
        feature(square(100, 0, 10), building="yes", building__levels="3"),
    )
    shape = mesh(WORLD, tmp_path)
    east = shape.surface.triangles[..., 0].mean(axis=1)
    for x, name, top in ((0, "hut", 4), (50, "way/7", 6), (100, "feature 3", 9)):
        own = abs(east - x) < 20
        assert {shape.name_at(k) for k in shape.surface.source[own]} == {name}
        assert shape.surface.triangles[own][..., 2].max() == pytest.approx(top)


def test_holes_are_filled_and_every_polygon_of_many_counts(tmp_path):
    outer, hole, other = (
        [degrees(x, y) for x, y in [*r, r[0]]] for r in (square(0, 0, 20), square(0, 0, 8), square(60, 0, 10))
    )
    several = {"type": "MultiPolygon", "coordinates": [[outer, hole], [other]]}
    write(tmp_path, {"type": "Feature", "properties": {"building": "yes", "height": 5}, "geometry": several})
    shape = mesh(WORLD, tmp_path)
    assert volume(shape.surface.triangles) == pytest.approx(5 * (400 + 100), rel=1e-4)


def test_parts_stand_in_place_of_their_outline(tmp_path):
    write(
        tmp_path,
        feature(square(0, 0, 20), name="St. Mary", building="church", height=15),
        feature([(-10, -10), (5, -10), (5, 10), (-10, 10)], building__part="yes"),
        feature([(5, -10), (10, -10), (10, 10), (5, 10)], name="tower", building__part="yes", height=40),
    )
    shape = mesh(WORLD, tmp_path)
    assert sorted(shape.names) == ["St. Mary", "tower"]
    assert volume(shape.surface.triangles) == pytest.approx(15 * 300 + 40 * 100, rel=1e-4)


def test_an_outline_that_its_parts_do_not_cover_stays_and_is_told(tmp_path):
    write(
        tmp_path,
        feature(square(0, 0, 20), name="hall", building="yes", height=8),
        feature([(5, -10), (10, -10), (10, 10), (5, 10)], building__part="yes", height=20),
    )
    mission, (told,) = found(WORLD, tmp_path)
    assert told.code == "G037"
    assert "25 %" in told.notes[0]
    assert len(mission.meshes[0].names) == 2


def test_what_begins_above_the_ground_leaves_room_below(tmp_path):
    write(tmp_path, feature(square(0, 0, 10), name="bridge", building="yes", height=9, min_height=6))
    assert corners(mesh(WORLD, tmp_path))[:, 2].tolist() == [6.0, 9.0]


def test_buildings_stand_on_the_lowest_ground_under_them(tmp_path):
    rows = [f"{x},{y},{x / 10 + 50:g}" for x in range(-300, 301, 100) for y in (-300, 0, 300)]
    (tmp_path / "hill.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    write(tmp_path, feature(square(20, 0, 10), building="yes", height=7))
    shape = mesh(f"terrain: {{file: hill.csv}}\n  {WORLD}", tmp_path)
    assert corners(shape)[:, 2] == pytest.approx([51.5, 58.5], abs=1e-3)


def test_buildings_beyond_the_terrain_are_told(tmp_path):
    rows = [f"{x},{y},5" for x in range(-300, 301, 100) for y in (-300, 0, 300)]
    (tmp_path / "hill.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    write(tmp_path, *(feature(square(x, 0, 10), building="yes", height=7) for x in (20, 900)))
    mission, (told,) = found(f"terrain: {{file: hill.csv}}\n  {WORLD}", tmp_path)
    assert (told.code, len(mission.meshes[0].names)) == ("G037", 1)


def test_a_height_may_be_given_for_all_that_have_none(tmp_path):
    write(tmp_path, *(feature(square(50 * k, 0, 10), building="yes") for k in range(5)))
    told = fault(WORLD, tmp_path)
    assert told.code == "G035"
    assert "5 buildings" in told.message
    assert "and 2 more" in told.notes[-1]
    mission, (told,) = found("buildings: {file: houses.geojson, height: 12 ft}", tmp_path)
    assert told.code == "G036"
    assert corners(mission.meshes[0])[1, 2] == pytest.approx(3.6576)


def test_polygons_of_a_file_without_tags_are_all_buildings(tmp_path):
    write(tmp_path, feature(square(0, 0, 10), height=4), feature(square(50, 0, 10), height=6))
    assert len(mesh(WORLD, tmp_path).names) == 2


def test_what_is_no_building_beside_some_is_left_out_and_told(tmp_path):
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": degrees(0, 0)}}
    nothing = {"type": "Feature", "properties": None, "geometry": None}
    write(
        tmp_path,
        feature(square(0, 0, 10), building="yes", height=4),
        feature(square(0, 0, 300), landuse="forest"),
        feature(square(20_000, 0, 10), building="yes", height=4),
        point,
        nothing,
    )
    mission, (told,) = found(WORLD, tmp_path)
    assert told.code == "G037"
    for part in (
        "1 of type Point",
        "1 without geometry",
        "1 polygons of no building",
        "1 buildings more than",
    ):
        assert part in told.notes[0]
    assert len(mission.meshes[0].names) == 1


CROSSED = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]
OK = feature(square(0, 0, 10), building="yes", height=4)
SWAPPED = json.loads(geojson(OK))["features"][0]
SWAPPED["geometry"]["coordinates"] = [[[lat, lon] for lon, lat in SWAPPED["geometry"]["coordinates"][0]]]
UTM = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}
POINT = {"type": "Feature", "properties": {}, "geometry": {"type": "Point"}}
BAD = {
    "crossed": (geojson(feature(CROSSED, name="knot", building="yes", height=4)), "G034", "knot"),
    "two corners": (geojson(feature([(0, 0), (9, 0), (0, 0)], building="yes", height=4)), "G034", "2 diff"),
    "flat": (geojson(feature([(0, 0), (9, 0), (18, 0)], building="yes", height=4)), "G034", "no area"),
    "floats": (geojson(feature(L, building="yes", height=4, min_height=5)), "G034", "begins at 5 m"),
    "no height": (geojson(feature(L, building="yes", height="high")), "G035", "height: high"),
    "no json": (b"{]", "N009", "not JSON"),
    "not utf-8": (b"{\xff}", "N009", "UTF-8"),
    "nan": (geojson(OK).replace(b"46.", b"NaN, 46.", 1), "N009", "NaN"),
    "deep": (b"[" * 100_000, "N009", "deep"),
    "a list": (b"[]", "N009", "no GeoJSON"),
    "overpass": (b'{"elements": []}', "N009", "Overpass"),
    "topojson": (b'{"type": "Topology"}', "N009", "TopoJSON"),
    "no features": (b'{"type": "FeatureCollection"}', "N009", "features"),
    "empty": (geojson(), "N009", "no footprint"),
    "points": (geojson(POINT), "N009", "1 of type Point"),
    "system": (geojson(OK, crs=UTM), "N009", "32632"),
    "metres": (geojson(OK).replace(b"46.6", b"5170000.6"), "N009", "no longitude"),
    "swapped": (geojson(SWAPPED), "G017", "swapped"),
}


@pytest.mark.parametrize(("data", "code", "text"), BAD.values(), ids=BAD)
def test_bad_files_are_told_on_their_line(tmp_path, data, code, text):
    (tmp_path / "houses.geojson").write_bytes(data)
    told = fault(WORLD, tmp_path)
    assert told.code == code
    assert told.labels[0].span.line == 5
    assert text in f"{told.message} {told.notes} {told.help}"
    assert told.help


@pytest.mark.parametrize("name", ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4326"])
def test_wgs84_may_be_named(tmp_path, name):
    write(tmp_path, OK, crs={"type": "name", "properties": {"name": name}})
    assert mesh(WORLD, tmp_path).names == ("feature 1",)


def test_buildings_need_an_origin(tmp_path):
    from tests.support.front_passes import resolved
    from tests.support.scene_missions import text

    write(tmp_path, OK)
    without = text(WORLD).replace("  origin: {lat: 46.68, lon: 7.68, alt: 500}\n", "")
    assert [d.code for d in resolved(without, tmp_path)[1]] == ["G015"]


_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=12,
)


@pytest.mark.slow
@settings(max_examples=examples(30, 300), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_values_are_a_diagnostic_or_buildings(tmp_path, data):
    """A sound file, with one value anywhere in it replaced by another."""
    value = json.loads(geojson(OK, crs={"type": "name", "properties": {"name": "EPSG:4326"}}))
    at, places = value, []
    while isinstance(at, dict | list) and at and data.draw(st.integers(0, 9)):
        key = data.draw(st.sampled_from(sorted(at) if isinstance(at, dict) else range(len(at))))
        places.append((at, key))
        at = at[key]
    if places:
        holder, key = places[-1]
        holder[key] = data.draw(_VALUES)
    (tmp_path / "houses.geojson").write_text(json.dumps(value))
    mission, faults = found(WORLD, tmp_path)
    assert bool(mission.meshes) != has_errors(faults)


@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=200))
def test_any_bytes_are_a_diagnostic(tmp_path, data):
    (tmp_path / "houses.geojson").write_bytes(data)
    assert fault(WORLD, tmp_path).code == "N009"
